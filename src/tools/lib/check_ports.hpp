// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/advice/noise.hpp"
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/scene.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {

/// The device that a scene is checked for.
struct DeviceChoice {
  physics::DeviceTraits traits;
  physics::SensorNoise noise;
};

/// Who moves what, how stiff it is, and how much of the sensors' noise is felt.
Json portsReport(const scene::Scene& scene,
                 const physics::Rates& rates,
                 const physics::Certificate& certificate,
                 const physics::SensorNoise& noise);
Json agentsReport(const scene::Scene& scene);
/// What audio channels move or push, and what is heard on them.
Json inputsReport(const scene::Scene& scene);
Json outputsReport(const scene::Scene& scene);

/// Why the ports that the certificate refuses cannot be played, as the station says, too:
/// `file:line:col: error: ...`.
std::vector<std::string> refusedPorts(const physics::Certificate& certificate);

}  // namespace ergotic::tools
