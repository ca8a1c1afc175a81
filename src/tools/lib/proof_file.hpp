// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/certificate/proof.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::tools {

/// Writes what proves a verdict, with the network that it is about, for `scripts/check_proof`.
/// Format: docs/physics.md, "Proofs".
/// \param scene  settled
/// \throws Exception if the verdict is neither passive nor bounded, or its proof cannot be written
void writeProof(const std::string& file,
                const scene::Scene& scene,
                const physics::Rates& rates,
                physics::Verdict verdict,
                const physics::Proof& proof);

}  // namespace ergotic::tools
