// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/selections.hpp"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "scene/generate/points.hpp"
#include "scene/limits.hpp"
#include "scene/rules/rules.hpp"
#include "scene/text/glob.hpp"
#include "scene/text/number.hpp"
#include "scene/tree/yaml_map.hpp"
#include "scene/yaml/grid_selections.hpp"
#include "scene/yaml/points.hpp"

namespace ergotic::scene {
namespace {

constexpr const char* kMean = "mean(";

bool isMean(const std::string& text) {
  return text.compare(0, 5, kMean) == 0;
}

/// Length of the name before a place on a grid, or before a selection on it.
std::size_t endOfName(const std::string& text) {
  return std::min(text.find_first_of("@/"), text.size());
}

std::string withoutBlanks(std::string text) {
  text.erase(std::remove(text.begin(), text.end(), ' '), text.end());
  return text;
}

template <class List>
std::vector<std::string> namesMeantBy(const List& list, const std::string& pattern) {
  std::vector<std::string> names;
  for (const auto& item : list) {
    std::string name = item.name;
    if (isMeantBy(name, pattern)) {
      names.push_back(std::move(name));
    }
  }
  std::sort(names.begin(), names.end(),
            [](const std::string& a, const std::string& b) { return isBefore(a, b); });
  return names;
}

/// Modules that one text without `*` selects.
Selection selectionIn(SceneBuilder& builder, const std::string& text, Place place) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos || isMean(text)) {
    return {{pointAt(builder, text, place)}, false};
  }
  const Grid& grid =
      builder.scene().grids[static_cast<std::size_t>(builder.grid(text.substr(0, slash), place))];
  const GridWords words = gridWordsOf(builder, text.substr(slash + 1), place);
  builder.expectToLookAt(
      static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.columns), place);
  Selection selection{selectedOn(builder, grid, words, text, place), !isOne(words)};
  builder.addSelected(text, selection.mats.size(), place);
  return selection;
}

/// Modules that a name with `*` selects, in the order of their names.
Selection selectionByPattern(SceneBuilder& builder, const std::string& text, Place place) {
  const std::size_t end = endOfName(text);
  const std::string pattern = text.substr(0, end);
  const Scene& scene = builder.scene();
  const bool on_grids = end < text.size();
  builder.expectToLookAt(on_grids ? scene.grids.size() : scene.mats.size(), place);
  Selection selection{{}, true};
  for (const std::string& name :
       on_grids ? namesMeantBy(scene.grids, pattern) : namesMeantBy(scene.mats, pattern)) {
    const Selection one = selectionIn(builder, name + text.substr(end), place);
    selection.mats.insert(selection.mats.end(), one.mats.begin(), one.mats.end());
  }
  if (!selection.mats.empty()) {
    builder.addSelected(text, selection.mats.size(), place);
  }
  return selection;
}

Selection selectionOfWord(SceneBuilder& builder, const std::string& text, Place place) {
  const bool is_pattern = !isMean(text) && isPattern(text.substr(0, endOfName(text)));
  return is_pattern ? selectionByPattern(builder, text, place) : selectionIn(builder, text, place);
}

Selection selectionOfList(SceneBuilder& builder,
                          const Node& list,
                          const std::string& what,
                          Place fallback) {
  Selection selection{{}, true};
  std::unordered_set<int> seen;
  for (const Node& item : list) {
    const Place place = placeOf(item, fallback);
    for (const int mat : selectionOfWord(builder, wordOf(builder, item, what, place), place).mats) {
      if (seen.insert(mat).second) {
        selection.mats.push_back(mat);
      }
    }
  }
  return selection;
}

}  // namespace

bool isSelection(const std::string& text) {
  return isMean(text) || text.find('/') != std::string::npos ||
         isPattern(text.substr(0, endOfName(text)));
}

Selection selectionOf(SceneBuilder& builder,
                      const Node& node,
                      const std::string& what,
                      Place fallback) {
  const Place place = placeOf(node, fallback);
  Selection selection = node.isList()
                            ? selectionOfList(builder, node, what, place)
                            : selectionOfWord(builder, wordOf(builder, node, what, place), place);
  if (selection.mats.empty()) {
    builder.fail(place, node.isList() ? what + " is a list that means no module"
                                      : "no module is meant by " + quoted(node.text()));
  }
  return selection;
}

int selectedModule(SceneBuilder& builder, const std::string& text, Place place) {
  if (!isMean(text)) {
    const Selection selection = selectionOfWord(builder, text, place);
    if (selection.is_set) {
      builder.fail(place, quoted(text) + " may be many modules, allowed here: one, or mean(" +
                              withoutBlanks(text) + ")");
    }
    return selection.mats.front();
  }
  const std::string name = withoutBlanks(text);
  const int known = builder.findMat(name);
  if (known >= 0) {
    return known;
  }
  if (name.back() != ')' || isMean(name.substr(5))) {
    builder.fail(place, quoted(text) + " is no mean, allowed: mean(plate/rim) and the like");
  }
  const std::string inside = name.substr(5, name.size() - 6);
  const Selection selection = selectionOf(builder, Node(Node::Kind::kScalar, place, inside),
                                          "what " + quoted(text) + " is of", place);
  Tap tap;
  tap.place = place;
  const Scene& scene = builder.scene();
  const int section = scene.mats[static_cast<std::size_t>(selection.mats.front())].section;
  for (const int mat : selection.mats) {
    if (const std::string reason = reasonAgainstTap(scene, section, mat); !reason.empty()) {
      builder.fail(place, quoted(text) + " " + reason);
    }
    tap.shares.push_back({mat, 1.0 / static_cast<double>(selection.mats.size())});
  }
  addTap(builder, name, std::move(tap));
  return builder.findMat(name);
}

}  // namespace ergotic::scene
