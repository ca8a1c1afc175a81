// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/read_scene.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "ergotic/exception.hpp"
#include "scene/limits.hpp"

namespace ergotic::scene {
namespace {

/// The bytes of a file, but not many more than are allowed: who reads the text says so.
std::string readBytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text;
  std::array<char, 1U << 16U> chunk;
  while (file.good() && text.size() <= kMaxTextBytes) {
    file.read(chunk.data(), chunk.size());
    text.append(chunk.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (!file.is_open() || file.bad()) {
    throw Exception(path + ": error: cannot read the scene: " + std::strerror(errno));
  }
  return text;
}

}  // namespace

Scene readScene(const std::string& text, const std::string& name, const Overrides& overrides) {
  const std::string ending = ".mdl";
  const bool is_mdl = name.size() >= ending.size() &&
                      name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
  return (is_mdl ? readMdl : readYaml)(text, name, overrides);
}

Scene readSceneFile(const std::string& path, const Overrides& overrides) {
  return readScene(readBytes(path), path, overrides);
}

}  // namespace ergotic::scene
