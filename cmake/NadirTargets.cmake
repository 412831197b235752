# SPDX-License-Identifier: Apache-2.0
# The shape that all targets of nadir share. Nothing here touches a parent project's flags.

add_library(nadir_build_flags INTERFACE)
target_compile_features(nadir_build_flags INTERFACE cxx_std_20)
target_compile_options(nadir_build_flags INTERFACE
  "$<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wpedantic;-Wshadow;-Wconversion;-Wsign-conversion>"
  "$<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast;-Wnon-virtual-dtor;-Woverloaded-virtual>"
  # a*b+c must round the same way in every build, or the same seed gives other bytes
  $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>
  # and on the GPU as on the CPU, where the tests run its kernels
  $<$<COMPILE_LANGUAGE:CUDA>:-fmad=false>
  "$<$<COMPILE_LANGUAGE:CUDA>:SHELL:-Xcompiler -Wall,-Wextra>"
  # g++ 12 sees overlaps where std::string has none (GCC bug 105651)
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>)
if(NADIR_WARNINGS_AS_ERRORS)
  target_compile_options(nadir_build_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Werror>)
endif()

# nadir_add_library(NAME SOURCES file... [PUBLIC target...] [PRIVATE target...])
function(nadir_add_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  # A private header-only dependency is compiled in: who links the result needs nothing of it.
  list(TRANSFORM arg_PRIVATE REPLACE "^(nadir_pocketfft|nlohmann_json::nlohmann_json)$"
       "$<BUILD_INTERFACE:\\1>")
  add_library(nadir_${name} ${arg_SOURCES})
  add_library(nadir::${name} ALIAS nadir_${name})
  set_target_properties(nadir_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
                        INSTALL_RPATH $ORIGIN  # shared libraries find each other wherever they are
                        VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_compile_features(nadir_${name} PUBLIC cxx_std_20)
  target_include_directories(nadir_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(nadir_${name} PUBLIC ${arg_PUBLIC}
                        PRIVATE $<BUILD_INTERFACE:nadir_build_flags> ${arg_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY NADIR_LIBRARIES nadir_${name})
endfunction()

# nadir_add_test(NAME SOURCES file... LIBRARIES target... [SLOW] [TOGETHER]): one GoogleTest program.
# CTest starts each of its tests by itself; TOGETHER, all at once: for tests that share a long SetUpTestSuite.
# SLOW is for whole runs of the program and for minutes under a sanitizer: built by nadir_program_tests,
# labelled `slow`. All others are unit tests, built by nadir_unit_tests and labelled `unit`, or
# `unit-threads` where they link a library that computes on several threads: nadir_thread_tests.
# .ci/run takes the unit tests under the sanitizers and the slow ones in the release build.
function(nadir_add_test name)
  cmake_parse_arguments(arg "SLOW;TOGETHER" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE nadir_build_flags ${arg_LIBRARIES} GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  if(arg_SLOW)
    set(label slow)
    add_dependencies(nadir_program_tests ${name})
  elseif(arg_LIBRARIES MATCHES "nadir::(ground_mapping|map_matching|nadir)(;|$)")
    set(label unit-threads)
    add_dependencies(nadir_unit_tests ${name})
    add_dependencies(nadir_thread_tests ${name})
  else()
    set(label unit)
    add_dependencies(nadir_unit_tests ${name})
  endif()
  set(properties TIMEOUT 600 LABELS ${label})
  if(arg_TOGETHER)
    add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(${name} PROPERTIES ${properties} COST 1000)  # long, so first
  else()
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} PROPERTIES ${properties})
  endif()
endfunction()
