// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/variant_file.hpp"

#include <filesystem>
#include <sstream>
#include <vector>

#include "ergotic/exception.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "files/read_file.hpp"
#include "files/replace_file.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "scene/text/number.hpp"

namespace ergotic::node {
namespace {

const char kVariantsKey[] = "variants:";

bool saysNothing(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string::npos || line[first] == '#';
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// Line at which the first document of a scene ends: files that it has read may follow in another.
std::size_t endOfScene(const std::vector<std::string>& lines) {
  bool is_begun = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string mark = lines[i].substr(0, 3);
    if (is_begun && (mark == "---" || mark == "...")) {
      return i;
    }
    is_begun = is_begun || (!saysNothing(lines[i]) && lines[i].front() != '%' && mark != "---");
  }
  return lines.size();
}

/// The blanks before the first variant of a block that begins with this line.
std::string indentOf(const std::vector<std::string>& lines, std::size_t first) {
  for (std::size_t i = first; i < lines.size(); ++i) {
    if (!saysNothing(lines[i])) {
      const std::string indent = lines[i].substr(0, lines[i].find_first_not_of(' '));
      return indent.empty() ? "  " : indent;
    }
  }
  return "  ";
}

std::string variantLine(const std::string& name, const PresetValues& values) {
  std::string set;
  for (const auto& [parameter, value] : values) {
    set += (set.empty() ? "" : ", ") + parameter + ": " + scene::shortest(value);
  }
  return name + ": {set: {" + set + "}}";
}

/// Text with a variant, checked by reading it as others would: all values must be as wanted.
/// \throws Exception if they are not
std::string checkedVariant(const std::string& text,
                           const std::string& path,
                           const std::string& name,
                           const PresetValues& values) {
  std::string with = withVariant(text, path, name, values);
  const scene::Scene read = scene::readYaml(with, path, {}, {name});
  for (const scene::Parameter& parameter : read.parameters) {
    const auto wanted = values.find(parameter.name);
    if (wanted == values.end() || wanted->second != parameter.value) {
      throw Exception(path + ": " + scene::quoted(parameter.name) + " of variant " +
                      scene::quoted(name) + " would be " + scene::numberText(parameter.value) +
                      ", so it is not written");
    }
  }
  return with;
}

/// \return the text of the scene's file; empty if that is gone, or means something else than what
///         plays: another variant, or it was edited meanwhile
std::string textOfFile(const scene::Scene& scene) {
  try {
    std::string text = files::readFile(scene.file, scene::kMaxTextBytes);
    return scene::readYaml(text, scene.file).text == scene.text ? text : "";
  } catch (const Exception&) {
    return "";
  }
}

}  // namespace

std::string withVariant(const std::string& text,
                        const std::string& file,
                        const std::string& name,
                        const PresetValues& values) {
  std::vector<std::string> lines = linesOf(text);
  const std::size_t end = endOfScene(lines);
  std::size_t at = 0;
  while (at < end && lines[at].rfind(kVariantsKey, 0) != 0) {
    ++at;
  }
  const std::string line = variantLine(name, values);
  const auto place = [&lines](std::size_t index) {
    return lines.begin() + static_cast<std::ptrdiff_t>(index);
  };
  if (at == end) {
    lines.insert(place(end), {kVariantsKey, "  " + line});
  } else if (!saysNothing(lines[at].substr(sizeof kVariantsKey - 1))) {
    throw Exception(file + ":" + std::to_string(at + 1) +
                    ":1: error: 'variants' is in flow style, allowed: block style, each variant on "
                    "lines of its own below it");
  } else {
    lines.insert(place(at + 1), indentOf(lines, at + 1) + line);
  }
  std::string with;
  for (const std::string& each : lines) {
    with += each + "\n";
  }
  return with;
}

SavedVariant saveVariant(const std::string& folder,
                         const scene::Scene& scene,
                         const std::string& name,
                         const PresetValues& values) {
  namespace fs = std::filesystem;
  if (fs::path(scene.file).extension() == ".mdl") {
    throw Exception(
        scene.file +
        ": an .mdl file has no variants, allowed: scenes in YAML. Keep the values as a preset "
        "instead (KEEP)");
  }
  if (scene.parameters.empty()) {
    throw Exception(scene.file + ": the scene has no parameters that a variant could set");
  }
  SavedVariant saved;
  saved.path = folder + "/" + presetsOf(scene) + "/" + name + ".yaml";
  std::string with;
  if (const std::string text = textOfFile(scene); !text.empty()) {
    // What is wrong with `variants`, a player can put right.
    static_cast<void>(withVariant(text, scene.file, name, values));
    try {
      with = checkedVariant(text, saved.path, name, values);
    } catch (const Exception&) {
      with.clear();  // it names files that are not beside the copy
    }
  }
  saved.is_written_out = with.empty();
  if (saved.is_written_out) {
    with = checkedVariant(scene.text, saved.path, name, values);
  }
  files::replaceFile(folder, saved.path, with);
  return saved;
}

}  // namespace ergotic::node
