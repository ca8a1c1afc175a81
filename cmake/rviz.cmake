# SPDX-License-Identifier: BSD-3-Clause
# What rviz loads: every source in src/rviz, as one library. A plugin of it has an entry in rviz_plugins.xml.
# They speak to the station through messages and services alone, so nothing of ours is linked. No moc is run: what
# Qt calls are lambdas, and no class says Q_OBJECT.
function(ergotic_add_rviz_plugins)
  find_package(rviz REQUIRED)
  find_package(Qt5 REQUIRED COMPONENTS Widgets)
  file(GLOB sources CONFIGURE_DEPENDS src/rviz/*.cpp)
  ergotic_batch(sources rviz ${sources})
  add_library(ergotic_rviz SHARED ${sources})
  target_include_directories(ergotic_rviz PUBLIC src)
  target_include_directories(ergotic_rviz SYSTEM PUBLIC ${rviz_INCLUDE_DIRS})
  target_compile_definitions(ergotic_rviz PRIVATE QT_NO_KEYWORDS)  # boost has names like theirs
  target_link_options(ergotic_rviz PRIVATE -Wl,--as-needed)  # rviz names all that it is made of
  target_link_libraries(ergotic_rviz
    PUBLIC ergotic_messages PRIVATE ergotic_flags Qt5::Widgets ${rviz_LIBRARIES} ${catkin_LIBRARIES} yaml-cpp)
endfunction()
ergotic_add_rviz_plugins()
