// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/laws/law.hpp"

namespace ergotic::scene {

/// K p + Q p^3, guarded; linear springs are those with Q = 0.
const GuardedForms& cubicForms(const Lia& lia);

// Of two-sided springs with K e and a nonlinearity Q.
Slopes springSlopes(const Scene& scene, const Lia& lia);
Growth::Figure nonlinearityFigure(const Scene& scene, const Lia& lia);
double leastSpringStiffness(const Scene& scene, const Lia& lia);

}  // namespace ergotic::scene
