// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ergotic;
  const auto read = [](const std::string& text, const std::string& name,
                       const scene::Overrides& overrides) {
    return scene::readYaml(text, name, overrides);
  };
  fuzz::readScene(fuzz::textOf(data, size), read);
  return 0;
}
