// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/laws/law.hpp"

namespace ergotic::scene {

/// Slopes of K e + Z v that comes and goes.
Slopes slopesFromZero(const Scene& scene, const Lia& lia);

}  // namespace ergotic::scene
