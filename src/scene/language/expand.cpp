// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/expand.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "scene/language/expander.hpp"

namespace ergotic::scene {
namespace {

constexpr const char* kOfTheLanguage[] = {"about", "include", "let", "defaults", "define", "use"};
constexpr const char* kOfElements[] = {"for", "when", "class"};

template <class List>
bool contains(const List& list, const std::string& word) {
  return std::find(std::begin(list), std::end(list), word) != std::end(list);
}

bool isOfTheLanguage(const Node& node) {
  if (node.isScalar()) {
    return (!node.text().empty() && node.text()[0] == '=') ||
           node.text().find('{') != std::string::npos;
  }
  for (std::size_t i = 0; i < node.parts().size(); ++i) {
    const bool is_key = node.isMap() && i % 2 == 0;
    if (is_key ? contains(kOfElements, node[i].text()) || isOfTheLanguage(node[i])
               : isOfTheLanguage(node[i])) {
      return true;
    }
  }
  return false;
}

}  // namespace

bool usesLanguage(const Node& scene) {
  for (std::size_t i = 0; scene.isMap() && i < scene.parts().size(); i += 2) {
    // What a title says is its own.
    if (contains(kOfTheLanguage, scene[i].text()) ||
        (scene[i].text() != "name" && isOfTheLanguage(scene[i + 1]))) {
      return true;
    }
  }
  return false;
}

Node expand(SceneBuilder& builder, const Node& scene) {
  return Expander(builder).run(scene);
}

}  // namespace ergotic::scene
