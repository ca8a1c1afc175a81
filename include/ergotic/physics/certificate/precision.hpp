// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/options.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Bodies that single precision would not play truly: several modules that are joined by springs or
/// bends, with a motion that nothing brings back within a second (below kHeldHz). Once such a body
/// flies or turns away, its springs see differences of large positions, each rounded by 6e-8 of
/// itself: a noise that goes on for ever, and grows with the way.
///
/// \param scene  settled
/// \return       a module of each, index in Scene::mats
/// Realtime: no. Cost: one sparse LDL^T of each body that has bends, springs of negative stiffness,
/// or links to points. Source: docs/physics/stability.md, "Bodies that move freely".
std::vector<int> bodiesThatMoveFreely(const scene::Scene& scene);

/// Lowest frequency of a body that counts as held, Hz.
constexpr double kHeldHz = 1.0;

/// `options` with the precision that the scene needs where they leave it open: double if a body
/// moves freely, else float.
CompileOptions withPrecision(CompileOptions options, const scene::Scene& scene);

/// Why double precision was chosen, a sentence for each body: `file:line:col: note: ...`.
std::vector<std::string> notesOnPrecision(const scene::Scene& scene);

/// Lowers a certificate to single precision: bodies that move freely make it *unproven*.
/// \param options  that the scene is compiled with
Certificate inPrecision(Certificate certificate,
                        const scene::Scene& scene,
                        const CompileOptions& options);

}  // namespace ergotic::physics
