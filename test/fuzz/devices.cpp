// SPDX-License-Identifier: BSD-3-Clause
// The file of devices, and the settings of every driver in it.
#include <yaml-cpp/yaml.h>

#include "ergotic/tgr/device.hpp"
#include "fuzz/fuzz.hpp"
#include "tgr/drivers/comedi/comedi_settings.hpp"
#include "tgr/drivers/jack/jack_settings.hpp"
#include "tgr/drivers/virtual/virtual_settings.hpp"

namespace ergotic::fuzz {
namespace {

/// As every driver would, whatever the device says that it is.
void readSettings(const std::string& text, const tgr::DeviceConfig& device) {
  const YAML::Node& node = *device.settings;
  readOrRefuse(text, [&] { return tgr::readVirtualSettings(node, device.place); });
  readOrRefuse(text, [&] { return tgr::readComediSettings(node, device.place); });
  readOrRefuse(text, [&] { return tgr::readJackSettings(node, device.place); });
}

void use(const std::string& text, const tgr::StationDevices& devices) {
  if (tgr::readDevices(toYaml(devices), kFile).devices.size() != devices.devices.size()) {
    fail("written as something else:\n" + toYaml(devices));
  }
  for (const tgr::DeviceConfig& device : devices.devices) {
    if (device.settings) {
      readSettings(text, device);
    }
  }
}

}  // namespace
}  // namespace ergotic::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ergotic;
  const std::string text = fuzz::textOf(data, size);
  if (const auto devices =
          fuzz::readOrRefuse(text, [&] { return tgr::readDevices(text, fuzz::kFile); })) {
    fuzz::use(text, *devices);
  }
  return 0;
}
