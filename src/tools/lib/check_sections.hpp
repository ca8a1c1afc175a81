// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/scene.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {

/// Each section: its rate, geometry and place, modules, and how near to the limit it is.
Json sectionsReport(const scene::Scene& scene,
                    const physics::Rates& rates,
                    const physics::Certificate& certificate);

/// The verdict, what it means, and what to do about it.
Json stabilityReport(const scene::Scene& scene,
                     const physics::Rates& rates,
                     const physics::Certificate& certificate);

}  // namespace ergotic::tools
