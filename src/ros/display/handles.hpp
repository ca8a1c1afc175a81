// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ergotic/Handles.h>

#include "ergotic/scene/scene.hpp"
#include "ergotic/tgr/end_effector.hpp"

namespace ergotic::node {

/// Lists what hands move of a scene under these end-effectors, one entry per module.
Handles handlesOf(const scene::Scene& scene, const tgr::EndEffectors& end_effectors);

}  // namespace ergotic::node
