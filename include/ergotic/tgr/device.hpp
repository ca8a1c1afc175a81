// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ergotic/tgr/calibration.hpp"
#include "ergotic/tgr/combined_driver.hpp"
#include "ergotic/tgr/end_effector.hpp"
#include "ergotic/tgr/faulty_driver.hpp"

namespace ergotic::tgr {

/// One device of a station: a driver, its settings, and the calibration of its slices.
struct DeviceConfig {
  std::string driver;  ///< name: virtual, replay, comedi, jack, or a plugin's
  std::shared_ptr<const YAML::Node> settings;  ///< map, see DriverFactory::make; null: none
  std::string place;                           ///< name of the file of `settings`, for messages
  std::optional<Calibration> calibration;
  scene::Place driver_at{1, 1};  ///< place of the driver's name in the file of the devices
  scene::Place calibration_at{1, 1};
};

/// Devices and end-effectors of a station, as one YAML file: `devices: [{driver: ..., settings:
/// {...}, calibration: [...]}]` and `end_effectors: {...}`. Slices are counted over all devices.
struct StationDevices {
  std::string file;
  std::vector<DeviceConfig> devices;  ///< at least one
  scene::Place devices_at{1, 1};      ///< place of the list in the file
  EndEffectors end_effectors;
};

/// \throws TextError with file:line:col, value and allowed range
StationDevices readDevices(const std::string& text, const std::string& name);
std::string toYaml(const StationDevices& devices);

/// The drivers of a station, one inside the other; the station owns `driver`, and with it the rest.
struct DriverStack {
  struct Part {
    int device = 0;       ///< index in StationDevices::devices
    int first_slice = 0;  ///< index of its first slice among all slices
    CalibratedDriver* calibrated = nullptr;
  };
  std::unique_ptr<Driver> driver;
  std::vector<Part> raw_parts;     ///< the devices that speak volts
  FaultyDriver* faulty = nullptr;  ///< null unless faults may be injected
};

/// Makes a driver by its name. \throws Exception if there is no such driver
using DriverMaker = std::function<std::unique_ptr<Driver>(
    const std::string& driver, const YAML::Node& settings, const std::string& place)>;

/// The drivers of the core: `virtual` and `replay`. \throws Exception naming those that exist
std::unique_ptr<Driver> makeCoreDriver(const std::string& driver,
                                       const YAML::Node& settings,
                                       const std::string& place);

/// \throws TextError with the place of the device where the settings or the maker name none, or if
///         a device that does not speak volts has a calibration, or devices do not go together;
///         DeviceError from the makers
DriverStack makeDrivers(const StationDevices& devices,
                        const DriverMaker& make,
                        bool allow_fault_injection);

}  // namespace ergotic::tgr
