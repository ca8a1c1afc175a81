// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/settings.hpp"

#include <vector>

#include "scene/text/source_text.hpp"
#include "scene/yaml/yaml_documents.hpp"

namespace ergotic::tgr {
YAML::Node parseSettings(const std::string& text, const std::string& file) {
  scene::checkBytes(text, file, scene::Bytes::kUtf8);
  const scene::SceneBuilder builder(file, text);
  const std::vector<YAML::Node> documents = scene::readDocuments(builder, text, 1, "settings need");
  return documents.empty() || documents.front().IsNull() ? YAML::Node(YAML::NodeType::Map)
                                                         : documents.front();
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
