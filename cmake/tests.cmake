# SPDX-License-Identifier: BSD-3-Clause
# One gtest program per room; `test/support` is shared by all.
file(GLOB support_sources CONFIGURE_DEPENDS test/support/*.cpp)
add_library(ergotic_test_support STATIC ${support_sources})
target_include_directories(ergotic_test_support PUBLIC test src)
set_source_files_properties(test/support/places.cpp PROPERTIES COMPILE_DEFINITIONS
  "ERGOTIC_SOURCE_DIR=\"${PROJECT_SOURCE_DIR}\";ERGOTIC_BINARY_DIR=\"${PROJECT_BINARY_DIR}\";\
ERGOTIC_DEVEL_DIR=\"${CATKIN_DEVEL_PREFIX}\";ERGOTIC_TOOLS_DIR=\"$<TARGET_FILE_DIR:render>\"")
pkg_check_modules(SECCOMP REQUIRED IMPORTED_TARGET libseccomp)
target_link_libraries(ergotic_test_support
  PUBLIC ergotic_audio GTest::gtest GTest::gmock PkgConfig::SNDFILE
  PRIVATE PkgConfig::SECCOMP ergotic_flags)

include(GoogleTest)
# Tests are compiled sooner than optimized, all with the headers that the first of them has read.
function(ergotic_compile_soon target)
  target_compile_options(${target} PRIVATE
    $<$<NOT:$<CONFIG:Debug>>:-O1> $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  if(${target} STREQUAL "ergotic_rt_test")
    target_precompile_headers(${target} PRIVATE
      ${ergotic_common_headers} <gmock/gmock.h> <gtest/gtest.h>)
  else()
    target_precompile_headers(${target} REUSE_FROM ergotic_rt_test)
  endif()
endfunction()
# The tests of one folder as one program: ergotic_add_gtests(ROOM LIBRARIES...)
function(ergotic_add_gtests room)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS test/${room}/*_test.cpp)
  if(room STREQUAL "physics" AND ERGOTIC_SANITIZE STREQUAL "thread")  # the others have one thread
    foreach(source ${sources})
      file(STRINGS ${source} of_threads REGEX "^TEST.*Threads")
      if(NOT of_threads)
        list(REMOVE_ITEM sources ${source})
      endif()
    endforeach()
  endif()
  add_executable(ergotic_${room}_test ${sources})
  target_link_libraries(ergotic_${room}_test
    PRIVATE ergotic_test_support GTest::gtest_main ergotic_flags ${ARGN})
  ergotic_compile_soon(ergotic_${room}_test)
  # JACK has one registry for all servers of a user, and may refuse two clients that come at once.
  set(lock "")
  if(room MATCHES "^(audio|tgr_jack)$")
    set(lock RESOURCE_LOCK jack COST 20)  # one after the other, and so from the beginning
  endif()
  gtest_discover_tests(ergotic_${room}_test
    TEST_PREFIX "${room}." DISCOVERY_TIMEOUT 60
    PROPERTIES TIMEOUT 300 LABELS ${room} FIXTURES_REQUIRED trials ${lock})
endfunction()
# What a run is excused for, over all of its tests: see test/support/trials.hpp.
add_test(NAME trials.begin COMMAND ${CMAKE_COMMAND} -E rm -f ${PROJECT_BINARY_DIR}/trials.txt)
set_tests_properties(trials.begin PROPERTIES FIXTURES_SETUP trials)
add_test(NAME trials.sum
  COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/test/support/sum_trials.py
          ${PROJECT_BINARY_DIR}/trials.txt)
set_tests_properties(trials.sum PROPERTIES FIXTURES_CLEANUP trials)

foreach(room rt files station audio golden)
  ergotic_add_gtests(${room})
endforeach()
ergotic_add_gtests(scene yaml-cpp)  # broken scenes are listed in it
pkg_check_modules(URDFDOM REQUIRED IMPORTED_TARGET urdfdom)  # reads what pictures are made of
ergotic_add_gtests(tgr yaml-cpp PkgConfig::URDFDOM)  # places of settings are seen in their nodes
foreach(room physics advice tools)  # physics is compared with the tools' plain implementation
  ergotic_add_gtests(${room} ergotic_measuring)
endforeach()
# The comedi driver before a stand-in for libcomedi, which takes its place when it is linked first, or
# preloaded. The mechanics are its own copy, so that what preloads it meets no symbols of the core.
file(GLOB standin_sources CONFIGURE_DEPENDS test/comedi/standin/*.cpp)
add_library(comedi_standin SHARED ${standin_sources}
  src/tgr/drivers/virtual/slice_bank.cpp src/tgr/drivers/virtual/target_gesture.cpp
  src/tgr/drivers/virtual/virtual_slice.cpp src/tgr/drivers/virtual/virtual_slice_fields.cpp
  src/tgr/calibration.cpp src/tgr/gesture_csv.cpp src/tgr/csv.cpp src/tgr/require.cpp
  src/scene/limits.cpp src/files/printable.cpp src/files/read_file.cpp
  src/exception.cpp)
set_target_properties(comedi_standin PROPERTIES CXX_VISIBILITY_PRESET hidden)
target_include_directories(comedi_standin PUBLIC test PRIVATE include src)
target_link_libraries(comedi_standin PRIVATE ergotic_flags Eigen3::Eigen)
ergotic_add_gtests(comedi comedi_standin ergotic_comedi_driver)
add_executable(comedi_probe test/comedi/probe/comedi_probe.cpp)
target_link_libraries(comedi_probe PRIVATE ergotic_comedi_driver ergotic_flags)
add_dependencies(ergotic_comedi_test comedi_probe)
set_source_files_properties(test/comedi/comedi_preload_test.cpp PROPERTIES COMPILE_DEFINITIONS
  "COMEDI_PROBE=\"$<TARGET_FILE:comedi_probe>\";COMEDI_STANDIN=\"$<TARGET_FILE:comedi_standin>\"")
ergotic_add_gtests(tgr_jack ergotic_jack_driver)
# They run the tools as programs.
add_dependencies(ergotic_golden_test render check)
add_dependencies(ergotic_tools_test bench check expand latency render)
add_dependencies(ergotic_tgr_jack_test jack_tgr)
if(ERGOTIC_ROS)
  include(cmake/ros_tests.cmake)
endif()

# No symbol of ours is left to be looked up while it plays.
set(bound_at_load "")
foreach(target ${ergotic_libraries} ${ergotic_tools})
  list(APPEND bound_at_load $<TARGET_FILE:${target}>)
endforeach()
add_test(NAME scripts.bound_at_load
  COMMAND ${PROJECT_SOURCE_DIR}/test/integration/bound_at_load.sh ${bound_at_load})
# The scripts: what is built; what rooms may include, and how they are drawn; what measures a demo, a soak,
# a peer and another build; what users do in the devel and in an install space.
foreach(script build check_includes demo_report soak_report bench_faust latency play_gesture sum_trials)
  add_test(NAME scripts.${script}
    COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/test/integration/${script}_test.py)
endforeach()
add_test(NAME scripts.draw_rooms
  COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/scripts/draw_rooms --check)
add_test(NAME scripts.documents
  COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/test/integration/documents_test.py
          $<TARGET_FILE_DIR:render>)
add_test(NAME scripts.recipes
  COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/test/integration/recipes_test.py
          $<TARGET_FILE_DIR:render>)
add_test(NAME scripts.compare_builds
  COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/test/integration/compare_builds_test.py
          $<TARGET_FILE_DIR:render>)
# Those that take longest begin first, or a processor is idle at the end. They say that they need
# what all others need, for those that need nothing come last whatever they cost.
set_tests_properties(scripts.build scripts.compare_builds PROPERTIES
  COST 50 FIXTURES_REQUIRED trials)
if(ERGOTIC_ROS)
  add_test(NAME integration.spaces
    COMMAND ${PROJECT_SOURCE_DIR}/test/integration/spaces.sh
            ${PROJECT_BINARY_DIR} ${CATKIN_DEVEL_PREFIX})
  set_tests_properties(integration.spaces PROPERTIES
    TIMEOUT 300 LABELS integration COST 30 FIXTURES_REQUIRED trials)
  set_tests_properties(integration.typed integration.remote PROPERTIES COST 40)
endif()
# As it is preloaded into a station.
target_sources(ergotic_rt_test PRIVATE src/preload/priority_inheritance.cpp)
target_link_libraries(ergotic_rt_test PRIVATE ${CMAKE_DL_LIBS})
