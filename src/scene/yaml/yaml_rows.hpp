// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scene/yaml/yaml_elements.hpp"

namespace ergotic::scene {

/// True if what stands under a name is a table of many elements rather than one.
bool isTableOfElements(const Node& node);

/// Many elements of a part of the scene, written as
/// `{columns: [name, mass, at], with: {type: mass}, rows: [[m0, 1e-4, [0, 0]], ...]}`: every row is
/// an element as if it were written out, with the keys of `with` too. An empty cell is a key left
/// out. Calls `element` row by row.
/// \param kind  of the elements, for messages
/// \throws TextError at the offending column, row or cell
void forEachRow(const SceneBuilder& builder,
                const YamlMap& table,
                const std::string& kind,
                const ElementReader& element);

}  // namespace ergotic::scene
