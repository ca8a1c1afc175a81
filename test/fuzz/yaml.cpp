// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ergotic;
  fuzz::readScene(fuzz::textOf(data, size), scene::readYaml);
  return 0;
}
