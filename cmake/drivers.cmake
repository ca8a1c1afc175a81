# SPDX-License-Identifier: BSD-3-Clause
# Drivers that need more than the core: each folder of src/tgr/drivers named here is a library of its
# own. `<name>_plugin.cpp`, which tells pluginlib of it, is only compiled with ROS (cmake/ros.cmake).
function(ergotic_add_driver name)
  file(GLOB sources CONFIGURE_DEPENDS src/tgr/drivers/${name}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "_plugin\\.cpp$")
  if(sources)
    ergotic_batch(sources ${name}_driver ${sources})
    add_library(ergotic_${name}_driver SHARED ${sources})
    target_include_directories(ergotic_${name}_driver PUBLIC src)
    target_link_libraries(ergotic_${name}_driver
      PUBLIC ergotic_core yaml-cpp PRIVATE ergotic_flags ${ARGN})
  endif()
endfunction()

find_package(PkgConfig REQUIRED)
pkg_check_modules(COMEDI REQUIRED IMPORTED_TARGET comedilib)
ergotic_add_driver(comedi PkgConfig::COMEDI)
ergotic_add_driver(jack ergotic_audio)
