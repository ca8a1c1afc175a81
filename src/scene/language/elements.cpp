// SPDX-License-Identifier: BSD-3-Clause
// Elements: their keys, those by default, those that a variant has otherwise, their places.
#include <algorithm>
#include <unordered_set>

#include "scene/language/expander.hpp"
#include "scene/language/speaker_file.hpp"
#include "scene/names.hpp"
#include "scene/text/glob.hpp"

namespace ergotic::scene {
namespace {

constexpr std::size_t kFew = 16;  // keys that are looked through

/// The keys of a map, however many.
class Keys {
 public:
  explicit Keys(const Node& map) : map_(map) {
    for (std::size_t i = 0; map.size() > kFew && i < map.parts().size(); i += 2) {
      all_.insert(map[i].text());
    }
  }
  bool has(const std::string& key) const {
    return map_.size() > kFew ? all_.count(key) > 0 : map_.find(key) != nullptr;
  }

 private:
  const Node& map_;
  std::unordered_set<std::string> all_;
};

}  // namespace

void Expander::writeElement(const std::string& part,
                            const Node* name,
                            const Node& element,
                            const Frame& frame,
                            const Scope& scope) {
  Node& to = parts_.at(part);
  std::string own;
  if (name != nullptr) {
    own = frame.prefix + writer_.word(*name, frame, scope);
    to.add(Node::scalar(own, writer_.placeIn(*name, frame)));
  }
  Node result = written(element, frame, scope);
  const Node* const said = name == nullptr ? result.find("name") : nullptr;
  set(said != nullptr ? said->text() : own, result);
  if (frame.pose.is_moved && (part == "mats" || part == "generators")) {
    moveTo(builder_, frame.pose, part, geometryOf(result), result);
  }
  to.add(std::move(result));
}

/// Applies the settings of a variant to an element.
void Expander::set(const std::string& name, Node& element) {
  for (const auto& [key, value] : variant_.settingsOf(name)) {
    Node given = writer_.write(*value, frame_, frame_.scope, Writer::isReference(key));
    bool is_there = false;
    for (std::size_t i = 0; element.isMap() && i < element.parts().size(); i += 2) {
      if (element[i].text() == key) {
        element.parts()[i + 1] = given;
        is_there = true;
      }
    }
    if (!is_there && element.isMap()) {
      element.add(Node::scalar(key, value->place()));
      element.add(std::move(given));
    }
  }
}

std::string Expander::geometryOf(const Node& element) const {
  const auto sections = parts_.find("sections");
  const Node* const name = element.find("section");
  const Node* section = nullptr;
  if (sections != parts_.end() && sections->second.isMap()) {
    const Node& all = sections->second;
    section = name != nullptr ? all.find(name->text()) : all.size() > 0 ? &all[1] : nullptr;
  }
  const Node* const geometry = section == nullptr ? nullptr : section->find("geometry");
  return geometry == nullptr ? "scalar" : geometry->text();
}

void Expander::addKey(
    const Node& key, const Node& value, const Frame& frame, const Scope& scope, Node& to) {
  const std::string& word = key.text();
  to.add(writer_.write(key, frame, scope));
  const bool is_file = word == "speakers" && value.isMap();
  Node given = is_file ? speakersIn(builder_, value, writer_.placeIn(value, frame))
                       : writer_.write(value, frame, scope, Writer::isReference(word));
  given = word == "section" ? Writer::sectionOf(std::move(given), frame) : given;
  const bool is_own = !frame.prefix.empty() && (word == "name" || word == "tank");
  to.add(is_own && given.isScalar() ? Node::scalar(frame.prefix + given.text(), given.place())
                                    : std::move(given));
}

/// Writes an element without the keys of the language alone, and with its defaults.
Node Expander::written(const Node& element, const Frame& frame, const Scope& scope) {
  if (!element.isMap()) {
    return writer_.write(element, frame, scope);
  }
  Node result(Node::Kind::kMap, writer_.placeIn(element, frame));
  for (std::size_t i = 0; i < element.parts().size(); i += 2) {
    const std::string& key = element[i].text();
    if (key != "for" && key != "when" && key != "class") {
      addKey(element[i], element[i + 1], frame, scope, result);
    }
  }
  addDefaults(element, frame, scope, result);
  return result;
}

void Expander::addDefaults(const Node& element, const Frame& frame, const Scope& scope, Node& to) {
  const Node* const type = to.find("type");
  if (type == nullptr) {
    return;
  }
  const std::string word = type->text();
  const Node* const kind = element.find("class");
  const std::string set = kind == nullptr ? "" : writer_.word(*kind, frame, scope);
  for (const Node* const defaults : library_.defaultsOf(word, kind, set, frame)) {
    const Keys keys(to);
    Node more(Node::Kind::kMap, to.place());
    for (std::size_t i = 0; i < defaults->parts().size(); i += 2) {
      if (!keys.has((*defaults)[i].text())) {
        addKey((*defaults)[i], (*defaults)[i + 1], frame, scope, more);
      }
    }
    for (Node& part : more.parts()) {
      to.add(std::move(part));
    }
  }
}

/// Public names of instances become what they stand for.
void Expander::resolve(Node& node, bool is_reference) {
  if (node.isScalar() && is_reference) {
    const std::size_t end = std::min(node.text().find_first_of("@/"), node.text().size());
    if (isPattern(std::string_view(node.text()).substr(0, end))) {
      resolvePattern(node);
      return;
    }
    const auto found = public_.find(node.text().substr(0, end));
    if (found != public_.end()) {
      node = Node::scalar(found->second + node.text().substr(end), node.place());
    }
    return;
  }
  for (std::size_t i = 0; i < node.parts().size(); ++i) {
    const bool is_key = node.isMap() && i % 2 == 0;
    const bool names =
        node.isMap() && !is_key ? Writer::isReference(node[i - 1].text()) : is_reference;
    resolve(node.parts()[i], !is_key && names);
  }
}

/// A name with `*`: all public names that it means, and after them what else it means, which is
/// known when all modules are made.
void Expander::resolvePattern(Node& node) {
  const std::size_t end = std::min(node.text().find_first_of("@/"), node.text().size());
  const std::string pattern = node.text().substr(0, end);
  const std::string rest = node.text().substr(end);
  writer_.countText(public_.size() * sizeof(void*), node, frame_);  // all are looked at
  std::vector<const std::pair<const std::string, std::string>*> meant;
  for (const auto& entry : public_) {
    if (isMeantBy(entry.first, pattern)) {
      meant.push_back(&entry);
    }
  }
  if (meant.empty()) {
    return;
  }
  std::sort(meant.begin(), meant.end(),
            [](const auto* a, const auto* b) { return isBefore(a->first, b->first); });
  Node list(Node::Kind::kList, node.place());
  for (const auto* const entry : meant) {
    list.add(Node::scalar(entry->second + rest, node.place()));
  }
  list.add(Node::scalar(node.text(), node.place()));
  writer_.countAll(list, node, frame_);
  node = std::move(list);
}

}  // namespace ergotic::scene
