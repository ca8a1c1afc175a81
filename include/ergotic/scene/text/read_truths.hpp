// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/scene/scene.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "ergotic/scene/truth.hpp"

namespace ergotic::scene {

/// A scene and what it claims of itself. What plays does not know of the claims.
struct ClaimingScene {
  Scene scene;
  std::vector<Truth> truths;
};

/// The scene of a YAML text as `readYaml` gives it, and its `truths`.
/// Realtime: no. Thread: any. \throws as `readYaml`, which looks at all truths, too
ClaimingScene readTruths(const std::string& text,
                         const std::string& name,
                         const Overrides& overrides = {},
                         const Choice& choice = {});

/// The same for a file; `.mdl` files claim nothing. \throws Exception if it cannot be read
ClaimingScene readTruthsFile(const std::string& path,
                             const Overrides& overrides = {},
                             const Choice& choice = {});

}  // namespace ergotic::scene
