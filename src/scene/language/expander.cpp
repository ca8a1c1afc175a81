// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/expander.hpp"

#include <algorithm>
#include <iterator>

#include "scene/names.hpp"

namespace ergotic::scene {
namespace {

constexpr const char* kGenerators = "generators";
constexpr const char* kParts[] = {"sections", "mats",  "generators", "lias",
                                  "agents",   "ports", "inputs",     "outputs"};
constexpr const char* kSpoken[] = {"about", "include", "let", "defaults", "define", "use"};

template <class List>
bool contains(const List& list, const std::string& word) {
  return std::find(std::begin(list), std::end(list), word) != std::end(list);
}

std::string headOf(const std::string& name) {
  return name.substr(0, name.find('.'));
}

Node scalar(std::string text, Place place) {
  return {Node::Kind::kScalar, place, std::move(text)};
}

}  // namespace

Expander::Expander(SceneBuilder& builder)
    : builder_(builder), writer_(builder), library_(builder, writer_) {}

Node Expander::run(const Node& scene) {
  Frame frame;
  library_.read(scene, frame);
  frame.definitions = library_.size();
  writeParts(scene, frame);
  writeInstances(scene, frame);
  Node result(Node::Kind::kMap, scene.place());
  for (std::size_t i = 0; i < scene.parts().size(); i += 2) {
    const std::string& key = scene[i].text();
    if (!contains(kSpoken, key) && !contains(kParts, key)) {
      result.add(scene[i]);
      result.add(key == "name" ? scene[i + 1] : writer_.write(scene[i + 1], frame, frame.scope));
    }
  }
  for (const char* const part : kParts) {
    const auto found = parts_.find(part);
    if (found != parts_.end()) {
      resolve(found->second, false);
      result.add(scalar(part, found->second.place()));
      result.add(std::move(found->second));
    }
  }
  return result;
}

void Expander::writeParts(const Node& body, const Frame& frame) {
  for (std::size_t i = 0; i < body.parts().size(); i += 2) {
    if (contains(kParts, body[i].text())) {
      writeElements(body[i].text(), body[i + 1], frame);
    }
  }
}

void Expander::writeElements(const std::string& part, const Node& elements, const Frame& frame) {
  const bool are_listed = part == kGenerators;
  const Node::Kind kind = are_listed ? Node::Kind::kList : Node::Kind::kMap;
  if (elements.isNull() && frame.prefix.empty()) {
    parts_.emplace(part, elements);  // its reader says what it thinks of that
    return;
  }
  if (elements.kind() != kind) {
    writer_.fail(elements, frame,
                 "'" + part + "' is no " + (are_listed ? "list" : "map of elements"));
  }
  parts_.emplace(part, Node(kind, writer_.placeIn(elements, frame)));
  const std::size_t step = are_listed ? 1 : 2;
  for (std::size_t i = 0; i < elements.parts().size(); i += step) {
    const Node& element = elements[i + step - 1];
    writer_.forEach(element, frame, frame.scope, [&](const Scope& scope) {
      writeElement(part, are_listed ? nullptr : &elements[i], element, frame, scope);
    });
  }
}

void Expander::writeElement(const std::string& part,
                            const Node* name,
                            const Node& element,
                            const Frame& frame,
                            const Scope& scope) {
  Node& to = parts_.at(part);
  if (name != nullptr) {
    to.add(scalar(frame.prefix + writer_.word(*name, frame, scope), writer_.placeIn(*name, frame)));
  }
  to.add(written(element, frame, scope));
}

/// Without what is for the language alone, and with its defaults.
Node Expander::written(const Node& element, const Frame& frame, const Scope& scope) {
  if (!element.isMap()) {
    return writer_.write(element, frame, scope);
  }
  Node result(Node::Kind::kMap, writer_.placeIn(element, frame));
  const auto add = [&](const Node& key, const Node& value) {
    const bool names_itself = key.text() == "name" && !frame.prefix.empty();
    result.add(writer_.write(key, frame, scope));
    Node given = writer_.write(value, frame, scope, Writer::isReference(key.text()));
    given = key.text() == "section" ? Writer::sectionOf(std::move(given), frame) : given;
    const bool is_own = names_itself || (key.text() == "tank" && !frame.prefix.empty());
    result.add(is_own && given.isScalar() ? scalar(frame.prefix + given.text(), given.place())
                                          : std::move(given));
  };
  for (std::size_t i = 0; i < element.parts().size(); i += 2) {
    const std::string& key = element[i].text();
    if (key != "for" && key != "when" && key != "class") {
      add(element[i], element[i + 1]);
    }
  }
  const Node* const type = element.find("type");
  if (type == nullptr) {
    return result;
  }
  for (const Node* const defaults :
       library_.defaultsOf(type->text(), element.find("class"), frame)) {
    for (std::size_t i = 0; i < defaults->parts().size(); i += 2) {
      if (result.find((*defaults)[i].text()) == nullptr) {
        add((*defaults)[i], (*defaults)[i + 1]);
      }
    }
  }
  return result;
}

/// What the names begin with that a definition gives, so that words that mean these are known.
void Expander::findHeads(const Node& body, Frame& frame) {
  const auto add = [&](const Node& element, const Node* name) {
    if (name != nullptr) {
      writer_.forEach(element, frame, frame.scope, [&](const Scope& scope) {
        frame.heads.insert(headOf(writer_.word(*name, frame, scope)));
      });
    }
  };
  for (std::size_t i = 0; i < body.parts().size(); i += 2) {
    const Node& elements = body[i + 1];
    if (body[i].text() == kGenerators || body[i].text() == "use") {
      for (const Node& element : elements) {
        add(element, element.find(body[i].text() == "use" ? "as" : "name"));
      }
    } else if (contains(kParts, body[i].text())) {
      for (std::size_t k = 0; elements.isMap() && k < elements.parts().size(); k += 2) {
        add(elements[k + 1], &elements[k]);
      }
    }
  }
}

/// Public names of instances become what they stand for.
void Expander::resolve(Node& node, bool is_reference) const {
  if (node.isScalar() && is_reference) {
    const std::size_t end = std::min(node.text().find_first_of("@/"), node.text().size());
    auto found = public_.find(node.text().substr(0, end));
    if (found != public_.end()) {
      node = scalar(found->second + node.text().substr(end), node.place());
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

}  // namespace ergotic::scene
