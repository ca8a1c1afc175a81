// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <ergotic/Handles.h>

#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/tgr/end_effector.hpp"

namespace ergotic::node {

/// [Instrument::touchables] 1: a hand can hold it wherever it is, and it is drawn.
std::vector<std::uint8_t> modulesThatCanBeHeld(const physics::Instrument& instrument);

/// What of a scene hands move under these end-effectors, one entry per module.
Handles handlesOf(const scene::Scene& scene, const tgr::EndEffectors& end_effectors);

}  // namespace ergotic::node
