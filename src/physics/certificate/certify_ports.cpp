// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "at.hpp"
#include "physics/certificate/certify_parts.hpp"
#include "physics/certificate/port_links.hpp"

namespace ergotic::physics {
namespace {

constexpr double kWarned = 0.5;   // of the passivity limit
constexpr double kTooMuch = 2.0;  // of it

bool isTaken(int port, const DeviceTraits& device) {
  const auto& taken = device.taken_ports;
  return std::find(taken.begin(), taken.end(), port) != taken.end();
}

}  // namespace

std::vector<PortCertificate> judgePorts(const RatedNetwork& networks,
                                        const DeviceTraits& device,
                                        Findings& findings) {
  const scene::Scene& scene = networks.scene();
  std::vector<PortCertificate> certificates;
  if (scene.ports.empty()) {
    return certificates;
  }
  const PortLinks links(networks.network());
  for (int p = 0; p < static_cast<int>(scene.ports.size()); ++p) {
    const scene::Port& port = scene.ports[at(p)];
    if (port.agent >= 0) {
      continue;  // no hand is there
    }
    PortCertificate certificate;
    certificate.port = p;
    certificate.stiffness = links.stiffness(port) * std::abs(port.force_scale) /
                            (std::abs(port.position_scale) * scene.time_unit_s * scene.time_unit_s);
    certificate.limit =
        2.0 * device.damping * networks.rates().gesturalHz() / (1.0 + 2.0 * device.delay_ticks);
    // What an end-effector makes of a port is known where that is.
    const bool is_judged = port.slice >= 0 && !isTaken(p, device);
    certificate.is_refused = is_judged && certificate.stiffness > kTooMuch * certificate.limit;
    certificates.push_back(certificate);
    if (!is_judged || certificate.stiffness <= kWarned * certificate.limit) {
      continue;
    }
    const std::string link = scene.lias[at(links.worst(port))].name;
    const std::string text = "port '" + port.name + "': the hand may meet " +
                             describe(certificate.stiffness) + " N/m, mostly by link '" + link +
                             "'; a slice with " + describe(device.damping) +
                             " N s/m of its own, answered " + describe(device.delay_ticks) +
                             " ticks late, is passive up to " + describe(certificate.limit) +
                             " N/m at " + wholeHz(networks.rates().gesturalHz()) + " Hz";
    const std::string advice =
        ". Soften the link, scale the force down, or raise the gestural rate";
    if (certificate.is_refused) {
      findings.add(Verdict::kUnproven, port.place, text + ": it will buzz or jump" + advice);
    } else {
      findings.add(Verdict::kPassive, port.place, text + " (silent below half of it)" + advice);
    }
  }
  return certificates;
}

}  // namespace ergotic::physics
