// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/scene/scene.hpp"
#include "tools/lib/options.hpp"
#include "tools/lib/report.hpp"

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

}  // namespace ergotic::tools
