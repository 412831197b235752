# SPDX-License-Identifier: Apache-2.0
# What was configured, in a few lines, where nadir is not somebody's subdirectory.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
get_property(nadir_libraries GLOBAL PROPERTY NADIR_LIBRARIES)
string(REPLACE "nadir_" "" nadir_libraries "${nadir_libraries}")
list(JOIN nadir_libraries " " nadir_libraries)
message(STATUS "nadir ${PROJECT_VERSION} (${CMAKE_BUILD_TYPE}, "
               "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION})")
message(STATUS "  libraries    ${nadir_libraries}")
message(STATUS "  GDAL ${GDAL_VERSION}, OpenSSL ${OPENSSL_VERSION}, Eigen ${Eigen3_VERSION}, "
               "oneTBB ${TBB_VERSION}, pocketfft in ${POCKETFFT_INCLUDE_DIR}")
message(STATUS "  CUDA backend ${NADIR_CUDA_STATUS}")
# Every switch of the project, so that a new one shows up here by itself.
get_cmake_property(nadir_cache CACHE_VARIABLES)
list(FILTER nadir_cache INCLUDE REGEX "^NADIR_(BUILD|WITH|INSTALL|WARNINGS)")
foreach(variable IN LISTS nadir_cache)
  message(STATUS "  ${variable} = ${${variable}}")
endforeach()
