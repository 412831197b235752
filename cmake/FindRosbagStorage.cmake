# SPDX-License-Identifier: Apache-2.0
# nadir_rosbag: librosbag_storage, which reads ROS 1 bags without a ROS installation, and the messages
# in them. Its own CMake configuration is not used: Debian's asks for catkin's pluginlib, which Debian
# has no more. Installed beside nadirConfig.cmake too, for the users of the static libraries.
if(TARGET nadir_rosbag)
  return()
endif()
set(nadir_rosbag_places)
foreach(header rosbag/view.h sensor_msgs/PointCloud2.h nav_msgs/Odometry.h tf2_msgs/TFMessage.h
               console_bridge/console.h pluginlib/class_loader.hpp)
  string(MAKE_C_IDENTIFIER NADIR_ROSBAG_${header} place)
  find_path(${place} ${header} PATH_SUFFIXES pluginlib)
  list(APPEND nadir_rosbag_places ${place})
endforeach()
foreach(library rosbag_storage roscpp_serialization rostime cpp_common console_bridge)
  find_library(NADIR_ROSBAG_${library}_LIBRARY ${library})
  list(APPEND nadir_rosbag_places NADIR_ROSBAG_${library}_LIBRARY)
endforeach()
mark_as_advanced(${nadir_rosbag_places})
foreach(place IN LISTS nadir_rosbag_places)
  if(NOT ${place})
    return()  # no target: not there
  endif()
endforeach()
# What pluginlib's headers include lies in folders of their own where it is ROS 2's, as in Debian.
foreach(header class_loader/class_loader.hpp rcpputils/shared_library.hpp rcutils/logging_macros.h
               ament_index_cpp/get_resource.hpp)
  string(MAKE_C_IDENTIFIER NADIR_ROSBAG_${header} place)
  get_filename_component(package ${header} DIRECTORY)
  find_path(${place} ${header} PATH_SUFFIXES ${package})
  mark_as_advanced(${place})
  list(APPEND nadir_rosbag_places ${place})
endforeach()

add_library(nadir_rosbag INTERFACE IMPORTED GLOBAL)
foreach(place IN LISTS nadir_rosbag_places)
  if(place MATCHES "_LIBRARY$")
    target_link_libraries(nadir_rosbag INTERFACE ${${place}})
  elseif(${place})
    target_include_directories(nadir_rosbag SYSTEM INTERFACE ${${place}})
  endif()
endforeach()
