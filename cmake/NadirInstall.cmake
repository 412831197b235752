# SPDX-License-Identifier: Apache-2.0
# find_package(nadir CONFIG COMPONENTS core ...): every library of NADIR_LIBRARIES is a component,
# nadir::<component>, in an export set of its own, so that a user of core need not have GDAL.
include(CMakePackageConfigHelpers)

set(nadir_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/nadir)

# How the user of an installed library finds what it links. A third party that is missing here is
# an error, and not a package that fails at the user's.
set(nadir_find_Eigen3::Eigen "find_dependency(Eigen3 3.4 NO_MODULE)")
set(nadir_find_TBB::tbb "find_dependency(TBB)")
set(nadir_find_hwy::hwy "find_dependency(hwy)")
set(nadir_find_GDAL::GDAL "find_dependency(GDAL 3.4)")
set(nadir_find_yaml-cpp "find_dependency(yaml-cpp)")
set(nadir_find_fmt::fmt "find_dependency(fmt)")
set(nadir_find_Threads::Threads "find_dependency(Threads)")
set(nadir_find_OpenSSL::Crypto "find_dependency(OpenSSL)")
set(nadir_find_Ceres::ceres "find_dependency(Ceres 2.0)")
set(nadir_find_nadir_rosbag "include(\"\${CMAKE_CURRENT_LIST_DIR}/FindRosbag.cmake\")")
foreach(library cudart_static cufft)
  set(nadir_find_CUDA::${library} "find_dependency(CUDAToolkit 11.8)")
endforeach()
foreach(module core imgproc imgcodecs calib3d features2d flann stitching)
  set(nadir_find_nadir_opencv_${module}
      "include(\"\${CMAKE_CURRENT_LIST_DIR}/FindOpenCVModules.cmake\")")
endforeach()

# The lines of a component's file that provide all that its library links.
function(nadir_component_requirements library result)
  # A static library hands its private dependencies on to the linker of the user.
  get_target_property(type ${library} TYPE)
  if(type STREQUAL "SHARED_LIBRARY")
    get_target_property(dependencies ${library} INTERFACE_LINK_LIBRARIES)
  else()
    get_target_property(dependencies ${library} LINK_LIBRARIES)
  endif()
  set(lines)
  foreach(dependency IN LISTS dependencies)
    if(dependency MATCHES "^\\$<BUILD_INTERFACE:" OR NOT dependency)
      continue()
    elseif(dependency MATCHES "^nadir::(.*)$")
      list(APPEND lines "include(\"\${CMAKE_CURRENT_LIST_DIR}/nadir-${CMAKE_MATCH_1}.cmake\")")
    elseif(DEFINED nadir_find_${dependency})
      list(APPEND lines "${nadir_find_${dependency}}")
    else()
      message(FATAL_ERROR "${library} links ${dependency}: say in NadirInstall.cmake how the user "
                          "of the installed library finds it")
    endif()
  endforeach()
  list(REMOVE_DUPLICATES lines)
  list(JOIN lines "\n" text)
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

get_property(nadir_libraries GLOBAL PROPERTY NADIR_LIBRARIES)
set(nadir_components)
foreach(library IN LISTS nadir_libraries)
  string(REGEX REPLACE "^nadir_" "" component ${library})
  list(APPEND nadir_components ${component})
  install(TARGETS ${library} EXPORT nadir-${component}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT nadir-${component} NAMESPACE nadir:: FILE nadir-${component}-targets.cmake
          DESTINATION ${nadir_config_dir})
  nadir_component_requirements(${library} nadir_requirements)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/nadir-component.cmake.in
                 ${PROJECT_BINARY_DIR}/cmake/nadir-${component}.cmake @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/cmake/nadir-${component}.cmake
          DESTINATION ${nadir_config_dir})
endforeach()

# Public headers stand directly in a module's folder, or in a room of io or pipelines; what lies deeper is the
# module's own, and the viewer is a part of the program.
file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/src
     ${PROJECT_SOURCE_DIR}/src/nadir/*.hpp ${PROJECT_SOURCE_DIR}/src/nadir/*/*.hpp
     ${PROJECT_SOURCE_DIR}/src/nadir/io/*/*.hpp ${PROJECT_SOURCE_DIR}/src/nadir/pipelines/*/*.hpp)
list(FILTER headers EXCLUDE REGEX "^nadir/(io/detail|viewer)/")
foreach(header IN LISTS headers)
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/src/${header}
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder})
endforeach()

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/nadirConfig.cmake.in
  ${PROJECT_BINARY_DIR}/cmake/nadirConfig.cmake INSTALL_DESTINATION ${nadir_config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/nadirConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cmake/nadirConfig.cmake
              ${PROJECT_BINARY_DIR}/cmake/nadirConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindOpenCVModules.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindRosbag.cmake
        DESTINATION ${nadir_config_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/NOTICE
        DESTINATION ${CMAKE_INSTALL_DOCDIR})

if(TARGET nadir_cli)
  # The program finds shared libraries of ours wherever the whole prefix is moved to.
  set_target_properties(nadir_cli PROPERTIES
                        INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS nadir_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
