// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/tgr/device.hpp"
#include "ros/device/driver_plugins.hpp"

namespace ergotic::node {

/// Folder of this program's own files, whoever asks for it: `$ROS_HOME/ergotic`, or
/// `~/.ros/ergotic`.
std::string homeFolder();

/// Devices of a station and the end-effectors on their slices. The drivers go to the station, which
/// must not outlive this object: it holds their code.
/// Thread: loader while it is made, then command thread. Realtime: no
class Hands {
 public:
  /// Makes the drivers; does not open them.
  /// \throws Exception from the drivers, or naming those that exist
  Hands(tgr::StationDevices devices, bool allow_fault_injection);

  /// Opens the devices and closes them again, for what they say of themselves.
  /// \param slice_mass_kg  which they do not say
  /// \throws DeviceError saying what is wrong and what to do
  void probe(double tick_rate_hz, double slice_mass_kg);

  // After `probe`.
  int slices() const { return slices_; }
  const physics::DeviceTraits& traits() const { return traits_; }
  bool canHurt() const { return can_hurt_; }  ///< tgr::Driver::canHurt of any of them
  /// \throws TextError if a gesture of a device sets parameters that a scene does not have, or not
  ///         with such a value
  void checkGestures(const std::vector<scene::Parameter>& parameters) const;

  /// The drivers, for the station that is about to be made. Once
  std::unique_ptr<tgr::Driver> takeDriver() { return std::move(drivers_.driver); }

  const tgr::StationDevices& config() const { return config_; }
  /// The devices that speak volts.
  const std::vector<tgr::DriverStack::Part>& rawParts() const { return drivers_.raw_parts; }
  /// First calibrated slice whose sign and scale no push has confirmed.
  std::optional<int> uncheckedSlice() const;
  /// \return null unless faults may be injected
  tgr::FaultyDriver* faulty() const { return drivers_.faulty; }
  void setEndEffectors(tgr::EndEffectors end_effectors) {
    config_.end_effectors = std::move(end_effectors);
  }
  /// Devices with the calibrations that they have now, as a YAML file below `$ROS_HOME/ergotic`
  /// (`~/.ros/ergotic`). \return its path
  /// \throws Exception naming the file if it cannot be written; an old one is left as it was then
  std::string save(const std::string& name);

 private:
  DriverPlugins plugins_;
  tgr::StationDevices config_;
  tgr::DriverStack drivers_;  // of which the station has the driver, once it is taken
  int slices_ = 0;
  bool can_hurt_ = true;
  std::vector<tgr::GestureValue> gesture_values_;
  physics::DeviceTraits traits_;
};

}  // namespace ergotic::node
