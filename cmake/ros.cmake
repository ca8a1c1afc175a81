# SPDX-License-Identifier: BSD-3-Clause
# Messages, the nodelet, and what the tools need of rosbag. Works from catkin_make, as a plain CMake
# project, and from an install space.
string(FIND "${PROJECT_BINARY_DIR}/" "${PROJECT_SOURCE_DIR}/build/" ergotic_build_folder)
if(ergotic_build_folder EQUAL 0 AND NOT CATKIN_DEVEL_PREFIX)
  # Not in the build folder: rosrun passes over what is in <package>/build.
  set(CATKIN_DEVEL_PREFIX ${PROJECT_SOURCE_DIR}/devel)
endif()
set(CATKIN_ENABLE_TESTING OFF CACHE BOOL "The tests of ergotic run under ctest")
set(ergotic_ros_packages
  diagnostic_updater geometry_msgs nodelet pluginlib rosbag_storage roscpp sensor_msgs std_msgs
  std_srvs tf2_ros visualization_msgs xmlrpcpp)
find_package(catkin REQUIRED COMPONENTS ${ergotic_ros_packages} message_generation)

file(GLOB ergotic_messages RELATIVE ${PROJECT_SOURCE_DIR}/msg CONFIGURE_DEPENDS msg/*.msg)
file(GLOB ergotic_services RELATIVE ${PROJECT_SOURCE_DIR}/srv CONFIGURE_DEPENDS srv/*.srv)
add_message_files(FILES ${ergotic_messages})
add_service_files(FILES ${ergotic_services})
generate_messages(DEPENDENCIES geometry_msgs std_msgs)
catkin_package(
  INCLUDE_DIRS include
  LIBRARIES ergotic_core ergotic_audio
  CATKIN_DEPENDS geometry_msgs message_runtime nodelet roscpp sensor_msgs std_msgs std_srvs
                 visualization_msgs
  CFG_EXTRAS ergotic-extras.cmake)

# These were made before catkin said where its devel space is.
set_target_properties(ergotic_core ergotic_audio PROPERTIES
  LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib)
foreach(tool ${ergotic_tools})
  set_target_properties(${tool} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib/ergotic)
endforeach()

foreach(driver comedi jack)
  if(TARGET ergotic_${driver}_driver)
    set_target_properties(ergotic_${driver}_driver PROPERTIES
      LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib)
  endif()
endforeach()

# Headers of others are no business of our warnings. Debian's nodelet does not name the include
# folders of pluginlib; pluginlib itself does.
add_library(ergotic_messages INTERFACE)
add_dependencies(ergotic_messages ergotic_generate_messages_cpp)
target_include_directories(ergotic_messages SYSTEM INTERFACE
  ${CATKIN_DEVEL_PREFIX}/include ${catkin_INCLUDE_DIRS} ${pluginlib_INCLUDE_DIRS})

file(GLOB bag_sources CONFIGURE_DEPENDS src/bag/*.cpp)
if(bag_sources)
  add_library(ergotic_bag SHARED ${bag_sources})
  target_include_directories(ergotic_bag PUBLIC src)
  target_link_libraries(ergotic_bag
    PUBLIC ergotic_core ergotic_messages ${rosbag_storage_LIBRARIES} ${roscpp_LIBRARIES}
    PRIVATE ergotic_flags)
  target_link_libraries(ergotic_tool_support PUBLIC ergotic_bag)
  target_compile_definitions(ergotic_tool_support PUBLIC ERGOTIC_HAVE_BAG)
endif()

file(GLOB_RECURSE ros_sources CONFIGURE_DEPENDS src/ros/*.cpp)
ergotic_batch(ros_sources ros ${ros_sources})
add_library(ergotic_ros SHARED ${ros_sources})
target_include_directories(ergotic_ros PUBLIC src)
target_compile_definitions(ergotic_ros PRIVATE ERGOTIC_VERSION="${ergotic_VERSION}")
target_link_libraries(ergotic_ros
  PUBLIC ergotic_core ergotic_audio ergotic_bag ergotic_replay ergotic_messages ${catkin_LIBRARIES}
  PRIVATE ergotic_gamepads ergotic_flags yaml-cpp)
ergotic_precompile(ergotic_ros <ros/node_handle.h>)

foreach(driver comedi jack)
  set(plugin src/tgr/drivers/${driver}/${driver}_plugin.cpp)
  if(EXISTS ${PROJECT_SOURCE_DIR}/${plugin})
    add_library(ergotic_${driver}_plugin SHARED ${plugin})
    target_link_libraries(ergotic_${driver}_plugin
      PRIVATE ergotic_${driver}_driver ergotic_messages ${pluginlib_LIBRARIES} ${class_loader_LIBRARIES}
              ergotic_flags)
  endif()
endforeach()

# Preloaded by station.launch (docs/safety.md).
add_library(ergotic_priority_inheritance SHARED src/preload/priority_inheritance.cpp)
target_link_libraries(ergotic_priority_inheritance PRIVATE ergotic_flags ${CMAKE_DL_LIBS})
