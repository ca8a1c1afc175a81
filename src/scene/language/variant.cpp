// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/variant.hpp"

#include <algorithm>

#include "ergotic/exception.hpp"
#include "scene/language/language_keys.hpp"
#include "scene/names.hpp"
#include "scene/text/glob.hpp"
#include "scene/tree/yaml_map.hpp"

namespace ergotic::scene {

void Variant::read(const Node& scene, const std::string& wanted) {
  if (const Node* const variants = scene.find("variants")) {
    forEachEntry(builder_, *variants, "'variants'", variants->place(),
                 [&](const std::string& name, Place place, const Node& node) {
                   checkName(builder_, name, place);
                   const YamlMap map(builder_, node, "variant " + quoted(name), place);
                   map.allow(variantKeys());
                   for (const char* const key : {"let", "set"}) {
                     if (map.has(key)) {
                       forEachEntry(builder_, map.at(key),
                                    quoted(key) + " of variant " + quoted(name), place,
                                    [](const std::string&, Place, const Node&) {});
                     }
                   }
                   if (name == wanted) {
                     let_ = node.find("let");
                     set_ = node.find("set");
                   }
                   known_.push_back(name);
                 });
  }
  if (!wanted.empty() && std::find(known_.begin(), known_.end(), wanted) == known_.end()) {
    throw Exception(builder_.scene().file + ": error: there is no variant " + quoted(wanted) +
                    (known_.empty() ? ", the scene has none" : suggestion(wanted, known_)));
  }
}

const Node& Variant::constant(const std::string& name, const Node& otherwise) {
  const Node* const given = let_ == nullptr ? nullptr : let_->find(name);
  if (given == nullptr) {
    return otherwise;
  }
  used_.insert(given);
  return *given;
}

std::vector<Variant::Setting> Variant::settingsOf(const std::string& name) {
  std::vector<Setting> settings;
  for (std::size_t i = 0; set_ != nullptr && i < set_->parts().size(); i += 2) {
    const std::string& path = (*set_)[i].text();
    const std::size_t dot = path.rfind('.');
    if (dot != std::string::npos && isMeantBy(name, std::string_view(path).substr(0, dot))) {
      settings.emplace_back(path.substr(dot + 1), &(*set_)[i + 1]);
      used_.insert(&(*set_)[i + 1]);
    }
  }
  return settings;
}

const Node* Variant::parameter(const std::string& name) {
  const Node* const given = set_ == nullptr ? nullptr : set_->find(name);
  if (given != nullptr) {
    used_.insert(given);
  }
  return given;
}

void Variant::expectUsed() const {
  for (const Node* const part : {let_, set_}) {
    for (std::size_t i = 0; part != nullptr && i < part->parts().size(); i += 2) {
      if (used_.count(&(*part)[i + 1]) == 0) {
        builder_.fail((*part)[i].place(),
                      part == let_
                          ? "the scene has no constant " + quoted((*part)[i].text())
                          : "nothing of the scene is meant by " + quoted((*part)[i].text()) +
                                ", allowed: NAME.key of what it has, or a parameter");
      }
    }
  }
}

}  // namespace ergotic::scene
