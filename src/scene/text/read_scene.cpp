// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/text/read_scene.hpp"

#include "files/read_file.hpp"
#include "scene/limits.hpp"

namespace ergotic::scene {

Scene readScene(const std::string& text, const std::string& name, const Overrides& overrides) {
  const std::string ending = ".mdl";
  const bool is_mdl = name.size() >= ending.size() &&
                      name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
  return (is_mdl ? readMdl : readYaml)(text, name, overrides);
}

Scene readSceneFile(const std::string& path, const Overrides& overrides) {
  return readScene(files::readFile(path, kMaxTextBytes), path, overrides);
}

}  // namespace ergotic::scene
