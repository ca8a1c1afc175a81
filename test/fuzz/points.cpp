// SPDX-License-Identifier: BSD-3-Clause
// Tables and gestures that scenes name.
#include "fuzz/fuzz.hpp"
#include "scene/yaml/gesture_csv.hpp"
#include "scene/yaml/table_csv.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ergotic;
  const std::string text = fuzz::textOf(data, size);
  fuzz::readOrRefuse(text, [&] { return scene::readTableCsv(text, fuzz::kFile); });
  for (const int slice : {0, 1}) {
    fuzz::readOrRefuse(text, [&] { return scene::readGestureCsv(text, fuzz::kFile, slice); });
  }
  return 0;
}
