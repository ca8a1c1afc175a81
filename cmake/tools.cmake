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
set(measuring_sources ${tool_library_sources})
list(FILTER measuring_sources INCLUDE REGEX "/(accuracy|bench|latency|plain_network)[a-z_]*\\.cpp$")
list(REMOVE_ITEM tool_library_sources ${measuring_sources})
set(report_of_flags src/tools/lib/bench_report.cpp)  # compiled alone: it has them as a definition
list(FILTER measuring_sources EXCLUDE REGEX "${report_of_flags}$")
if(tool_library_sources)
  ergotic_batch(tool_library_sources tools ${tool_library_sources})
  ergotic_batch(measuring_sources measuring ${measuring_sources})
  add_library(ergotic_tool_support STATIC ${tool_library_sources})
  target_include_directories(ergotic_tool_support PUBLIC src)
  target_link_libraries(ergotic_tool_support
    PUBLIC ergotic_advice ergotic_audio ergotic_replay CLI11::CLI11 nlohmann_json::nlohmann_json
    PRIVATE ergotic_flags PkgConfig::EBUR128 PkgConfig::SMF)
  ergotic_precompile(ergotic_tool_support <nlohmann/json.hpp>)
  # What measures is of its own: who only plays need not wait for it.
  add_library(ergotic_measuring STATIC ${measuring_sources} ${report_of_flags})
  target_link_libraries(ergotic_measuring PUBLIC ergotic_tool_support PRIVATE ergotic_flags)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
  get_target_property(ergotic_options ergotic_flags INTERFACE_COMPILE_OPTIONS)
  string(REPLACE ";" " " ergotic_options
    "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} ${ergotic_options}")
  set_source_files_properties(${report_of_flags} PROPERTIES
    COMPILE_DEFINITIONS "ERGOTIC_FLAGS=\"${ergotic_options}\"")
endif()
file(GLOB tool_sources CONFIGURE_DEPENDS src/tools/*.cpp)
foreach(source ${tool_sources})
  get_filename_component(tool ${source} NAME_WE)
  add_executable(${tool} ${source})
  target_link_libraries(${tool} PRIVATE ergotic_tool_support CLI11::CLI11 ergotic_flags)
  list(APPEND ergotic_tools ${tool})
endforeach()
foreach(tool accuracy bench latency)
  target_link_libraries(${tool} PRIVATE ergotic_measuring)
endforeach()
target_link_libraries(jack_tgr PRIVATE ergotic_jack_driver)
