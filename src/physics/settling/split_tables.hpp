// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// A table of which an end, with what its viscous part gives at rest, pushes outwards has a
/// potential without a floor, and what drives no damper of its own takes: only the springs and
/// dampers around hold it. With k and z less than these do, it is the sum of a linear link,
/// -k (e - e0) - z v, explicit and appended as `<name>.push`, and of a rest with a floor that
/// brakes, which is guarded. Where nothing holds it so far it stays as it is, and with a viscous
/// part explicit.
/// \param scene  whose schemes may be open
/// Realtime: no. Source: docs/physics.md, "Guarded links".
void splitTables(scene::Scene& scene, const Rates& rates);

}  // namespace ergotic::physics
