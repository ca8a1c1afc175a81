// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// A table of which both ends, with what its viscous part gives at rest, push the same way has a
/// potential without a floor: only the springs around it hold it. With k less than these do, it is
/// the sum of a linear spring -k (e - e0), explicit and appended as `<name>.push`, and of a rest
/// with a floor, which is guarded. Where nothing holds it, or it pushes outwards on both sides, it
/// stays as it is, and with a viscous part explicit.
/// \param scene  whose schemes may be open
/// Realtime: no. Source: docs/physics.md, "Guarded links".
void splitTables(scene::Scene& scene, const Rates& rates);

}  // namespace ergotic::physics
