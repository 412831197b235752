# SPDX-License-Identifier: Apache-2.0
# nadir_rosbag: what reads ROS 1 bags without a ROS installation: the definitions of their messages,
# and the compressions of their chunks. nadir_rosbag_storage, for the tests, which write bags with it:
# librosbag_storage. Its own CMake configuration is not used: Debian's asks for catkin's pluginlib, which
# Debian has no more. Installed beside nadirConfig.cmake too, for the users of the static libraries.
if(TARGET nadir_rosbag)
  return()
endif()

# Defines `target` where all of HEADERS and LIBRARIES are there; OPTIONAL headers lie in folders of
# their own in some installations.
function(nadir_find_ros target)
  cmake_parse_arguments(arg "" "" "HEADERS;LIBRARIES;OPTIONAL" ${ARGN})
  set(places)
  foreach(header IN LISTS arg_HEADERS)
    string(MAKE_C_IDENTIFIER NADIR_ROSBAG_${header} place)
    find_path(${place} ${header} PATH_SUFFIXES pluginlib)
    list(APPEND places ${place})
  endforeach()
  foreach(library IN LISTS arg_LIBRARIES)
    find_library(NADIR_ROSBAG_${library}_LIBRARY ${library})
    list(APPEND places NADIR_ROSBAG_${library}_LIBRARY)
  endforeach()
  mark_as_advanced(${places})
  foreach(place IN LISTS places)
    if(NOT ${place})
      return()  # no target: not there
    endif()
  endforeach()
  foreach(header IN LISTS arg_OPTIONAL)
    string(MAKE_C_IDENTIFIER NADIR_ROSBAG_${header} place)
    get_filename_component(package ${header} DIRECTORY)
    find_path(${place} ${header} PATH_SUFFIXES ${package})
    mark_as_advanced(${place})
    list(APPEND places ${place})
  endforeach()
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  foreach(place IN LISTS places)
    if(place MATCHES "_LIBRARY$")
      target_link_libraries(${target} INTERFACE ${${place}})
    elseif(${place})
      target_include_directories(${target} SYSTEM INTERFACE ${${place}})
    endif()
  endforeach()
endfunction()

nadir_find_ros(nadir_rosbag
  HEADERS ros/serialization.h sensor_msgs/PointCloud2.h nav_msgs/Odometry.h tf2_msgs/TFMessage.h bzlib.h lz4frame.h
  LIBRARIES roscpp_serialization rostime cpp_common bz2 lz4)
# What pluginlib's headers include lies in folders of their own where it is ROS 2's, as in Debian.
nadir_find_ros(nadir_rosbag_storage
  HEADERS rosbag/bag.h console_bridge/console.h pluginlib/class_loader.hpp
  LIBRARIES rosbag_storage console_bridge
  OPTIONAL class_loader/class_loader.hpp rcpputils/shared_library.hpp rcutils/logging_macros.h
           ament_index_cpp/get_resource.hpp)
