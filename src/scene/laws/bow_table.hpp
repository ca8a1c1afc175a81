// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/laws/law.hpp"

namespace ergotic::scene {

/// Guarded friction of a table over velocity.
const GuardedForms& slipTableForms(const Lia& lia);

}  // namespace ergotic::scene
