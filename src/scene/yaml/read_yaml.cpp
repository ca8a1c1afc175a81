// SPDX-License-Identifier: BSD-3-Clause
#include <utility>
#include <vector>

#include "ergotic/exception.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "ergotic/scene/text/read_truths.hpp"
#include "scene/language/emit.hpp"
#include "scene/language/expand.hpp"
#include "scene/text/overrides.hpp"
#include "scene/text/quantity.hpp"
#include "scene/text/source_text.hpp"
#include "scene/tree/yaml_documents.hpp"
#include "scene/yaml/yaml_elements.hpp"
#include "scene/yaml/yaml_keys.hpp"
#include "scene/yaml/yaml_rows.hpp"
#include "scene/yaml/yaml_tables.hpp"
#include "scene/yaml/yaml_truths.hpp"

namespace ergotic::scene {
namespace {

constexpr int kFormatVersion = 1;
constexpr std::size_t kMaxTitleBytes = 200;

/// The scene, and after it the tables of its files if the text has them.
std::vector<Node> parse(const SceneBuilder& builder, const std::string& text) {
  std::vector<Node> documents = readDocuments(builder, text, 2, "a scene needs");
  if (documents.empty() || documents.front().isNull()) {
    builder.fail({1, 1}, "the scene is empty, allowed: a map that begins with 'ergotic: 1'");
  }
  return documents;
}

/// Writes out a scene that uses the language; its plain text is what is kept.
void writeOut(SceneBuilder& builder, std::vector<Node>& documents, const Choice& choice) {
  if (!usesLanguage(documents.front()) && choice.variant.empty()) {
    return;
  }
  const YamlMap top(builder, documents.front(), "the scene", {1, 1});
  documents.front() = expand(builder, documents.front(), choice.variant);
  std::string& text = builder.scene().text;
  text = emit(documents.front());
  if (documents.size() > 1) {
    text += "---\n" + emit(documents.back());
  }
  if (text.size() > kMaxTextBytes) {
    builder.fail({1, 1}, "written out the text has " + std::to_string(text.size()) +
                             " bytes, allowed: at most " + std::to_string(kMaxTextBytes));
  }
}

/// Reads the title, which is a part of every status.
std::string readTitle(const YamlMap& top) {
  std::string title = top.word("name");
  if (title.size() > kMaxTitleBytes) {
    top.fail("name", "the title has " + std::to_string(title.size()) + " bytes, allowed: at most " +
                         std::to_string(kMaxTitleBytes));
  }
  return title;
}

void readHead(SceneBuilder& builder, const YamlMap& top, const Overrides& overrides) {
  const int version = top.integer("ergotic", {});
  if (version != kFormatVersion) {
    top.fail("ergotic", "format version " + std::to_string(version) +
                            " is not known, allowed: " + std::to_string(kFormatVersion));
  }
  Scene& scene = builder.scene();
  scene.about = readAbout(builder, top);
  scene.name = top.has("name")             ? readTitle(top)
               : scene.about.title.empty() ? stemOf(scene.file)
                                           : scene.about.title;
  scene.gestural_rate_hz = overrideGesturalRate(
      overrides, top.number("gestural_rate", kGesturalRateLimits, scene.gestural_rate_hz),
      scene.file);
}

void readParameters(SceneBuilder& builder, const YamlMap& top) {
  forEachElement(
      builder, top, "parameters", "parameter", [&](const std::string& name, const YamlMap& map) {
        map.allow(parameterKeys());
        if (name == kGesturalRateName) {
          builder.fail(map.place(), "parameter name 'gestural_rate' is reserved");
        }
        map.at("range");
        const std::string unit = map.has("unit") ? map.word("unit") : "";
        if (!unit.empty() && !isSiUnit(unit)) {
          map.fail("unit", "unit " + quoted(unit) + " of " + map.what() +
                               " is none, allowed: SI units without prefix, as N/m, kg, Hz");
        }
        const std::vector<double> range = map.vector("range", 2, {unit.c_str()});
        if (range[0] > range[1]) {
          map.fail("range", "range of " + map.what() + " is [" + numberText(range[0]) + ", " +
                                numberText(range[1]) + "], allowed: [lowest, highest]");
        }
        Parameter parameter;
        parameter.name = name;
        parameter.unit = unit;
        parameter.value = map.number("value", {unit.c_str(), range[0], range[1]});
        parameter.minimum = range[0];
        parameter.maximum = range[1];
        parameter.place = map.place();
        builder.add(std::move(parameter));
      });
}

void overrideParameters(SceneBuilder& builder, const Overrides& overrides) {
  Scene& scene = builder.scene();
  std::vector<std::string> names;
  for (const Parameter& parameter : scene.parameters) {
    names.push_back(parameter.name);
  }
  checkOverrides(overrides, names, scene.file);
  for (Parameter& parameter : scene.parameters) {
    const auto found = overrides.find(parameter.name);
    if (found == overrides.end()) {
      continue;
    }
    const Limits limits{"", parameter.minimum, parameter.maximum};
    if (!limits.hold(found->second)) {
      throw Exception(scene.file + ": error: override " +
                      outOfRange(quoted(parameter.name), found->second, limits));
    }
    parameter.value = found->second;
  }
}

/// Warns of what is legal but hardly intended.
void warnOfLooseEnds(SceneBuilder& builder) {
  Scene& scene = builder.scene();
  std::vector<bool> used(scene.mats.size(), false);
  for (const Port& port : scene.ports) {
    used[static_cast<std::size_t>(port.mat)] = true;
  }
  for (const Input& input : scene.inputs) {
    used[static_cast<std::size_t>(input.mat)] = true;
  }
  for (std::size_t i = 0; i < scene.mats.size(); ++i) {
    const Mat& mat = scene.mats[i];
    if (mat.type == MatType::kSlice && !used[i]) {
      builder.warn(mat.place, "no port moves slice " + quoted(mat.name) + ": it stays at rest");
    }
    if (mat.type == MatType::kDriven && !used[i]) {
      builder.warn(mat.place, "no input moves module " + quoted(mat.name) + ": it stays at rest");
    }
  }
}

}  // namespace

void forEachElement(const SceneBuilder& builder,
                    const YamlMap& top,
                    const std::string& part,
                    const std::string& kind,
                    const ElementReader& element) {
  if (!top.has(part)) {
    return;
  }
  forEachEntry(builder, top.at(part), "'" + part + "'", top.keyPlaceAt(part),
               [&](const std::string& name, Place place, const Node& node) {
                 checkName(builder, name, place);
                 if (isTableOfElements(node)) {
                   const YamlMap table(builder, node, "table " + quoted(name), place);
                   forEachRow(builder, table, kind, element);
                   return;
                 }
                 element(name, YamlMap(builder, node, kind + " " + quoted(name), place));
               });
}

ClaimingScene readTruths(const std::string& text,
                         const std::string& name,
                         const Overrides& overrides,
                         const Choice& choice) {
  checkBytes(text, name, Bytes::kUtf8);
  SceneBuilder builder(name, text);
  if (!choice.has_folder) {
    builder.forbidFiles();
  }
  std::vector<Node> documents = parse(builder, text);
  writeOut(builder, documents, choice);
  const YamlMap top(builder, documents.front(), "the scene", {1, 1});
  PointFiles files(builder, documents.size() > 1 ? &documents.back() : nullptr);
  YamlTables tables(builder, files);
  top.allow(sceneKeys());
  readHead(builder, top, overrides);
  readParameters(builder, top);
  overrideParameters(builder, overrides);
  readSections(builder, top);
  readMats(builder, top);
  readGenerators(builder, top, tables, files);
  readPoints(builder, top);
  readLias(builder, top, tables);
  readPorts(builder, top);
  readAgents(builder, top, files);
  files.finish();
  readPortFilters(builder, top);
  readInputs(builder, top);
  readOutputs(builder, top);
  std::vector<Truth> truths = truthsOf(builder, top);
  warnOfLooseEnds(builder);
  return {builder.finish(), std::move(truths)};
}

Scene readYaml(const std::string& text,
               const std::string& name,
               const Overrides& overrides,
               const Choice& choice) {
  return readTruths(text, name, overrides, choice).scene;
}

}  // namespace ergotic::scene
