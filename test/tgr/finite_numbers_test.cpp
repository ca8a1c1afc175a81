// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/device.hpp"
#include "scene/no_numbers.hpp"
#include "support/places.hpp"
#include "support/test.hpp"
#include "tgr/drivers/virtual/virtual_settings.hpp"

namespace ergotic::tgr {
namespace {

TEST(FiniteNumbersTest, AreAllThatADeviceFileMaySay) {
  for (const char* name : {"virtual", "virtual_raw", "hands"}) {
    const std::string path = repository(std::string("config/") + name + ".yaml");
    const auto read = [&](const std::string& text) {
      for (const DeviceConfig& device : readDevices(text, path).devices) {
        readVirtualSettings(*device.settings, device.place);
      }
    };
    EXPECT_GT(scene::expectFiniteNumbers(textOf(path), read), 10) << name;
  }
}

TEST(FiniteNumbersTest, AreAllThatACalibrationMaySay) {
  const auto read = [](const std::string& text) { readCalibration(text, "calibration.yaml"); };
  const std::string text =
      "slices:\n  - {metres_per_volt: 0.004, rest_volts: 0.1, low_volts: -9.5, high_volts: 9.5,"
      " volts_per_newton: 0.05, zero_volts: 0.001, max_volts: 10, residual_m: 1e-5,"
      " noise_m: 1e-6 }\n";
  EXPECT_EQ(scene::expectFiniteNumbers(text, read), 9);
}

}  // namespace
}  // namespace ergotic::tgr
