// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/preset_file.hpp"

#include <algorithm>
#include <filesystem>

#include "ergotic/exception.hpp"
#include "files/read_file.hpp"
#include "files/replace_file.hpp"
#include "ros/device/hands.hpp"
#include "ros/interface/file_name.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "scene/text/number.hpp"
#include "tgr/settings.hpp"

namespace ergotic::node {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPresetBytes = std::size_t{4} << 20U;
constexpr scene::Limits kAnyValue{};

/// A scene that came as a text has the name of a file, but none.
bool isFile(const scene::Scene& scene) {
  std::error_code error;
  return fs::is_regular_file(scene.file, error);
}

}  // namespace

std::string presetFolder() {
  return homeFolder() + "/presets";
}

std::string presetsOf(const scene::Scene& scene) {
  const std::string name = isFile(scene) ? fs::path(scene.file).stem().string() : scene.name;
  const std::string allowed = toFileName(name);
  return allowed.empty() || allowed.front() == '.' ? "_" + allowed : allowed;
}

std::map<std::string, PresetValues> PresetFile::read() const {
  std::error_code error;
  if (!fs::exists(path_, error) && !error) {
    return {};
  }
  const tgr::Settings file(tgr::parseSettings(files::readFile(path_, kMaxPresetBytes), path_),
                           path_, "the presets");
  std::map<std::string, PresetValues> presets;
  for (const auto& entry : file.node()) {
    const auto name = entry.first.as<std::string>();
    const scene::YamlMap preset = file.top().map(name);
    PresetValues& values = presets[name];
    for (const auto& value : entry.second) {
      const auto parameter = value.first.as<std::string>();
      values[parameter] = preset.number(parameter, kAnyValue);
    }
  }
  return presets;
}

PresetValues PresetFile::at(const std::string& name) const {
  const auto presets = read();
  const auto found = presets.find(name);
  if (found == presets.end()) {
    std::vector<std::string> known;
    for (const auto& [other, unused] : presets) {
      known.push_back(other);
    }
    throw Exception(path_ + ": there is no preset " + scene::quoted(name) +
                    (known.empty() ? ", and no other" : scene::suggestion(name, known)));
  }
  return found->second;
}

void PresetFile::keep(const std::string& name, const PresetValues& values) const {
  auto presets = read();
  presets[name] = values;
  if (presets.size() > kMaxPresets) {
    throw Exception(path_ + " has " + std::to_string(kMaxPresets) +
                    " presets already, allowed: no more. Forget one of them first");
  }
  write(presets);
}

void PresetFile::forget(const std::string& name) const {
  static_cast<void>(at(name));
  auto presets = read();
  presets.erase(name);
  write(presets);
}

/// Writes the file with all names in quotes, as YAML would take some of them for other types.
void PresetFile::write(const std::map<std::string, PresetValues>& presets) const {
  std::string text = "# Presets of the station: name, parameter, value in SI units.\n";
  for (const auto& [name, values] : presets) {
    text += "'" + name + "':" + (values.empty() ? " {}\n" : "\n");
    for (const auto& [parameter, value] : values) {
      text += "  '" + parameter + "': " + scene::shortest(value) + "\n";
    }
  }
  files::replaceFile(folder_, path_, text);
}

FittingValues fittingValues(const PresetValues& preset,
                            const std::vector<scene::Parameter>& parameters) {
  FittingValues fitting;
  const auto leave_out = [&fitting](const std::string& what) {
    fitting.left_out += (fitting.left_out.empty() ? "" : "; ") + what;
  };
  for (const auto& [name, value] : preset) {
    const auto found =
        std::find_if(parameters.begin(), parameters.end(),
                     [wanted = name](const auto& parameter) { return parameter.name == wanted; });
    if (found == parameters.end()) {
      leave_out("the scene has no parameter " + scene::quoted(name));
    } else if (!(value >= found->minimum && value <= found->maximum)) {
      const std::string unit = found->unit.empty() ? "" : " " + found->unit;
      leave_out(scene::quoted(name) + " is " + scene::numberText(value) + unit +
                ", allowed: " + scene::numberText(found->minimum) + "..." +
                scene::numberText(found->maximum) + unit);
    } else {
      fitting.values[name] = value;
    }
  }
  return fitting;
}

}  // namespace ergotic::node
