// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/explain.hpp"

#include <optional>
#include <sstream>
#include <vector>

#include "ergotic/exception.hpp"
#include "ergotic/scene/origin.hpp"
#include "scene/names.hpp"

namespace ergotic::tools {
namespace {

using scene::Place;
using scene::Scene;

/// Visits every part of a scene that has a name.
template <class Visit>
void visit(const Scene& scene, Visit visitor) {
  const auto all = [&](const auto& parts) {
    for (const auto& part : parts) {
      visitor(std::string(part.name), part.place);
    }
  };
  all(scene.sections);
  all(scene.mats);
  all(scene.grids);
  all(scene.lias);
  all(scene.parameters);
  all(scene.ports);
  all(scene.inputs);
  all(scene.outputs);
}

std::optional<Place> placeOf(const Scene& scene, const std::string& name) {
  std::optional<Place> found;
  visit(scene, [&](const std::string& other, Place place) {
    found = !found && other == name ? place : found;
  });
  return found;
}

std::size_t indentOf(const std::string& line) {
  return line.find_first_not_of(' ');
}

/// Whether a line is the key of that name, or of a generator that has it.
bool tellsOf(const std::string& line, const std::string& name) {
  const std::size_t begin = indentOf(line);
  for (const std::string& key : {name + ":", '"' + name + "\":", '\'' + name + "':"}) {
    if (begin != std::string::npos && line.compare(begin, key.size(), key) == 0) {
      return true;
    }
  }
  const std::string says = "name: " + name;
  const std::size_t at = line.find(says);
  return at != std::string::npos &&
         (at + says.size() == line.size() ||
          line.find_first_of(",} ", at + says.size()) == at + says.size());
}

/// Lines of the plain text that describe the named element; empty if there are none.
std::string linesOf(const Scene& scene, const std::string& name) {
  std::istringstream text(scene.text);
  std::string lines;
  std::string line;
  std::size_t indent = std::string::npos;  // of the line that names it
  while (std::getline(text, line)) {
    const bool goes_on = indent != std::string::npos && indentOf(line) > indent;
    if (!lines.empty() && !goes_on) {
      break;
    }
    if (goes_on || tellsOf(line, name)) {
      indent = lines.empty() ? indentOf(line) : indent;
      lines += line + '\n';
    }
  }
  return lines;
}

}  // namespace

std::string explain(const Scene& scene, const std::string& name) {
  const std::optional<Place> place = placeOf(scene, name);
  if (!place) {
    std::vector<std::string> known;
    visit(scene, [&](const std::string& other, Place) { known.push_back(other); });
    throw Exception(scene.file + ": nothing is called " + scene::quoted(name) +
                    scene::suggestion(name, known));
  }
  std::string lines;
  for (std::string part = name; lines.empty() && !part.empty();
       part.resize(part.find('.') == std::string::npos ? 0 : part.rfind('.'))) {
    lines = linesOf(scene, part);
  }
  return scene::textOf(scene, *place) + ": " + name + scene::chainOf(scene, *place) + '\n' + lines;
}

}  // namespace ergotic::tools
