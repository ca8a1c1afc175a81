# SPDX-License-Identifier: BSD-3-Clause
# The layout of a catkin install space, with or without ROS: rosrun and roslaunch find their way.
set(ergotic_libraries ergotic_core ergotic_audio)
foreach(library ergotic_bag ergotic_ros ergotic_rviz ergotic_comedi_driver ergotic_jack_driver
    ergotic_comedi_plugin ergotic_jack_plugin ergotic_priority_inheritance)
  if(TARGET ${library})
    list(APPEND ergotic_libraries ${library})
  endif()
endforeach()
set_target_properties(${ergotic_libraries} PROPERTIES INSTALL_RPATH "$ORIGIN")
install(TARGETS ${ergotic_libraries} LIBRARY DESTINATION lib)
install(PROGRAMS scripts/plot_modes scripts/plot_feel DESTINATION lib/ergotic)  # for --plot
if(ergotic_tools)
  set_target_properties(${ergotic_tools} PROPERTIES INSTALL_RPATH "$ORIGIN/..")
  install(TARGETS ${ergotic_tools} RUNTIME DESTINATION lib/ergotic)
endif()

install(DIRECTORY include/ergotic DESTINATION include FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY models config DESTINATION share/ergotic)
if(ERGOTIC_ROS)
  # The contract of drivers, for those of others: cmake/ergotic-extras.cmake.in
  install(FILES test/support/alloc_count.cpp test/support/alloc_count.hpp test/support/driver_contract.hpp
    DESTINATION share/ergotic/testing/support)
  install(DIRECTORY launch rviz urdf DESTINATION share/ergotic)
  install(FILES nodelet_plugins.xml rviz_plugins.xml tgr_driver_plugins.xml DESTINATION share/ergotic)
  install(PROGRAMS scripts/calibrate scripts/play_gesture scripts/window DESTINATION lib/ergotic)
endif()
