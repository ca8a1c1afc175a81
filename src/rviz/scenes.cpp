// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/scenes.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace ergotic::panel {
namespace {

constexpr std::uintmax_t kLargest = 1U << 20U;    // of a scene whose words are read, bytes
constexpr const char* kNoInstrument = "_truths";  // ends the names of scenes for measurements

bool isForMachines(const std::string& comment) {
  return comment.rfind("SPDX-", 0) == 0 || comment.rfind("yaml-language-server:", 0) == 0;
}

std::string word(const YAML::Node& map, const char* key) {
  const YAML::Node value = map.IsMap() ? map[key] : YAML::Node();
  return value && value.IsScalar() ? value.Scalar() : "";
}

std::string firstOf(const std::vector<std::string>& texts) {
  const auto found =
      std::find_if(texts.begin(), texts.end(), [](const auto& text) { return !text.empty(); });
  return found == texts.end() ? "" : *found;
}

void addVariants(const YAML::Node& variants, std::vector<SceneEntry>& scenes) {
  if (!variants || !variants.IsMap()) {
    return;
  }
  const SceneEntry whole = scenes.front();
  for (const auto& variant : variants) {
    const std::string name = variant.first.Scalar();
    scenes.push_back({whole.model + "#" + name, whole.name, whole.title + ": " + name,
                      firstOf({word(variant.second, "doc"), whole.about}), whole.picture});
  }
}

std::string pictureBeside(const std::filesystem::path& scene) {
  const std::filesystem::path picture =
      scene.parent_path() / "pictures" / scene.stem().concat(".png");
  std::error_code failure;
  return std::filesystem::is_regular_file(picture, failure) ? picture.string() : "";
}

std::string readWhole(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Description of the notes, from the comment on top of the map beside a scene.
std::string notesOf(const std::filesystem::path& scene) {
  const std::filesystem::path map = scene.parent_path() / "maps" / scene.stem().concat(".yaml");
  const std::string comment = leadingComment(readWhole(map));
  const std::size_t colon = comment.find(": ");
  return colon == std::string::npos
             ? ""
             : " Notes (key Z is C3, Q is C4; Page Up, Page Down: an octave higher, lower): " +
                   comment.substr(colon + 2);
}

bool isInstrument(const std::filesystem::path& scene) {
  const std::string stem = scene.stem().string();
  const std::string end = kNoInstrument;
  return stem.size() < end.size() || stem.compare(stem.size() - end.size(), end.size(), end) != 0;
}

}  // namespace

std::string leadingComment(const std::string& text) {
  std::istringstream lines(text);
  std::string comment;
  for (std::string line; std::getline(lines, line) && !line.empty() && line[0] == '#';) {
    const std::size_t from = line.find_first_not_of("# \t");
    const std::string words = from == std::string::npos ? "" : line.substr(from);
    if (!words.empty() && !isForMachines(words)) {
      comment +=
          (comment.empty() ? "" : " ") + words.substr(0, words.find_last_not_of(" \t\r") + 1);
    }
  }
  return comment;
}

std::vector<SceneEntry> scenesOf(const std::string& path, const std::string& text) {
  const std::string stem = std::filesystem::path(path).stem().string();
  std::vector<SceneEntry> scenes = {{path, stem, stem, leadingComment(text), pictureBeside(path)}};
  try {
    const YAML::Node scene = YAML::Load(text);
    const YAML::Node about = scene.IsMap() ? scene["about"] : YAML::Node();
    const bool tells = about && about.IsMap();
    const std::string title = tells ? word(about, "title") : "";
    SceneEntry& whole = scenes.front();
    whole.name = firstOf({word(scene, "name"), title, stem});
    whole.title = firstOf({title, whole.name});
    whole.about = firstOf({tells ? word(about, "description") : "", whole.about});
    whole.about += notesOf(path);
    addVariants(scene.IsMap() ? scene["variants"] : YAML::Node(), scenes);
  } catch (const YAML::Exception& /*no_yaml*/) {
    return scenes;
  }
  return scenes;
}

std::vector<SceneEntry> scenesIn(const std::vector<std::string>& folders) {
  std::vector<SceneEntry> scenes;
  for (const std::string& folder : folders) {
    std::error_code failure;
    for (const auto& file : std::filesystem::directory_iterator(folder, failure)) {
      if (file.path().extension() != ".yaml" || !isInstrument(file.path()) ||
          !file.is_regular_file(failure) || file.file_size(failure) > kLargest) {
        continue;
      }
      std::vector<SceneEntry> found = scenesOf(file.path().string(), readWhole(file.path()));
      std::move(found.begin(), found.end(), std::back_inserter(scenes));
    }
  }
  std::sort(scenes.begin(), scenes.end(),
            [](const auto& a, const auto& b) { return a.title < b.title; });
  return scenes;
}

}  // namespace ergotic::panel
