// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/hands.hpp"

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "files/replace_file.hpp"

namespace ergotic::node {
namespace {

tgr::DriverStack makeDrivers(DriverPlugins& plugins,
                             const tgr::StationDevices& devices,
                             bool allow_fault_injection) {
  const auto make = [&plugins](const std::string& driver, const YAML::Node& settings,
                               const std::string& place) {
    return plugins.make(driver, settings, place);
  };
  return tgr::makeDrivers(devices, make, allow_fault_injection);
}

}  // namespace

std::string homeFolder() {
  if (const char* ros = std::getenv("ROS_HOME")) {
    return std::string(ros) + "/ergotic";
  }
  const char* home = std::getenv("HOME");
  return std::string(home != nullptr ? home : ".") + "/.ros/ergotic";
}

Hands::Hands(tgr::StationDevices devices, bool allow_fault_injection)
    : config_(std::move(devices)),
      drivers_(makeDrivers(plugins_, config_, allow_fault_injection)) {}

void Hands::probe(double tick_rate_hz, double slice_mass_kg) {
  tgr::Driver& driver = *drivers_.driver;
  driver.open(tick_rate_hz);
  slices_ = driver.slices();
  can_hurt_ = driver.canHurt();
  gesture_values_ = driver.gestureValues();
  traits_.damping = driver.damping();
  traits_.mass = slice_mass_kg;
  traits_.delay_ticks = 1.0 + driver.extraDelayTicks();
  driver.close();
}

void Hands::checkGestures(const std::vector<scene::Parameter>& parameters) const {
  for (const tgr::GestureValue& value : gesture_values_) {
    static_cast<void>(tgr::parameterOf(value, parameters));
  }
}

std::optional<int> Hands::uncheckedSlice() const {
  for (const tgr::DriverStack::Part& part : drivers_.raw_parts) {
    const auto& slices = part.calibrated->calibration().slices;
    for (std::size_t i = 0; i < slices.size(); ++i) {
      if (slices[i].is_calibrated && !tgr::isChecked(slices[i])) {
        return part.first_slice + static_cast<int>(i);
      }
    }
  }
  return std::nullopt;
}

std::string Hands::save(const std::string& name) {
  for (const tgr::DriverStack::Part& part : drivers_.raw_parts) {
    config_.devices[static_cast<std::size_t>(part.device)].calibration =
        part.calibrated->calibration();
  }
  return files::replaceFile(homeFolder(), name, tgr::toYaml(config_));
}

}  // namespace ergotic::node
