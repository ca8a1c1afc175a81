// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/settings.hpp"

#include "scene/text/source_text.hpp"

namespace ergotic::tgr {
YAML::Node parseSettings(const std::string& text, const std::string& file) {
  scene::checkBytes(text, file, scene::Bytes::kUtf8);
  const scene::SceneBuilder builder(file, text);
  const YAML::Node node =
      scene::parseYaml(builder, "settings need", [&] { return YAML::Load(text); });
  return node.IsNull() ? YAML::Node(YAML::NodeType::Map) : node;
}

Settings::Settings(const YAML::Node& node, const std::string& file, const std::string& what)
    : builder_(file, ""), node_(node), top_(builder_, node_, what, scene::placeOf(node_, {1, 1})) {}

std::string textInLine(const YAML::Node& node) {
  YAML::Node copy = YAML::Clone(node);
  copy.SetStyle(YAML::EmitterStyle::Flow);  // what is inside follows
  YAML::Emitter out;
  out << copy;
  return out.c_str();
}

}  // namespace ergotic::tgr
