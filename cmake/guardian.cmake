# SPDX-License-Identifier: BSD-3-Clause
# The process that outlives a station. It is small, so it has the few sources that it needs of the core
# for itself. Whoever has the core has it, too.
file(GLOB guardian_sources CONFIGURE_DEPENDS src/guardian/*.cpp)
add_executable(guardian ${guardian_sources} src/tgr/drivers/virtual/shared_device.cpp src/rt/clock.cpp
  src/rt/thread.cpp src/exception.cpp)
target_include_directories(guardian PRIVATE include src)
target_link_libraries(guardian PRIVATE ergotic_flags Threads::Threads rt PkgConfig::JACK)
list(APPEND ergotic_tools guardian)
add_dependencies(ergotic_core guardian)
