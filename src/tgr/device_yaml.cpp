// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>

#include "ergotic/exception.hpp"
#include "ergotic/tgr/device.hpp"
#include "scene/names.hpp"
#include "tgr/calibration_rules.hpp"
#include "tgr/settings.hpp"

namespace ergotic::tgr {
namespace {

using scene::Place;
using scene::YamlMap;

/// Reads the name of a driver, as `virtual`, or a plugin's `package/name`.
std::string driverName(const YamlMap& map) {
  std::string name = map.word("driver");
  const auto is_legal = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '/';
  };
  if (name.empty() || !std::all_of(name.begin(), name.end(), is_legal)) {
    map.fail("driver", "driver " + scene::quoted(name) +
                           " is no name, allowed: letters, digits, '_', '-', '/'");
  }
  return name;
}

/// \param index  in the list of devices
DeviceConfig readDevice(const Settings& file, std::size_t index, Place fallback) {
  const scene::Node& node = file.top().at("devices")[index];
  const YamlMap map(file.builder(), node, "a device", scene::placeOf(node, fallback));
  map.allow({"driver", "settings", "calibration"});
  DeviceConfig device;
  device.driver = driverName(map);
  device.driver_at = map.placeAt("driver");
  device.place = file.builder().scene().file;
  if (map.has("settings") && !map.at("settings").isNull()) {
    device.settings = std::make_shared<const YAML::Node>(file.node()["devices"][index]["settings"]);
  }
  if (map.has("calibration")) {
    device.calibration_at = map.placeAt("calibration");
    device.calibration =
        Calibration{readSliceCalibrations(file, map.at("calibration"), device.calibration_at)};
  }
  return device;
}

std::string deviceText(const DeviceConfig& device) {
  std::string text = "  - driver: " + device.driver + "\n";
  if (device.settings) {
    text += "    settings: " + textInLine(*device.settings) + "\n";
  }
  if (device.calibration) {
    text += "    calibration: " + sliceCalibrationsText(*device.calibration) + "\n";
  }
  return text;
}

}  // namespace

StationDevices readDevices(const std::string& text, const std::string& name) {
  const Settings file(parseSettings(text, name), name, "the file of devices");
  const YamlMap& top = file.top();
  top.allow({"devices", "end_effectors"});
  StationDevices result;
  result.file = name;
  const scene::Node& list = top.at("devices");
  result.devices_at = top.placeAt("devices");
  if (!list.isList() || list.size() == 0 || list.size() > kMaxSlices) {
    top.fail("devices", "'devices' is " + scene::kindOf(list) + ", allowed: a list of 1 to " +
                            std::to_string(kMaxSlices) +
                            " maps {driver: ..., settings: {...}, calibration: [...]}");
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    result.devices.push_back(readDevice(file, i, result.devices_at));
  }
  result.end_effectors = readEndEffectors(text, name);
  return result;
}

std::string toYaml(const StationDevices& devices) {
  std::string text = "devices:\n";
  for (const DeviceConfig& device : devices.devices) {
    text += deviceText(device);
  }
  return text + toYaml(devices.end_effectors);
}

}  // namespace ergotic::tgr
