// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/expander.hpp"

#include <utility>

#include "scene/language/language_keys.hpp"
#include "scene/names.hpp"

namespace ergotic::scene {
namespace {

constexpr const char* kGenerators = "generators";
constexpr const char* kTruths = "truths";
constexpr const char* kParts[] = {"sections", "mats",   "generators", "lias",  "agents",
                                  "ports",    "inputs", "outputs",    "truths"};

std::string headOf(const std::string& name) {
  return name.substr(0, name.find('.'));
}

}  // namespace

Expander::Expander(SceneBuilder& builder)
    : builder_(builder),
      writer_(builder),
      variant_(builder),
      library_(builder, writer_, variant_) {}

Node Expander::run(const Node& scene, const std::string& variant) {
  variant_.read(scene, variant);
  builder_.scene().variants = variant_.known();
  library_.read(scene, frame_);
  frame_.definitions = library_.size();
  writeParts(scene, frame_);
  writeInstances(scene, frame_);
  Node result(Node::Kind::kMap, scene.place());
  for (std::size_t i = 0; i < scene.parts().size(); i += 2) {
    const std::string& key = scene[i].text();
    if (!contains(languageKeys(), key) && !contains(kParts, key)) {
      if (key == "name" || key == "about") {
        result.add(scene[i]);
        result.add(scene[i + 1]);
      } else {
        addKey(scene[i], scene[i + 1], frame_, frame_.scope, result);
      }
      if (key == "parameters") {
        setParameters(result.parts().back());
      }
    }
  }
  variant_.expectUsed();
  for (const char* const part : kParts) {
    const auto found = parts_.find(part);
    if (found != parts_.end()) {
      resolve(found->second, false);
      result.add(Node::scalar(part, found->second.place()));
      result.add(std::move(found->second));
    }
  }
  return result;
}

/// Applies the settings of a variant to the parameters.
void Expander::setParameters(Node& parameters) {
  for (std::size_t i = 0; parameters.isMap() && i < parameters.parts().size(); i += 2) {
    Node& parameter = parameters.parts()[i + 1];
    const Node* const given = variant_.parameter(parameters[i].text());
    for (std::size_t k = 0; given != nullptr && k < parameter.parts().size(); k += 2) {
      if (parameter[k].text() == "value") {
        parameter.parts()[k + 1] = writer_.write(*given, frame_, frame_.scope);
      }
    }
  }
}

void Expander::writeParts(const Node& body, const Frame& frame) {
  for (std::size_t i = 0; i < body.parts().size(); i += 2) {
    if (contains(kParts, body[i].text())) {
      writeElements(body[i].text(), body[i + 1], frame);
    }
  }
}

void Expander::writeElements(const std::string& part, const Node& elements, const Frame& frame) {
  const bool are_listed = part == kGenerators || part == kTruths;
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

/// Finds the heads of all names that a definition gives, so that words that refer to them are
/// known.
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

}  // namespace ergotic::scene
