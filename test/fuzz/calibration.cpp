// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/calibration.hpp"

#include "fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ergotic;
  const std::string text = fuzz::textOf(data, size);
  const auto read =
      fuzz::readOrRefuse(text, [&] { return tgr::readCalibration(text, fuzz::kFile); });
  if (!read) {
    return 0;
  }
  const std::string written = toYaml(*read);
  if (toYaml(tgr::readCalibration(written, fuzz::kFile)) != written) {
    fuzz::fail("written as something else:\n" + written);
  }
  return 0;
}
