// SPDX-License-Identifier: BSD-3-Clause
#include "scene/tree/near_file.hpp"

#include <filesystem>
#include <system_error>

#include "ergotic/exception.hpp"
#include "files/read_file.hpp"
#include "files/shipped_models.hpp"
#include "scene/text/source_text.hpp"

namespace ergotic::scene {

std::string pathOfNear(const SceneBuilder& builder,
                       const std::string& name,
                       const std::string& of,
                       Place place) {
  const std::string file = "file " + quoted(name) + (of.empty() ? "" : " of " + of);
  if (!builder.mayReadFiles()) {
    builder.fail(place, file +
                            " is nowhere, for this text is no file and has no folder, allowed: " +
                            "what it would say");
  }
  std::string path = besideFile(name, builder.scene().file);
  if (name.empty() || name.front() == '/' ||
      !files::isBelow(path, besideFile(".", builder.scene().file))) {
    builder.fail(place, file + " is elsewhere, allowed: below the scene's folder");
  }
  return path;
}

std::string pathOfIncluded(const SceneBuilder& builder, const std::string& name, Place place) {
  std::error_code failure;
  const bool is_near = builder.mayReadFiles() &&
                       std::filesystem::exists(besideFile(name, builder.scene().file), failure);
  const std::string shipped = files::shippedModels();
  std::string path = shipped + "/" + name;
  if (!is_near && !shipped.empty() && files::isBelow(path, shipped) &&
      std::filesystem::is_regular_file(path, failure)) {
    return path;
  }
  return pathOfNear(builder, name, "", place);
}

std::string readNear(const SceneBuilder& builder,
                     const std::string& path,
                     std::size_t most,
                     const std::string& of,
                     Place place) {
  try {
    return files::readFile(path, most);
  } catch (const Exception& refusal) {
    builder.fail(place, (of.empty() ? "" : of + ": ") + refusal.what());
  }
}

}  // namespace ergotic::scene
