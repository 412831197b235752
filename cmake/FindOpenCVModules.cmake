# SPDX-License-Identifier: Apache-2.0
# Only the OpenCV modules that are used. Debian's module packages carry headers and libraries but
# no OpenCVConfig.cmake, which comes with the whole of OpenCV and Qt alone: so both ways are tried.
# Installed beside nadirConfig.cmake too, for the users of the static libraries.
foreach(module core imgproc imgcodecs calib3d features2d flann stitching)
  if(TARGET nadir_opencv_${module})
    continue()
  endif()
  find_path(NADIR_OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4)
  find_library(NADIR_OPENCV_${module}_LIBRARY opencv_${module})
  mark_as_advanced(NADIR_OPENCV_INCLUDE_DIR NADIR_OPENCV_${module}_LIBRARY)
  if(NOT NADIR_OPENCV_INCLUDE_DIR OR NOT NADIR_OPENCV_${module}_LIBRARY)
    find_package(OpenCV 4.5 REQUIRED CONFIG COMPONENTS ${module})
    add_library(nadir_opencv_${module} INTERFACE IMPORTED GLOBAL)
    target_include_directories(nadir_opencv_${module} INTERFACE ${OpenCV_INCLUDE_DIRS})
    target_link_libraries(nadir_opencv_${module} INTERFACE opencv_${module})
  else()
    add_library(nadir_opencv_${module} UNKNOWN IMPORTED GLOBAL)
    set_target_properties(nadir_opencv_${module} PROPERTIES
      IMPORTED_LOCATION ${NADIR_OPENCV_${module}_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${NADIR_OPENCV_INCLUDE_DIR})
  endif()
endforeach()
