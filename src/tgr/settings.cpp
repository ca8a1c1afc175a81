// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/settings.hpp"

#include <vector>

#include "scene/text/source_text.hpp"
#include "scene/tree/yaml_documents.hpp"

namespace ergotic::tgr {
namespace {

/// Converts a yaml-cpp node; drivers get such nodes, as they may be plugins of other authors.
scene::Node treeOf(const YAML::Node& node) {
  using Kind = scene::Node::Kind;
  const YAML::Mark mark = node.Mark();
  const scene::Place place =
      mark.is_null() ? scene::Place{0, 0} : scene::Place{mark.line + 1, mark.column + 1};
  if (node.IsScalar()) {
    return {Kind::kScalar, place, node.Scalar()};
  }
  scene::Node tree(node.IsMap()        ? Kind::kMap
                   : node.IsSequence() ? Kind::kList
                                       : Kind::kNull,
                   place);
  for (const auto& part : node) {
    if (node.IsMap()) {
      tree.add(treeOf(part.first));
      tree.add(treeOf(part.second));
    } else {
      tree.add(treeOf(part));
    }
  }
  return tree;
}

}  // namespace

YAML::Node parseSettings(const std::string& text, const std::string& file) {
  scene::checkBytes(text, file, scene::Bytes::kUtf8);
  const scene::SceneBuilder builder(file, text);
  const auto documents = scene::readDocuments(builder, text, 1, "settings need");
  return documents.empty() || documents.front().isNull() ? YAML::Node(YAML::NodeType::Map)
                                                         : YAML::Load(text);
}

Settings::Settings(const YAML::Node& node, const std::string& file, const std::string& what)
    : builder_(file, ""),
      node_(node),
      tree_(treeOf(node)),
      top_(builder_, tree_, what, scene::placeOf(tree_, {1, 1})) {}

std::string textInLine(const YAML::Node& node) {
  YAML::Node copy = YAML::Clone(node);
  copy.SetStyle(YAML::EmitterStyle::Flow);  // what is inside follows
  YAML::Emitter out;
  out << copy;
  return out.c_str();
}

}  // namespace ergotic::tgr
