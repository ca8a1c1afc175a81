// SPDX-License-Identifier: BSD-3-Clause
// Tables and gestures that scenes name.
#include <sstream>

#include "fuzz/fuzz.hpp"
#include "scene/text/gesture_csv.hpp"
#include "scene/yaml/table_csv.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ergotic;
  const std::string text = fuzz::textOf(data, size);
  fuzz::readOrRefuse(text, [&] { return scene::readTableCsv(text, fuzz::kFile); });
  for (const int slices : {1, 64}) {
    fuzz::readOrRefuse(text, [&] {
      std::istringstream in(text);
      scene::GestureReader rows(in, fuzz::kFile, slices, {"m", -1.0, 1.0});
      while (rows.next()) {
      }
      return rows.isInTicks();
    });
  }
  return 0;
}
