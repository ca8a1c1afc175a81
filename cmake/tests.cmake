# SPDX-License-Identifier: BSD-3-Clause
# One gtest program per room; `test/support` is shared by all.
file(GLOB support_sources CONFIGURE_DEPENDS test/support/*.cpp)
list(FILTER support_sources EXCLUDE REGEX "/places\\.cpp$")  # compiled alone: it has paths as definitions
ergotic_batch(support_sources test_support ${support_sources})
add_library(ergotic_test_support STATIC ${support_sources} test/support/places.cpp)
target_include_directories(ergotic_test_support PUBLIC test src)
set_source_files_properties(test/support/places.cpp PROPERTIES COMPILE_DEFINITIONS
  "ERGOTIC_SOURCE_DIR=\"${PROJECT_SOURCE_DIR}\";ERGOTIC_BINARY_DIR=\"${PROJECT_BINARY_DIR}\";\
ERGOTIC_DEVEL_DIR=\"${CATKIN_DEVEL_PREFIX}\";ERGOTIC_TOOLS_DIR=\"$<TARGET_FILE_DIR:render>\"")
pkg_check_modules(SECCOMP REQUIRED IMPORTED_TARGET libseccomp)
target_link_libraries(ergotic_test_support
  PUBLIC ergotic_audio GTest::gtest GTest::gmock PkgConfig::SNDFILE
  PRIVATE PkgConfig::SECCOMP ergotic_flags)

include(GoogleTest)
# In a batch a local variable may have the name of a constant of another test. Linked after ergotic_flags.
add_library(ergotic_test_flags INTERFACE)
if(ERGOTIC_BATCHES)
  target_compile_options(ergotic_test_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-shadow;-Wshadow=local>)
endif()
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

# The tests of one folder, as three programs by the ends of their names:
#   *_test.cpp       deterministic: no clock, fixed seeds. Run in parallel, each program in shards, as one
#                    process for each test would spend more time on starting than on testing.
#   *_live_test.cpp  label live: what depends on the clock, on JACK, on the timing of threads or of other
#                    processes. Run one by one, with three tries (scripts/test).
#   *_long_test.cpp  label long: what takes more than ten seconds. Not run by the gate (scripts/test --long).
# ergotic_add_gtests(ROOM SHARDS LIBRARIES...)
function(ergotic_add_gtests room shards)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS test/${room}/*_test.cpp)
  if(room STREQUAL "physics" AND ERGOTIC_SANITIZE STREQUAL "thread")  # the others have one thread
    foreach(source ${sources})
      file(STRINGS ${source} of_threads REGEX "^TEST.*Threads")
      if(NOT of_threads)
        list(REMOVE_ITEM sources ${source})
      endif()
    endforeach()
  endif()
  set(live_sources ${sources})
  list(FILTER live_sources INCLUDE REGEX "_live_test\\.cpp$")
  set(long_sources ${sources})
  list(FILTER long_sources INCLUDE REGEX "_long_test\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "_(live|long)_test\\.cpp$")
  if(sources)
    ergotic_add_gtest_program(ergotic_${room}_test "${sources}" ${ARGN})
    math(EXPR last "${shards} - 1")
    foreach(shard RANGE ${last})
      set(name ${room}.${shard})
      add_test(NAME ${name} COMMAND ergotic_${room}_test --gtest_brief=1
        --gtest_output=json:${PROJECT_BINARY_DIR}/test_results/${name}.json)
      set_tests_properties(${name} PROPERTIES TIMEOUT 900 LABELS ${room} COST 40
        ENVIRONMENT "GTEST_TOTAL_SHARDS=${shards};GTEST_SHARD_INDEX=${shard}")
    endforeach()
  endif()
  if(live_sources)
    ergotic_add_gtest_program(ergotic_${room}_live_test "${live_sources}" ${ARGN})
    gtest_discover_tests(ergotic_${room}_live_test TEST_PREFIX "${room}." DISCOVERY_TIMEOUT 60
      PROPERTIES TIMEOUT 120 RUN_SERIAL ON LABELS live)
  endif()
  if(long_sources)
    ergotic_add_gtest_program(ergotic_${room}_long_test "${long_sources}" ${ARGN})
    gtest_discover_tests(ergotic_${room}_long_test TEST_PREFIX "${room}." DISCOVERY_TIMEOUT 60
      PROPERTIES TIMEOUT 3600 LABELS long)
  endif()
endfunction()
function(ergotic_add_gtest_program program sources)
  ergotic_batch(compiled ${program} ${sources})
  add_executable(${program} ${compiled})
  target_link_libraries(${program}
    PRIVATE ergotic_test_support GTest::gtest_main ergotic_flags ergotic_test_flags ${ARGN})
  ergotic_compile_soon(${program})
endfunction()
# What the tests of a room run as programs: ergotic_tests_need(ROOM TARGETS...)
function(ergotic_tests_need room)
  foreach(kind test live_test long_test)
    if(TARGET ergotic_${room}_${kind})
      add_dependencies(ergotic_${room}_${kind} ${ARGN})
    endif()
  endforeach()
endfunction()

foreach(room rt files station)
  ergotic_add_gtests(${room} 1)
endforeach()
ergotic_add_gtests(replay 1 ergotic_replay)
ergotic_add_gtests(audio 1 PkgConfig::JACK)  # has MIDI ports of its own
ergotic_add_gtests(gamepads 1 ergotic_gamepads)
ergotic_add_gtests(golden 3)
ergotic_add_gtests(scene 3 yaml-cpp)  # broken scenes are listed in it
pkg_check_modules(URDFDOM REQUIRED IMPORTED_TARGET urdfdom)  # reads what pictures are made of
ergotic_add_gtests(tgr 2 yaml-cpp PkgConfig::URDFDOM)  # places of settings are seen in their nodes
ergotic_add_gtests(physics 8 ergotic_plain)  # is compared with the plain implementation of the laboratory
ergotic_add_gtests(advice 2 ergotic_advice ergotic_plain)
ergotic_add_gtests(tools 4 ergotic_tool_support)
# The comedi driver before a stand-in for libcomedi, which takes its place when it is linked first, or
# preloaded. The mechanics are its own copy, so that what preloads it meets no symbols of the core.
file(GLOB standin_sources CONFIGURE_DEPENDS test/comedi/standin/*.cpp)
add_library(comedi_standin SHARED ${standin_sources}
  src/tgr/drivers/virtual/player_hands.cpp src/tgr/drivers/virtual/slice_bank.cpp
  src/tgr/drivers/virtual/target_gesture.cpp src/tgr/drivers/virtual/virtual_slice.cpp
  src/tgr/drivers/virtual/virtual_slice_fields.cpp
  src/tgr/calibration.cpp src/tgr/require.cpp src/scene/limits.cpp src/scene/name.cpp src/scene/names.cpp
  src/scene/text/csv.cpp src/scene/text/gesture_csv.cpp src/scene/text/number.cpp src/scene/text/source_text.cpp
  src/files/printable.cpp src/files/read_file.cpp src/exception.cpp)
set_target_properties(comedi_standin PROPERTIES CXX_VISIBILITY_PRESET hidden)
target_include_directories(comedi_standin PUBLIC test PRIVATE include src)
target_link_libraries(comedi_standin PRIVATE ergotic_flags Eigen3::Eigen)
ergotic_add_gtests(comedi 1 comedi_standin ergotic_comedi_driver)
add_executable(comedi_probe test/comedi/probe/comedi_probe.cpp)
target_link_libraries(comedi_probe PRIVATE ergotic_comedi_driver ergotic_flags)
ergotic_tests_need(comedi comedi_probe)
target_compile_definitions(ergotic_comedi_live_test PRIVATE
  COMEDI_PROBE="$<TARGET_FILE:comedi_probe>" COMEDI_STANDIN="$<TARGET_FILE:comedi_standin>")
ergotic_add_gtests(tgr_jack 1 ergotic_jack_driver)
ergotic_tests_need(golden render check expand)
ergotic_tests_need(tools check expand render)
ergotic_tests_need(tgr_jack jack_tgr)
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
# The scripts: what is built; what is asked of scripts/station; what rooms may include, and how they are drawn; what measures a demo, a soak
# and another build; what users do in the devel and in an install space.
foreach(script build check_includes demo_report soak_report front_door play_gesture test_report window calibrate)
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
foreach(instruments instruments instruments_whole)
  add_test(NAME scripts.${instruments}
    COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/test/integration/instruments_test.py
            $<TARGET_FILE_DIR:render>)
endforeach()
set_tests_properties(scripts.instruments PROPERTIES COST 90)
set_tests_properties(scripts.instruments_whole PROPERTIES LABELS long ENVIRONMENT ERGOTIC_LONG=1 TIMEOUT 900)
add_test(NAME scripts.compare_builds
  COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/test/integration/compare_builds_test.py
          $<TARGET_FILE_DIR:render>)
set_tests_properties(scripts.build PROPERTIES COST 50)
set_tests_properties(scripts.compare_builds PROPERTIES LABELS long)
if(ERGOTIC_ROS)
  add_test(NAME integration.spaces
    COMMAND ${PROJECT_SOURCE_DIR}/test/integration/spaces.sh
            ${PROJECT_BINARY_DIR} ${CATKIN_DEVEL_PREFIX})
  set_tests_properties(integration.spaces PROPERTIES TIMEOUT 300 LABELS integration COST 60)
endif()
# The laboratory: built by the target lab_tests, run by scripts/test --long.
file(GLOB lab_tests CONFIGURE_DEPENDS lab/test/*_test.cpp)
ergotic_batch(lab_tests ergotic_lab_test ${lab_tests})
add_executable(ergotic_lab_test EXCLUDE_FROM_ALL ${lab_tests})
target_link_libraries(ergotic_lab_test
  PRIVATE ergotic_test_support GTest::gtest_main ergotic_flags ergotic_test_flags ergotic_lab)
ergotic_compile_soon(ergotic_lab_test)
add_custom_target(lab_tests DEPENDS ergotic_lab_test lab)
add_test(NAME lab.programs COMMAND ergotic_lab_test --gtest_brief=1)
set_tests_properties(lab.programs PROPERTIES TIMEOUT 1800 RUN_SERIAL ON)
foreach(script bench_faust latency)
  add_test(NAME lab.${script} COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/lab/test/${script}_test.py)
endforeach()
set_tests_properties(lab.programs lab.bench_faust lab.latency PROPERTIES LABELS long)
# As it is preloaded into a station.
target_sources(ergotic_rt_live_test PRIVATE src/preload/priority_inheritance.cpp)
target_link_libraries(ergotic_rt_live_test PRIVATE ${CMAKE_DL_LIBS})
