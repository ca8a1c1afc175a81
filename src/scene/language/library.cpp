// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/library.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "scene/language/language_keys.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "scene/text/source_text.hpp"
#include "scene/tree/near_file.hpp"
#include "scene/tree/yaml_documents.hpp"
#include "scene/tree/yaml_map.hpp"

namespace ergotic::scene {
namespace {

constexpr int kDeepestInclude = 16;

/// Marks a tree as a part of another text.
void setOrigin(Node& node, int origin) {
  node.setOrigin(origin);
  for (Node& part : node.parts()) {
    setOrigin(part, origin);
  }
}

}  // namespace

void Library::read(const Node& scene, Frame& frame) {
  if (const Node* const files = scene.find("include")) {
    include(*files, frame);
  }
  let(scene, frame);
  constants_ = frame.scope;
  if (const Node* const defaults = scene.find("defaults")) {
    forEachEntry(builder_, *defaults, "'defaults'", writer_.placeIn(*defaults, frame),
                 [&](const std::string& type, Place place, const Node& keys) {
                   if (!keys.isMap()) {
                     builder_.fail(place, "defaults of " + quoted(type) + " are " + kindOf(keys) +
                                              ", allowed: a map");
                   }
                   defaults_[type] = &keys;
                 });
  }
  if (const Node* const definitions = scene.find("define")) {
    forEachEntry(builder_, *definitions, "'define'", writer_.placeIn(*definitions, frame),
                 [&](const std::string& name, Place place, const Node& body) {
                   checkName(builder_, name, place);
                   if (!body.isMap()) {
                     builder_.fail(place, "definition " + quoted(name) + " is " + kindOf(body) +
                                              ", allowed: a map");
                   }
                   const YamlMap parts(builder_, body, "definition " + quoted(name), body.place());
                   parts.allow(definitionKeys());
                   by_name_[name].push_back(definitions_.size());
                   definitions_.push_back({name, &body, place.origin, definitions_.size()});
                 });
  }
}

void Library::include(const Node& files, Frame& frame) {
  if (!files.isList()) {
    writer_.fail(files, frame, "'include' is " + kindOf(files) + ", allowed: a list of files");
  }
  for (const Node& file : files) {
    readFile(file, frame);
  }
}

/// Reads a file to include, each once.
void Library::readFile(const Node& name, Frame& frame) {
  const Place place = writer_.placeIn(name, frame);
  const std::string path =
      pathOfIncluded(builder_, wordOf(builder_, name, "a file to include", place), place);
  std::error_code unknown;  // reading says what is wrong with it
  const std::string real = std::filesystem::weakly_canonical(path, unknown).string();
  if (std::count(included_.begin(), included_.end(), real) > 0) {
    return;
  }
  included_.push_back(real);
  if (++depth_ > kDeepestInclude) {
    builder_.fail(
        place, "files include one another more than " + std::to_string(kDeepestInclude) + " deep");
  }
  const std::string text = readNear(builder_, path, kMaxTextBytes, "", place);
  checkBytes(text, path, Bytes::kUtf8);
  const SceneBuilder its(path, text);
  std::vector<Node> documents = readDocuments(its, text, 1, "definitions need");
  if (documents.empty() || !documents.front().isMap()) {
    its.fail({1, 1}, "nothing is defined, allowed: a map of 'about', 'include', 'let', " +
                         std::string("'defaults' and 'define'"));
  }
  setOrigin(documents.front(), builder_.addOrigin({path, ""}));
  files_.push_back(std::move(documents.front()));
  const YamlMap top(builder_, files_.back(), path, files_.back().place());
  top.allow({"about", "include", "let", "defaults", "define"});
  read(files_.back(), frame);
  --depth_;
}

void Library::let(const Node& body, Frame& frame) {
  const Node* const constants = body.find("let");
  if (constants == nullptr) {
    return;
  }
  forEachEntry(builder_, *constants, "'let'", writer_.placeIn(*constants, frame),
               [&](const std::string& name, Place place, const Node& value) {
                 checkName(builder_, name, place);
                 const bool is_of_scene = frame.prefix.empty();
                 frame.scope.set(
                     name, writer_.constant(is_of_scene ? variant_.constant(name, value) : value,
                                            frame, frame.scope));
               });
}

const Definition& Library::definition(const Node& name,
                                      const std::string& word,
                                      const Frame& frame) const {
  // Of one name the last counts, as that of a scene does beside those it includes.
  const auto found = by_name_.find(word);
  if (found != by_name_.end()) {
    const std::vector<std::size_t>& all = found->second;
    const auto above = std::lower_bound(all.begin(), all.end(), frame.definitions);
    if (above != all.begin()) {
      return definitions_[*(above - 1)];
    }
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < frame.definitions; ++i) {
    names.push_back(definitions_[i].name);
  }
  writer_.fail(name, frame,
               "no definition above has the name " + quoted(word) + suggestion(word, names));
}

std::vector<const Node*> Library::defaultsOf(const std::string& type,
                                             const Node* kind,
                                             const std::string& word,
                                             const Frame& frame) const {
  std::vector<const Node*> sets;
  const auto add = [&](const std::string& key) {
    const auto found = defaults_.find(key);
    if (found != defaults_.end()) {
      sets.push_back(found->second);
    }
    return found != defaults_.end();
  };
  if (kind != nullptr && !add(type + "." + word)) {
    writer_.fail(*kind, frame, "there are no defaults of " + quoted(type + "." + word));
  }
  add(type);
  return sets;
}

}  // namespace ergotic::scene
