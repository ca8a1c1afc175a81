// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/expand.hpp"

#include <utility>

#include "scene/language/expander.hpp"
#include "scene/language/language_keys.hpp"

namespace ergotic::scene {
namespace {

constexpr const char* kOfReaders[] = {"name", "about"};  // their words are their own

bool isFileOfSpeakers(const Node& key, const Node& value) {
  return key.text() == "speakers" && value.isMap();
}

bool isOfTheLanguage(const Node& node) {
  if (node.isScalar()) {
    return (!node.text().empty() && node.text()[0] == '=') ||
           node.text().find('{') != std::string::npos;
  }
  for (std::size_t i = 0; i < node.parts().size(); ++i) {
    const bool is_key = node.isMap() && i % 2 == 0;
    if (is_key && isFileOfSpeakers(node[i], node[i + 1])) {
      return true;
    }
    if (is_key ? contains(elementKeys(), node[i].text()) || isOfTheLanguage(node[i])
               : isOfTheLanguage(node[i])) {
      return true;
    }
  }
  return false;
}

}  // namespace

bool usesLanguage(const Node& scene) {
  for (std::size_t i = 0; scene.isMap() && i < scene.parts().size(); i += 2) {
    if (contains(languageKeys(), scene[i].text()) || isFileOfSpeakers(scene[i], scene[i + 1]) ||
        (!contains(kOfReaders, scene[i].text()) && isOfTheLanguage(scene[i + 1]))) {
      return true;
    }
  }
  return false;
}

Node expand(SceneBuilder& builder, const Node& scene, const std::string& variant) {
  return Expander(builder).run(scene, variant);
}

}  // namespace ergotic::scene
