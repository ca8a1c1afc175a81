// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/laws/range.hpp"

namespace ergotic::physics {

using scene::Range;

/// Upper bound of M (kappa + 2 zeta) of a module with matched coefficients, kg, over all that its
/// stiffness, damping and mass can be; exact if they are constant. With links attached it
/// enters the network with it; alone it is stable at any step.
/// Source: docs/physics/stability.md, "How a scene is certified".
double matchedLoad(Range stiffness, Range damping, Range mass, double step);

}  // namespace ergotic::physics
