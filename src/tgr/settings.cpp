// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/settings.hpp"

#include <yaml-cpp/depthguard.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "scene/text/source_text.hpp"

namespace ergotic::tgr {
namespace {

scene::Place placeOfMark(const YAML::Mark& mark) {
  return {std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1};
}

}  // namespace

YAML::Node parseSettings(const std::string& text, const std::string& file) {
  scene::checkBytes(text, file, scene::Bytes::kUtf8);
  const scene::SceneBuilder builder(file, text);
  try {
    const YAML::Node node = YAML::Load(text);
    return node.IsNull() ? YAML::Node(YAML::NodeType::Map) : node;
  } catch (const YAML::DeepRecursion& e) {
    builder.fail(placeOfMark(e.mark), "nested too deeply, allowed: as deep as settings need");
  } catch (const YAML::Exception& e) {
    builder.fail(placeOfMark(e.mark), "not valid YAML: " + e.msg);
  }
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

std::string besideFile(const std::string& path, const std::string& file) {
  const std::size_t slash = file.rfind('/');
  const bool is_absolute = !path.empty() && path.front() == '/';
  return is_absolute || slash == std::string::npos ? path : file.substr(0, slash + 1) + path;
}

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

}  // namespace ergotic::tgr
