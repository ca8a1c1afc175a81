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

/// What the scene says of itself.
Json aboutReport(const scene::About& about);

/// How many modules each selection means.
Json selectionsReport(const scene::Scene& scene);

/// The verdict on each variant of the scene.
/// \param unstable  gets the names of those that cannot be played
/// \throws TextError, Exception as reading does
Json variantsReport(const std::vector<std::string>& variants,
                    const SceneOptions& options,
                    const physics::DeviceTraits& device,
                    std::vector<std::string>& unstable);

/// Each section: its rate, geometry and place, modules, and how near to the limit it is.
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

/// The chaplets of a settled scene: what each is, what it is taken to work against, and what it
/// lets through, dB, free and with that load, without the hold of the slower end.
Json filtersReport(const scene::Scene& scene, const physics::Rates& rates);

/// Writes the response of every chaplet of a settled scene from 0 to 4 fN, for a picture of it:
/// `chaplet,ratio,frequency_hz,share_of_fn` and gains in dB: `free,loaded,free_held,loaded_held`
/// and, for comparison, `c3_free,c3_loaded` of the heavier design of the same mass (`nan` at ratios
/// too low for it).
/// \throws Exception with path and reason, also if there is no chaplet
void writeFilterResponse(const std::string& path,
                         const scene::Scene& scene,
                         const physics::Rates& rates);

/// What a musician wants to know of a scene, in about ten lines: whether it is stable, its pitches,
/// hands, outputs and parameters, what it costs here, and every warning.
/// \param report  the whole report of `check`
void printBrief(const Json& report, std::ostream& out);

}  // namespace ergotic::tools
