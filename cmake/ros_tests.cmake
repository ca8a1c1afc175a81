# SPDX-License-Identifier: BSD-3-Clause
# Tests that need ROS: messages and conversions as gtests, the station as rostests, launch files.
# All of them run under plain ctest, in the devel space.
ergotic_add_gtests(ros 1 ergotic_ros yaml-cpp)
# A device of somebody else, which no list of ours knows of.
add_library(third_party_device SHARED test/third_party_device/still_device.cpp)
set_target_properties(third_party_device PROPERTIES
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/third_party/lib)
target_link_libraries(third_party_device
  PRIVATE ergotic_core ergotic_messages ergotic_flags yaml-cpp ${class_loader_LIBRARIES})
ergotic_tests_need(ros third_party_device)
# Qt wants code as that of libraries, which cannot have the headers that tests have read before.
add_library(ergotic_pen_events OBJECT test/rviz/pen_events.cpp)
target_link_libraries(ergotic_pen_events PRIVATE ergotic_rviz Qt5::Widgets GTest::gtest ergotic_flags)
ergotic_add_gtests(rviz 1 ergotic_rviz rostime ergotic_pen_events)
ergotic_add_gtests(bag 1 ergotic_bag)
ergotic_tests_need(bag render)

set(in_devel_space ${CATKIN_DEVEL_PREFIX}/env.sh ${CMAKE_COMMAND} -E env ROS_IP=127.0.0.1
  ROS_LOG_DIR=${PROJECT_BINARY_DIR}/ros_log)
