// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/text/read_scene.hpp"

#include <cerrno>
#include <cstring>
#include <optional>

#include "ergotic/exception.hpp"
#include "scene/text/source_text.hpp"

namespace ergotic::scene {

Scene readScene(const std::string& text, const std::string& name, const Overrides& overrides) {
  const std::string ending = ".mdl";
  const bool is_mdl = name.size() >= ending.size() &&
                      name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
  return (is_mdl ? readMdl : readYaml)(text, name, overrides);
}

Scene readSceneFile(const std::string& path, const Overrides& overrides) {
  const std::optional<std::string> text = readBytes(path);
  if (!text) {
    throw Exception(path + ": error: cannot read the scene: " + std::strerror(errno));
  }
  return readScene(*text, path, overrides);
}

}  // namespace ergotic::scene
