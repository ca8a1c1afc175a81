// SPDX-License-Identifier: BSD-3-Clause
#include "ros/hands.hpp"

#include <fstream>
#include <utility>
#include <vector>

#include "ergotic/exception.hpp"

namespace ergotic::node {
namespace {

constexpr double kMostOverLimit = 2.0;

tgr::DriverStack makeDrivers(DriverPlugins& plugins,
                             const tgr::StationDevices& devices,
                             bool allow_fault_injection) {
  const auto make = [&plugins](const std::string& driver, const std::string& settings,
                               const std::string& place) {
    return plugins.make(driver, settings, place);
  };
  return tgr::makeDrivers(devices, make, allow_fault_injection);
}

}  // namespace

Hands::Hands(tgr::StationDevices devices, bool allow_fault_injection)
    : config_(std::move(devices)),
      drivers_(makeDrivers(plugins_, config_, allow_fault_injection)) {}

void Hands::probe(double tick_rate_hz) {
  tgr::Driver& driver = *drivers_.driver;
  driver.open(tick_rate_hz);
  slices_ = driver.slices();
  traits_.damping = driver.damping();
  traits_.delay_ticks = 1.0 + driver.extraDelayTicks();
  have_clock_ = driver.clock() != nullptr;
  driver.close();
}

void Hands::refuseTooStiff(const station::Performer& performer,
                           const tgr::EndEffectors& end_effectors) const {
  const physics::Instrument& instrument = *performer.instrument;
  std::vector<double> stiffness(instrument.scene().ports.size());
  for (const physics::PortCertificate& port : performer.certificate.ports) {
    stiffness[static_cast<std::size_t>(port.port)] = port.stiffness;
  }
  const auto slices =
      tgr::renderedStiffness(instrument.scene(), end_effectors, stiffness, traits_.damping,
                             instrument.rates().gesturalHz(), traits_.delay_ticks);
  for (const tgr::RenderedStiffness& slice : slices) {
    if (slice.stiffness > kMostOverLimit * slice.limit) {
      throw Exception("slice " + std::to_string(slice.slice) + " would be " +
                      std::to_string(slice.stiffness) +
                      " N/m stiff, allowed: " + std::to_string(kMostOverLimit * slice.limit) +
                      " N/m, twice what is passive; raise position_scale, or lower force_scale or "
                      "the stiffness of the model");
    }
  }
}

void Hands::save(const std::string& path) {
  for (const tgr::DriverStack::Part& part : drivers_.raw_parts) {
    config_.devices[static_cast<std::size_t>(part.device)].calibration =
        part.calibrated->calibration();
  }
  std::ofstream file(path);
  file << tgr::toYaml(config_);
  if (!file.flush()) {
    throw Exception(path + ": cannot be written");
  }
}

}  // namespace ergotic::node
