// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// A spring of stiffness K and rest length L that is l > L long where its ends rest is the sum of
/// two: one of stiffness K (1 - L/l) without a rest length, which is linear, and one of K L/l with
/// the rest length l, which then pushes nothing. Guarded ones become these two, the first of them
/// explicit and appended as `<name>.tension`: what moves across the line is held by the tension
/// alone, so it keeps its pitch at any stiffness, and the guard has nothing to hold at rest. The
/// damper is that of the guarded one, but in a line, where it never turns, that of the other. One
/// without a rest length is guarded for its damper only.
/// \param scene  whose schemes are chosen
/// Realtime: no. Source: docs/physics.md, "Guarded links".
void splitSprings(scene::Scene& scene);

}  // namespace ergotic::physics
