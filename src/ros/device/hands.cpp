// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/hands.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "ergotic/exception.hpp"

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

/// All of it or nothing: written beside the old one, which goes only when the new one is complete.
void replaceFile(const std::string& path, const std::string& text) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path file = fs::weakly_canonical(path, error);  // a link stays one
  if (error || (fs::exists(file, error) && !fs::is_regular_file(file, error))) {
    throw Exception(path + ": cannot be written, allowed: a file");
  }
  const fs::path draft = file.string() + ".new";
  std::ofstream out(draft);
  out << text;
  out.close();
  if (out) {
    fs::rename(draft, file, error);
  }
  if (!out || error) {
    fs::remove(draft, error);
    throw Exception(path + ": cannot be written");
  }
}

}  // namespace

Hands::Hands(tgr::StationDevices devices, bool allow_fault_injection)
    : config_(std::move(devices)),
      drivers_(makeDrivers(plugins_, config_, allow_fault_injection)) {}

void Hands::probe(double tick_rate_hz, double slice_mass_kg) {
  tgr::Driver& driver = *drivers_.driver;
  driver.open(tick_rate_hz);
  slices_ = driver.slices();
  traits_.damping = driver.damping();
  traits_.mass = slice_mass_kg;
  traits_.delay_ticks = 1.0 + driver.extraDelayTicks();
  driver.close();
}

void Hands::save(const std::string& path) {
  for (const tgr::DriverStack::Part& part : drivers_.raw_parts) {
    config_.devices[static_cast<std::size_t>(part.device)].calibration =
        part.calibrated->calibration();
  }
  replaceFile(path, tgr::toYaml(config_));
}

}  // namespace ergotic::node