file(GLOB rostest_sources CONFIGURE_DEPENDS test/integration/*_rostest.cpp)
foreach(source ${rostest_sources})
  get_filename_component(name ${source} NAME_WE)
  add_executable(${name}
    ${source} test/integration/child_process.cpp
    $<$<NOT:$<STREQUAL:${name},master_rostest>>:test/integration/rostest_main.cpp>)
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib/ergotic)
  target_link_libraries(${name}
    PRIVATE ergotic_audio ergotic_messages ${catkin_LIBRARIES} ergotic_test_support ergotic_flags)
  ergotic_compile_soon(${name})
endforeach()
# Stations of real nodes: NAME.test is live, NAME_long.test for scripts/test --long.
file(GLOB rostests CONFIGURE_DEPENDS test/integration/*.test)
foreach(rostest ${rostests})
  get_filename_component(name ${rostest} NAME_WE)
  add_test(NAME integration.${name} COMMAND ${in_devel_space} /usr/bin/rostest ${rostest})
  set_tests_properties(integration.${name} PROPERTIES RUN_SERIAL ON TIMEOUT 300 LABELS live)
  if(name MATCHES "_long$")
    set_tests_properties(integration.${name} PROPERTIES TIMEOUT 3600 LABELS long)
  endif()
endforeach()

foreach(rostest safety_rostest pairs_rostest)
  target_sources(${rostest}
    PRIVATE test/integration/fault_injection.cpp test/integration/fault_table.cpp)
  add_dependencies(${rostest} ergotic_ros virtual_tgr)
endforeach()
# Sees what real-time threads do that they may not, in programs that have it preloaded.
add_library(realtime_watch SHARED test/realtime_watch/realtime_watch.cpp
  test/support/alloc_count.cpp test/support/realtime_scope.cpp)
target_include_directories(realtime_watch PRIVATE test include)
target_compile_options(realtime_watch PRIVATE -ftls-model=initial-exec)
target_link_libraries(realtime_watch PRIVATE PkgConfig::SECCOMP ergotic_flags ${CMAKE_DL_LIBS})
if(ERGOTIC_SANITIZE STREQUAL "thread")  # or the first library that wants TSan comes too late
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=libtsan.so
    OUTPUT_VARIABLE watch OUTPUT_STRIP_TRAILING_WHITESPACE)
else()
  set(watch $<TARGET_FILE:realtime_watch>)
endif()
target_compile_definitions(realtime_rostest PRIVATE REALTIME_WATCH="${watch}")
add_dependencies(realtime_rostest ergotic_ros virtual_tgr realtime_watch)
# A wall clock that jumps, for programs that have it preloaded.
add_library(clock_shift SHARED test/clock_shift/clock_shift.cpp)
target_include_directories(clock_shift PRIVATE test)
target_link_libraries(clock_shift PRIVATE ergotic_flags ${CMAKE_DL_LIBS})
# Pictures that take their time, in the same way.
add_library(slow_display SHARED test/slow_display/slow_display.cpp)
target_include_directories(slow_display PRIVATE src)
target_link_libraries(slow_display PRIVATE ergotic_core ergotic_messages ergotic_flags)
# Gamepads that are pipes, in the same way.
add_library(piped_pads SHARED test/piped_pads/piped_pads.cpp)
target_include_directories(piped_pads PRIVATE src test)
target_link_libraries(piped_pads PRIVATE ergotic_core ergotic_flags)
target_include_directories(gamepads_rostest PRIVATE src)
target_compile_definitions(gamepads_rostest PRIVATE PIPED_PADS="$<TARGET_FILE:piped_pads>")
add_dependencies(gamepads_rostest ergotic_ros piped_pads)
target_compile_definitions(outside_rostest PRIVATE
  CLOCK_SHIFT="$<TARGET_FILE:clock_shift>" SLOW_DISPLAY="$<TARGET_FILE:slow_display>")
add_dependencies(outside_rostest ergotic_ros virtual_tgr render clock_shift slow_display)
add_dependencies(master_rostest ergotic_ros virtual_tgr)
add_dependencies(crowd_rostest ergotic_ros virtual_tgr)
add_dependencies(force_rostest ergotic_ros ergotic_generate_messages_py)
add_dependencies(deployed_rostest ergotic_ros)
target_sources(melody_rostest PRIVATE test/integration/melody_player.cpp)
target_link_libraries(melody_rostest PRIVATE PkgConfig::SMF PkgConfig::JACK)
add_dependencies(melody_rostest ergotic_ros)
target_compile_definitions(drivers_rostest PRIVATE COMEDI_STANDIN="$<TARGET_FILE:comedi_standin>")
add_dependencies(drivers_rostest
  ergotic_ros ergotic_comedi_plugin ergotic_jack_plugin comedi_standin jack_tgr)

# Who reaches a station from another host, with masters of its own.
add_test(NAME integration.remote
  COMMAND ${in_devel_space} ${PROJECT_SOURCE_DIR}/test/integration/remote_test.py)
set_tests_properties(integration.remote PROPERTIES RUN_SERIAL ON TIMEOUT 300 LABELS long)

# The package that docs/driver.md shows, built out of an install space.
add_test(NAME integration.driver_page
  COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/test/integration/driver_page_long_test.py ${PROJECT_BINARY_DIR})
set_tests_properties(integration.driver_page PROPERTIES RUN_SERIAL ON TIMEOUT 600 LABELS long)

# scripts/station, with a master and a JACK server of its own.
add_test(NAME integration.front_door
  COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/test/integration/front_door_long_test.py
          ${CATKIN_DEVEL_PREFIX}/setup.bash)
set_tests_properties(integration.front_door PROPERTIES RUN_SERIAL ON TIMEOUT 240 LABELS long)

# roslaunch reads the files, finds every package and every substitution, and names the nodes:
# ergotic_add_launch_test(NAME NODES ARGUMENTS...)
function(ergotic_add_launch_test name nodes)
  add_test(NAME integration.launch_${name} COMMAND ${in_devel_space}
    /usr/bin/roslaunch --nodes ${PROJECT_SOURCE_DIR}/launch/${name}.launch ${ARGN})
  set_tests_properties(integration.launch_${name} PROPERTIES
    PASS_REGULAR_EXPRESSION "${nodes}" LABELS integration)
endfunction()
ergotic_add_launch_test(station "/station.*/rviz.*/record" record:=x rviz:=true)
ergotic_add_launch_test(show_bag "/station.*/rviz" bag:=x)
