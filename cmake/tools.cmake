# SPDX-License-Identifier: BSD-3-Clause
# Performances played again from what was recorded, for the tools and the nodelet.
file(GLOB replay_sources CONFIGURE_DEPENDS src/replay/*.cpp)
ergotic_batch(replay_sources replay ${replay_sources})
add_library(ergotic_replay STATIC ${replay_sources})
target_include_directories(ergotic_replay PUBLIC src)
target_link_libraries(ergotic_replay PUBLIC ergotic_core PRIVATE ergotic_flags)

# Command-line tools: src/tools/<name>.cpp is `rosrun ergotic <name>`; other sources are shared.
set(ergotic_tools "")
file(GLOB tool_library_sources CONFIGURE_DEPENDS src/tools/lib/*.cpp)
if(tool_library_sources)
  ergotic_batch(tool_library_sources tools ${tool_library_sources})
  add_library(ergotic_tool_support STATIC ${tool_library_sources})
  target_include_directories(ergotic_tool_support PUBLIC src)
  target_link_libraries(ergotic_tool_support
    PUBLIC ergotic_advice ergotic_audio ergotic_replay CLI11::CLI11 nlohmann_json::nlohmann_json
    PRIVATE ergotic_flags PkgConfig::EBUR128 PkgConfig::SMF)
  ergotic_precompile(ergotic_tool_support <nlohmann/json.hpp>)
endif()
file(GLOB tool_sources CONFIGURE_DEPENDS src/tools/*.cpp)
foreach(source ${tool_sources})
  get_filename_component(tool ${source} NAME_WE)
  add_executable(${tool} ${source})
  target_link_libraries(${tool} PRIVATE ergotic_tool_support CLI11::CLI11 ergotic_flags)
  list(APPEND ergotic_tools ${tool})
endforeach()
target_link_libraries(jack_tgr PRIVATE ergotic_jack_driver)
