// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/text/read_scene.hpp"

#include "ergotic/exception.hpp"
#include "ergotic/scene/text/read_truths.hpp"
#include "files/read_file.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"

namespace ergotic::scene {

namespace {

bool isMdl(const std::string& name) {
  const std::string ending = ".mdl";
  return name.size() >= ending.size() &&
         name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

}  // namespace

Scene readScene(const std::string& text,
                const std::string& name,
                const Overrides& overrides,
                const Choice& choice) {
  if (isMdl(name) && !choice.variant.empty()) {
    throw Exception(name + ": error: there is no variant " + quoted(choice.variant) +
                    ", a MIMS model has none");
  }
  return isMdl(name) ? readMdl(text, name, overrides) : readYaml(text, name, overrides, choice);
}

ClaimingScene readTruthsFile(const std::string& path,
                             const Overrides& overrides,
                             const Choice& choice) {
  return isMdl(path) ? ClaimingScene{readSceneFile(path, overrides, choice), {}}
                     : readTruths(files::readFile(path, kMaxTextBytes), path, overrides, choice);
}

Scene readSceneFile(const std::string& path, const Overrides& overrides, const Choice& choice) {
  return readScene(files::readFile(path, kMaxTextBytes), path, overrides, choice);
}

}  // namespace ergotic::scene
