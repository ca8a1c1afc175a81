# SPDX-License-Identifier: BSD-3-Clause
# The laboratory (lab/README.md): programs that measure speed, accuracy and latency. Who plays, and the gate, need not
# wait for them: scripts/build --target lab.
# A plain implementation of the same network, which is measured beside the engine, and by which tests judge it.
add_library(ergotic_plain STATIC EXCLUDE_FROM_ALL lab/lib/plain_network.cpp)
target_include_directories(ergotic_plain PUBLIC ${PROJECT_SOURCE_DIR})
target_link_libraries(ergotic_plain PUBLIC ergotic_core PRIVATE ergotic_flags)
target_include_directories(ergotic_plain PRIVATE src)

file(GLOB lab_library_sources CONFIGURE_DEPENDS lab/lib/*.cpp)
list(FILTER lab_library_sources EXCLUDE REGEX "/(plain_network|bench_report)\\.cpp$")
ergotic_batch(lab_library_sources lab ${lab_library_sources})
set(report_of_flags lab/lib/bench_report.cpp)  # compiled alone: it has them as a definition
add_library(ergotic_lab STATIC EXCLUDE_FROM_ALL ${lab_library_sources} ${report_of_flags})
target_link_libraries(ergotic_lab PUBLIC ergotic_tool_support ergotic_plain PRIVATE ergotic_flags)
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
get_target_property(ergotic_options ergotic_flags INTERFACE_COMPILE_OPTIONS)
string(REPLACE ";" " " ergotic_options
  "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} ${ergotic_options}")
set_source_files_properties(${report_of_flags} PROPERTIES
  COMPILE_DEFINITIONS "ERGOTIC_FLAGS=\"${ergotic_options}\"")

add_custom_target(lab)
foreach(tool accuracy bench latency)
  add_executable(${tool} EXCLUDE_FROM_ALL lab/${tool}.cpp)
  target_link_libraries(${tool} PRIVATE ergotic_lab CLI11::CLI11 ergotic_flags)
  if(CATKIN_DEVEL_PREFIX)
    set_target_properties(${tool} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib/ergotic)
  endif()
  add_dependencies(lab ${tool})
endforeach()
add_dependencies(lab render)  # what is compared with others is played by it
