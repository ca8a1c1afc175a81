// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "ergotic/advice/noise.hpp"
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"
#include "tools/lib/options.hpp"
#include "tools/lib/report.hpp"

/// The parts of the report of `check`, each in the source of its name.
namespace ergotic::tools {

/// Reports the `about` part of the scene.
Json aboutReport(const scene::About& about);

/// Reports the number of modules of each selection.
Json selectionsReport(const scene::Scene& scene);

/// Reports the verdict on each variant of the scene.
/// \param unstable  gets the names of the variants that cannot be played
/// \throws TextError, Exception as reading does
Json variantsReport(const std::vector<std::string>& variants,
                    const SceneOptions& options,
                    const physics::DeviceTraits& device,
                    std::vector<std::string>& unstable);

/// Reports each section: its rate, geometry and place, modules, and its distance to the limit.
Json sectionsReport(const scene::Scene& scene,
                    const physics::Rates& rates,
                    const physics::Certificate& certificate);

/// The verdict, what it means, and what to do about it.
Json stabilityReport(const scene::Scene& scene,
                     const physics::Rates& rates,
                     const physics::Certificate& certificate);

/// The points of a scene: on which grid and where, or of which modules with which weights.
Json pointsOf(const scene::Scene& scene);

/// The device that a scene is checked for.
struct DeviceChoice {
  physics::DeviceTraits traits;
  physics::SensorNoise noise;
};

/// Reports for each port its mover, its stiffness, and the force noise from the sensors.
Json portsReport(const scene::Scene& scene,
                 const physics::Rates& rates,
                 const physics::Certificate& certificate,
                 const physics::SensorNoise& noise);
Json agentsReport(const scene::Scene& scene);
/// Report the modules that audio channels move or push, and the quantities output on them.
Json inputsReport(const scene::Scene& scene);
Json outputsReport(const scene::Scene& scene);

/// Errors of the ports that the certificate refuses, as the station reports them: `file:line:col:
/// error: ...`.
std::vector<std::string> refusedPorts(const physics::Certificate& certificate);

/// Reports the chaplets of a settled scene: the kind of each, its assumed load, and its gain, dB,
/// free and with that load, without the hold of the slower end.
Json filtersReport(const scene::Scene& scene, const physics::Rates& rates);

/// Writes the response of every chaplet of a settled scene from 0 to 4 fN, for a picture of it:
/// `chaplet,ratio,frequency_hz,share_of_fn` and gains in dB: `free,loaded,free_held,loaded_held`
/// and, for comparison, `c3_free,c3_loaded` of the heavier design of the same mass (`nan` at ratios
/// too low for it).
/// \throws Exception with path and reason, also if there is no chaplet
void writeFilterResponse(const std::string& path,
                         const scene::Scene& scene,
                         const physics::Rates& rates);

/// Prints a brief report, in about ten lines: the stability of a scene, its pitches, hands, outputs
/// and parameters, its cost on this machine, and every warning.
/// \param report  the whole report of `check`
void printBrief(const Json& report, std::ostream& out);

}  // namespace ergotic::tools
