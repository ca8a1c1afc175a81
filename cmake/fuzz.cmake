# SPDX-License-Identifier: BSD-3-Clause
# What reads texts and bags of strangers, under libFuzzer: test/fuzz/<name>.cpp is the program
# fuzz_<name>, and the target `fuzz` is all of them. For clang, with `fuzzer-no-link` among
# ERGOTIC_SANITIZE: see scripts/check_fuzz.
add_custom_target(fuzz)
file(GLOB fuzz_sources CONFIGURE_DEPENDS test/fuzz/*.cpp)
foreach(source ${fuzz_sources})
  get_filename_component(name ${source} NAME_WE)
  add_executable(fuzz_${name} EXCLUDE_FROM_ALL ${source})
  set_target_properties(fuzz_${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/fuzz)
  target_include_directories(fuzz_${name} PRIVATE src test)
  target_link_libraries(fuzz_${name} PRIVATE ergotic_core yaml-cpp ergotic_flags)
  target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
  add_dependencies(fuzz fuzz_${name})
endforeach()
target_link_libraries(fuzz_bag PRIVATE ergotic_bag)
target_sources(fuzz_devices PRIVATE
  src/tgr/drivers/comedi/comedi_settings.cpp src/tgr/drivers/jack/jack_settings.cpp)
# The kernels take long to compile, and scripts/check_sanitizers watches them. Of these clang forgets
# that they load unaligned.
set_source_files_properties(${kernel_sources} PROPERTIES
  COMPILE_OPTIONS "-fno-sanitize=all;-fmax-type-align=4")
