// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/yaml/yaml_elements.hpp"

/// Keys that several generators have.
namespace ergotic::scene {

const Section& sectionAt(const SceneBuilder& builder, int index);

/// 0 in scalar sections, where the key is refused.
double readRestLengthRatio(const SceneBuilder& builder, const YamlMap& map, int section);

/// Of links with a rest length, or with a damper in a plane or space; others have nothing to guard.
Scheme readScheme(const YamlMap& map,
                  const Section& section,
                  const Value& damping,
                  double rest_length_ratio);

}  // namespace ergotic::scene
