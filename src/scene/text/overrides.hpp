// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/scene/text/read_scene.hpp"

namespace ergotic::scene {

/// The override that is no parameter; no parameter may have this name.
constexpr const char* kGesturalRateName = "gestural_rate";

/// \param names  parameters of the text
/// \throws Exception listing every known name if an override has another, or is not finite
void checkOverrides(const Overrides& overrides,
                    const std::vector<std::string>& names,
                    const std::string& file);

/// The gestural rate to use: the override's, else `written`, Hz.
/// \throws Exception if the override is out of range
double overrideGesturalRate(const Overrides& overrides, double written, const std::string& file);

}  // namespace ergotic::scene
