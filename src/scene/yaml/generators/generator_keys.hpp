// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/yaml/yaml_elements.hpp"

/// Keys that several generators have.
namespace ergotic::scene {

const Section& sectionAt(const SceneBuilder& builder, int index);

/// 0 in scalar sections, where the key is refused.
double readRestLengthRatio(const SceneBuilder& builder, const YamlMap& map, int section);

/// The scheme that the key `scheme` asks for, kAuto without it. Scenes of earlier versions say
/// `energy_stable` for `energy_stable`; that is read, with one warning for the whole scene.
Scheme schemeAskedFor(SceneBuilder& builder, const YamlMap& map);

/// Reads the scheme of links with a rest length, or with a damper in a plane or space; other links
/// are linear.
Scheme readScheme(SceneBuilder& builder,
                  const YamlMap& map,
                  const Section& section,
                  const Value& damping,
                  double rest_length_ratio);

}  // namespace ergotic::scene
