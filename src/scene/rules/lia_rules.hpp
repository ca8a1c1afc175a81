// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "ergotic/scene/scene.hpp"
#include "scene/limits.hpp"
#include "scene/rules/mover_rules.hpp"

/// What a link may ask for, said once for the YAML reader and for `validate`.
namespace ergotic::scene {

/// Rest lengths: signed along x; a distance where both ends are in Euclidean sections.
Limits restLengthLimits(const Scene& scene, const Lia& lia);

/// |e| at which a conditional link lets go: not before it acts, whatever its parameters are.
Limits releaseLimits(const Scene& scene, const Lia& lia);

/// What is wrong with the scheme or filter of a link; empty if nothing is.
/// \pre the ends of the link exist
std::string schemeFault(const Scene& scene, const Lia& lia);
std::string filterFault(const Scene& scene, const Lia& lia);
/// The same of the numbers and the ends of friction.
std::string frictionFault(const Scene& scene, const Lia& lia);
/// The first link that is to be pressed by a contact that is not there.
std::optional<Fault> unpressed(const Scene& scene);

/// Of what a relaxing link remembers: how many there are, and their numbers.
std::string relaxationFault(const Scene& scene, const Lia& lia);

/// The first of these faults.
std::string liaFault(const Scene& scene, const Lia& lia);

}  // namespace ergotic::scene
