# SPDX-License-Identifier: Apache-2.0
# The backend `cuda` of map_matching: nvcc, CUDA's runtime and cuFFT, from 11.8 on. Never required.
# Sets NADIR_CUDA (whether it is built), NADIR_CUDA_LIBRARIES and, for the summary, NADIR_CUDA_STATUS.
set(NADIR_WITH_CUDA AUTO CACHE STRING "Build the CUDA backend: AUTO (where nvcc is found), ON, OFF")
set_property(CACHE NADIR_WITH_CUDA PROPERTY STRINGS AUTO ON OFF)
# Native code for Hopper; the others compile the code of 7.5 at the first use, which CUDA keeps.
# More of them cost compile time and size: all-major is for packages.
set(NADIR_CUDA_ARCHITECTURES "75-virtual;90-real" CACHE STRING
    "GPU architectures of the CUDA backend, as CMAKE_CUDA_ARCHITECTURES takes them")
mark_as_advanced(NADIR_CUDA_ARCHITECTURES)

set(NADIR_CUDA FALSE)
set(NADIR_CUDA_LIBRARIES)
if(NOT NADIR_WITH_CUDA)
  set(NADIR_CUDA_STATUS "off (NADIR_WITH_CUDA)")
  return()
endif()

include(CheckLanguage)
check_language(CUDA)
if(CMAKE_CUDA_COMPILER)
  find_package(CUDAToolkit 11.8 QUIET)
endif()
if(NOT CMAKE_CUDA_COMPILER)
  set(NADIR_CUDA_STATUS "off: no nvcc (set CMAKE_CUDA_COMPILER or PATH)")
elseif(NOT CUDAToolkit_FOUND)
  set(NADIR_CUDA_STATUS "off: no CUDA toolkit of 11.8 or later beside ${CMAKE_CUDA_COMPILER}")
elseif(NOT TARGET CUDA::cufft OR NOT TARGET CUDA::cudart_static)
  set(NADIR_CUDA_STATUS "off: no cuFFT or no static runtime in ${CUDAToolkit_LIBRARY_DIR}")
else()
  set(NADIR_CUDA TRUE)
  set(NADIR_CUDA_STATUS "CUDA ${CUDAToolkit_VERSION}, architectures ${NADIR_CUDA_ARCHITECTURES}")
  set(NADIR_CUDA_LIBRARIES CUDA::cudart_static CUDA::cufft)
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
    set(CMAKE_CUDA_ARCHITECTURES "${NADIR_CUDA_ARCHITECTURES}")
  endif()
  if(NOT DEFINED CMAKE_CUDA_COMPILER_LAUNCHER AND CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CUDA_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
  endif()
  enable_language(CUDA)
endif()
if(NOT NADIR_CUDA AND NOT NADIR_WITH_CUDA STREQUAL "AUTO")
  message(FATAL_ERROR "NADIR_WITH_CUDA=${NADIR_WITH_CUDA}, but the CUDA backend is ${NADIR_CUDA_STATUS}")
endif()
