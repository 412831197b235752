# SPDX-License-Identifier: Apache-2.0
# Every third party is looked for here and nowhere else. No downloads.
# What a library of nadir links must also be known to NadirInstall.cmake.

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
# The tsan preset: tools/tsan/include/tbb/stand_in.h says why. Ceres brings the real oneTBB, so that
# the stand-in goes with NADIR_WITH_SFM=OFF.
if(NADIR_TBB_STAND_IN)
  add_library(TBB::tbb INTERFACE IMPORTED)
  target_include_directories(TBB::tbb INTERFACE ${PROJECT_SOURCE_DIR}/tools/tsan/include)
  target_link_libraries(TBB::tbb INTERFACE Threads::Threads)
else()
  find_package(TBB REQUIRED)
endif()
find_package(hwy REQUIRED)
find_package(GDAL 3.4 REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)  # SHA-256 of the inputs, in the run records
include(FindOpenCVModules)  # nadir_opencv_core, nadir_opencv_imgproc, ...
# Ceres is for aerial_mapping's own poses alone: without it given poses are still rectified.
set(NADIR_HAS_SFM OFF)
if(NADIR_WITH_SFM STREQUAL "ON")
  find_package(Ceres 2.0 REQUIRED)
elseif(NOT NADIR_WITH_SFM STREQUAL "OFF")
  find_package(Ceres 2.0 QUIET)
endif()
if(Ceres_FOUND AND NOT NADIR_WITH_SFM STREQUAL "OFF")
  set(NADIR_HAS_SFM ON)
endif()
# ROS 1 bags are read where the definitions of their messages are there.
set(NADIR_HAS_ROSBAG OFF)
if(NOT NADIR_WITH_ROSBAG STREQUAL "OFF")
  include(FindRosbag)  # nadir_rosbag
  if(TARGET nadir_rosbag)
    set(NADIR_HAS_ROSBAG ON)
  elseif(NADIR_WITH_ROSBAG STREQUAL "ON")
    message(FATAL_ERROR "A message of ROS, bzip2 or LZ4 was not found: install libroscpp-core-dev libsensor-msgs-dev "
                        "libnav-msgs-dev libtf2-msgs-dev libbz2-dev liblz4-dev")
  endif()
endif()
if(NADIR_BUILD_APPS)
  find_package(CLI11 REQUIRED)
  # cpp-httplib, the viewer's server. Debian compiles a part of it into a library, with features that
  # change the layout of its classes: its .pc file names them, and the header must see the same.
  find_package(PkgConfig QUIET)
  if(PkgConfig_FOUND)
    pkg_check_modules(HTTPLIB QUIET IMPORTED_TARGET cpp-httplib)
  endif()
  add_library(nadir_httplib INTERFACE IMPORTED)
  if(HTTPLIB_FOUND)
    target_link_libraries(nadir_httplib INTERFACE PkgConfig::HTTPLIB Threads::Threads)
  else()  # as its authors ship it: a header and no library
    find_path(HTTPLIB_INCLUDE_DIR httplib.h)
    if(NOT HTTPLIB_INCLUDE_DIR)
      message(FATAL_ERROR "httplib.h not found: install libcpp-httplib-dev or set HTTPLIB_INCLUDE_DIR")
    endif()
    target_include_directories(nadir_httplib INTERFACE ${HTTPLIB_INCLUDE_DIR})
    target_link_libraries(nadir_httplib INTERFACE Threads::Threads)
  endif()
endif()
if(NADIR_BUILD_APPS OR NADIR_BUILD_TESTS)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)  # tools/*.py
endif()
if(NADIR_BUILD_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
if(NADIR_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()

# pocketfft (BSD, header-only), as Debian ships it inside gemmi-dev or wherever the user has it.
find_path(POCKETFFT_INCLUDE_DIR pocketfft_hdronly.h PATH_SUFFIXES gemmi/third_party pocketfft)
if(NOT POCKETFFT_INCLUDE_DIR)
  message(FATAL_ERROR "pocketfft_hdronly.h not found: install gemmi-dev or set POCKETFFT_INCLUDE_DIR")
endif()
add_library(nadir_pocketfft INTERFACE IMPORTED)
target_include_directories(nadir_pocketfft INTERFACE ${POCKETFFT_INCLUDE_DIR})
target_link_libraries(nadir_pocketfft INTERFACE Threads::Threads)
# It hands aligned_alloc sizes that are no multiple of the alignment, which the sanitizers refuse;
# told that there is no such function, it aligns by itself.
target_compile_definitions(nadir_pocketfft INTERFACE _LIBCPP_HAS_NO_ALIGNED_ALLOCATION)

include(NadirCuda)  # optional: NADIR_CUDA

# A project that takes nadir by add_subdirectory links our libraries from its own folders, where
# imported targets of ours would otherwise be unknown.
get_property(nadir_third_parties DIRECTORY PROPERTY IMPORTED_TARGETS)
foreach(target IN LISTS nadir_third_parties)
  set_target_properties(${target} PROPERTIES IMPORTED_GLOBAL TRUE)
endforeach()
