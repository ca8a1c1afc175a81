// SPDX-License-Identifier: BSD-3-Clause
// Instances of definitions: their names, parameters and sections.
#include <algorithm>
#include <optional>

#include "ergotic/scene/origin.hpp"
#include "scene/language/expander.hpp"
#include "scene/language/expression.hpp"
#include "scene/language/language_keys.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "scene/text/quantity.hpp"
#include "scene/tree/yaml_map.hpp"

namespace ergotic::scene {
namespace {

constexpr int kDeepestInstance = 16;
constexpr std::size_t kNodesOfInstance = 8;  // that take as long

/// Limits of the number of a parameter, as in `[30, 5000]`, `[1 mm, 1 m]`.
Limits limitsOf(const SceneBuilder& builder, const YamlMap& spec, const std::string& unit) {
  Limits limits{unit.c_str()};
  if (spec.has("range")) {
    const Node& range = spec.at("range");
    if (!range.isList() || range.size() != 2) {
      spec.fail("range", "'range' of " + spec.what() + " is " + kindOf(range) +
                             ", allowed: [lowest, highest]");
    }
    limits.minimum = numberOf(builder, range[0], "'range' of " + spec.what(), {unit.c_str()},
                              spec.placeAt("range"));
    limits.maximum = numberOf(builder, range[1], "'range' of " + spec.what(), {unit.c_str()},
                              spec.placeAt("range"));
  }
  return limits;
}

}  // namespace

void Expander::writeInstances(const Node& body, const Frame& frame) {
  const Node* const uses = body.find("use");
  if (uses == nullptr) {
    return;
  }
  if (!uses->isList()) {
    writer_.fail(*uses, frame, "'use' is " + kindOf(*uses) + ", allowed: a list of maps {is, as}");
  }
  for (const Node& use : *uses) {
    writer_.forEach(use, frame, frame.scope,
                    [&](const Scope& scope) { writeInstance(use, frame, scope); });
  }
}

void Expander::writeInstance(const Node& use, const Frame& frame, const Scope& scope) {
  const YamlMap map(builder_, use, "an instance", writer_.placeIn(use, frame));
  map.allow(instanceKeys());
  const std::string is = writer_.word(map.at("is"), frame, scope);
  const std::string as = writer_.word(map.at("as"), frame, scope);
  const Definition& definition = library_.definition(map.at("is"), is, frame);
  if (frame.depth == kDeepestInstance) {
    writer_.fail(
        use, frame,
        "definitions use one another more than " + std::to_string(kDeepestInstance) + " deep");
  }
  writer_.count(use, frame, kNodesOfInstance);
  Frame inner;
  inner.scope = Scope(&library_.constants());
  inner.prefix = frame.prefix + as + ".";
  const Place named = writer_.placeIn(map.at("as"), frame);
  checkName(builder_, frame.prefix + as, named);
  if (as.back() == '.' || !prefixes_.insert(inner.prefix).second) {
    builder_.fail(
        named, "instance " + quoted(frame.prefix + as) +
                   (as.back() == '.' ? " ends with a dot, allowed: a name" : " is there already"));
  }
  inner.definitions = definition.above;
  inner.depth = frame.depth + 1;
  inner.pose = frame.pose * poseOf(use, frame, scope);
  const Place used = writer_.placeIn(use, frame);
  inner.text = definition.origin;
  inner.origin =
      builder_.addOrigin({fileOf(builder_.scene(), {0, 0, definition.origin}),
                          "\n  in " + frame.prefix + as + " (" + is + "), used at " +
                              textOf(builder_.scene(), used) + chainOf(builder_.scene(), used)});
  setParameters(definition, use, frame, scope, frame.prefix + as, inner);
  setSections(definition, use, frame, scope, inner);
  library_.let(*definition.body, inner);
  findHeads(*definition.body, inner);
  writeParts(*definition.body, inner);
  writeInstances(*definition.body, inner);
  publish(definition, inner);
}

Pose Expander::poseOf(const Node& use, const Frame& frame, const Scope& scope) {
  std::optional<Node> parts[2];
  const char* const keys[] = {"at", "rotate"};
  for (std::size_t i = 0; i < 2; ++i) {
    if (const Node* const said = use.find(keys[i])) {
      parts[i] = writer_.write(*said, frame, scope);
    }
  }
  return scene::poseOf(builder_, parts[0] ? &*parts[0] : nullptr, parts[1] ? &*parts[1] : nullptr);
}

void Expander::setParameters(const Definition& definition,
                             const Node& use,
                             const Frame& outer,
                             const Scope& scope,
                             const std::string& instance,
                             Frame& inner) {
  const Node* const params = definition.body->find("params");
  Given given;  // by name
  if (const Node* const with = use.find("with")) {
    forEachEntry(builder_, *with, "'with'", writer_.placeIn(*with, outer),
                 [&](const std::string& name, Place place, const Node& value) {
                   given[name] = {Writer::placeIn(place, outer), &value, &outer, &scope};
                 });
  }
  for (const auto& [name, value] : variant_.settingsOf(instance)) {
    given[name] = {value->place(), value, &frame_, &frame_.scope};
  }
  if (params != nullptr) {
    forEachEntry(
        builder_, *params, "'params' of " + quoted(definition.name), params->place(),
        [&](const std::string& name, Place, const Node& spec) {
          const auto found = given.find(name);
          if (found == given.end() && spec.find("default") == nullptr) {
            writer_.fail(
                use, outer,
                quoted(name) + " of " + quoted(definition.name) + " is missing under 'with'");
          }
          const bool is_given = found != given.end();
          inner.scope.set(name, parameter(name, spec, is_given ? found->second.value : nullptr,
                                          is_given ? *found->second.frame : outer,
                                          is_given ? *found->second.scope : inner.scope));
          if (is_given) {
            given.erase(found);
          }
        });
  }
  if (!given.empty()) {
    refuseParameter(definition, given);
  }
}

/// The first in the text that the definition does not have.
void Expander::refuseParameter(const Definition& definition, const Given& given) const {
  const auto first = std::min_element(
      given.begin(), given.end(), [](const Given::value_type& a, const Given::value_type& b) {
        const auto order = [](Place place) { return std::pair(place.line, place.column); };
        return order(a.second.place) < order(b.second.place);
      });
  std::vector<std::string> names;
  const Node* const params = definition.body->find("params");
  for (std::size_t i = 0; params != nullptr && i < params->parts().size(); i += 2) {
    names.push_back((*params)[i].text());
  }
  builder_.fail(first->second.place, quoted(definition.name) + " has no parameter " +
                                         quoted(first->first) + suggestion(first->first, names));
}

/// `{default, range, unit, kind, doc}`: a number with a unit or a range, a `place`, or anything.
Constant Expander::parameter(const std::string& name,
                             const Node& spec,
                             const Node* given,
                             const Frame& outer,
                             const Scope& scope) {
  const YamlMap map(builder_, spec, "parameter " + quoted(name), spec.place());
  map.allow(parameterSpecKeys());
  const std::string unit = map.has("unit") ? map.word("unit") : "";
  const bool is_place = map.has("kind") && map.choice("kind", {"place"}) == 0;
  const Node& node = given != nullptr ? *given : map.at("default");
  Frame own;
  const Frame& frame = given != nullptr ? outer : own;
  if (map.has("unit") && !isSiUnit(unit)) {
    map.fail("unit", "'unit' of " + map.what() + " is " + quoted(unit) +
                         ", allowed: an SI unit such as m, N/m, Hz");
  }
  if (is_place) {
    const Node written = writer_.write(node, frame, scope, true);
    if (!written.isScalar()) {
      builder_.fail(written.place(),
                    quoted(name) + " is " + kindOf(written) + ", allowed: the name of a place");
    }
    return written.text();
  }
  const Node value = writer_.write(node, frame, scope);
  const bool is_number = map.has("unit") || map.has("range");
  if (!is_number || !value.isScalar() || value.text().find('$') != std::string::npos) {
    return constantOf(value);
  }
  return Amount{
      numberOf(builder_, value, quoted(name), limitsOf(builder_, map, unit), value.place()),
      kindOfUnit(unit)};
}

void Expander::setSections(const Definition& definition,
                           const Node& use,
                           const Frame& outer,
                           const Scope& scope,
                           Frame& inner) {
  const Node* const needs = definition.body->find("needs");
  const Node* const in = use.find("in");
  if (in != nullptr) {
    forEachEntry(builder_, *in, "'in'", writer_.placeIn(*in, outer),
                 [&](const std::string& role, Place, const Node& given) {
                   if (needs == nullptr || needs->find(role) == nullptr) {
                     writer_.fail(given, outer,
                                  quoted(definition.name) + " needs no section " + quoted(role));
                   }
                 });
  }
  if (needs == nullptr) {
    return;
  }
  forEachEntry(builder_, *needs, "'needs' of " + quoted(definition.name), needs->place(),
               [&](const std::string& role, Place place, const Node& rate) {
                 if (!rate.isScalar() || (rate.text() != "audio" && rate.text() != "gestural")) {
                   builder_.fail(place, "section " + quoted(role) + " of " +
                                            quoted(definition.name) +
                                            " is meant for no rate, allowed: audio, gestural");
                 }
                 const Node* const given = in == nullptr ? nullptr : in->find(role);
                 if (given == nullptr) {
                   writer_.fail(use, outer,
                                "section " + quoted(role) + " of " + quoted(definition.name) +
                                    " is missing under 'in'");
                 }
                 const std::string section = writer_.word(*given, outer, scope);
                 const auto mapped = outer.sections.find(section);
                 inner.sections[role] = mapped == outer.sections.end() ? section : mapped->second;
               });
}

void Expander::publish(const Definition& definition, const Frame& frame) {
  const Node* const gives = definition.body->find("gives");
  if (gives == nullptr) {
    return;
  }
  forEachEntry(builder_, *gives, "'gives' of " + quoted(definition.name), gives->place(),
               [&](const std::string& name, Place, const Node& what) {
                 const std::string word = writer_.word(what, frame, frame.scope);
                 std::string means = Writer::renamed(word, frame);
                 const auto isOwn = [&](const std::string& one) {
                   return frame.heads.count(one.substr(0, one.find_first_of(".@/"))) > 0;
                 };
                 if (!isOwn(word)) {
                   writer_.fail(what, frame,
                                quoted(definition.name) + " has no " + quoted(word) + " to give");
                 }
                 if (word != name && isOwn(name)) {
                   writer_.fail(what, frame,
                                quoted(name) + " of 'gives' is a part of " +
                                    quoted(definition.name) + " itself, allowed: another name");
                 }
                 const auto deeper = public_.find(means);
                 means = deeper == public_.end() ? means : deeper->second;
                 if (means != frame.prefix + name) {
                   public_[frame.prefix + name] = means;
                 }
               });
}

}  // namespace ergotic::scene
