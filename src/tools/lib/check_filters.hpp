// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {

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

}  // namespace ergotic::tools
