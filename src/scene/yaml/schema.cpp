// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/text/schema.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "scene/language/language_keys.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

// What may stand under a key. Where a number or a word may, an expression may, too.
constexpr const char* kNumber = R"({"type": ["number", "string"]})";
constexpr const char* kWord = R"({"type": "string"})";
constexpr const char* kScalar = R"({"type": ["string", "number"]})";
constexpr const char* kFlag = R"({"type": ["boolean", "string"]})";
constexpr const char* kList = R"({"type": ["array", "string"]})";
constexpr const char* kMap = R"({"type": "object"})";
constexpr const char* kListOrNumber = R"({"type": ["array", "number", "string"]})";
constexpr const char* kMapOrWord = R"({"type": ["object", "string"]})";
constexpr const char* kAny = R"({})";

/// Schema of the value of each key, whichever element has the key.
const std::map<std::string, const char*>& values() {
  static const std::map<std::string, const char*> kValues = {
      {"along", kWord},
      {"as", kWord},
      {"at", kListOrNumber},
      {"author", kWord},
      {"axis", kWord},
      {"between", kList},
      {"branches", kList},
      {"cells", kListOrNumber},
      {"channel", kNumber},
      {"channels", kListOrNumber},
      {"class", kWord},
      {"coarse", kFlag},
      {"columns", kNumber},
      {"coupling", kWord},
      {"damping", kNumber},
      {"damping_ratio", kNumber},
      {"default", kAny},
      {"define", kMap},
      {"defaults", kMap},
      {"description", kWord},
      {"diagonal_stiffness", kNumber},
      {"doc", kWord},
      {"edges", kWord},
      {"elastic", kAny},
      {"ends", kList},
      {"engage", kNumber},
      {"ergotic", kNumber},
      {"exponent", kNumber},
      {"file", kWord},
      {"filter", kMapOrWord},
      {"for", kMap},
      {"force_scale", kNumber},
      {"frequency", kNumber},
      {"from", kAny},
      {"gain", kNumber},
      {"geometry", kWord},
      {"gestural_rate", kNumber},
      {"gesture", kMap},
      {"gives", kMap},
      {"gravity", kListOrNumber},
      {"guide", R"({"type": ["object", "array"]})"},
      {"hands", kMap},
      {"hardening", kNumber},
      {"impedance", kNumber},
      {"in", kMap},
      {"include", kList},
      {"inharmonicity", kNumber},
      {"is", kWord},
      {"keep_pitch", kFlag},
      {"kind", kWord},
      {"length", kNumber},
      {"let", kMap},
      {"licence", kWord},
      {"load", kMap},
      {"loop", kFlag},
      {"loss", kNumber},
      {"loss_factor", kNumber},
      {"mass", kNumber},
      {"masses", kNumber},
      {"mat", kWord},
      {"matched", kFlag},
      {"material", kWord},
      {"medium", kNumber},
      {"modes", kScalar},
      {"name", kScalar},
      {"needs", kMap},
      {"neighbours", kNumber},
      {"nonlinearity", kNumber},
      {"normal", kNumber},
      {"of", kList},
      {"offset", kNumber},
      {"pan", kListOrNumber},
      {"params", kMap},
      {"parts", kList},
      {"partials", kListOrNumber},
      {"period", kNumber},
      {"picture", kMap},
      {"pitch", kNumber},
      {"pitch_of", kNumber},
      {"places", R"({"type": ["object", "array", "string"]})"},
      {"play", kWord},
      {"pluck", kMap},
      {"points", kList},
      {"poisson", kNumber},
      {"pose", kMap},
      {"position_scale", kNumber},
      {"power", kNumber},
      {"quantity", kWord},
      {"radiation", kNumber},
      {"range", kList},
      {"rate", kMapOrWord},
      {"ratios", kListOrNumber},
      {"release", kNumber},
      {"release_force", kNumber},
      {"rest", kNumber},
      {"rest_length", kNumber},
      {"rest_length_ratio", kNumber},
      {"ring", kMap},
      {"rotate", kListOrNumber},
      {"rows", kNumber},
      {"scheme", kWord},
      {"section", kWord},
      {"set", kMap},
      {"shape", kWord},
      {"sleep", kNumber},
      {"slice", kNumber},
      {"sources", kList},
      {"spacing", kNumber},
      {"speakers", R"({"type": ["string", "array", "object"]})"},
      {"speed", kNumber},
      {"start", kWord},
      {"steady", kNumber},
      {"stiffness", kNumber},
      {"stiffness_limit", kNumber},
      {"t60", kListOrNumber},
      {"table", kAny},
      {"tank", kWord},
      {"tension", kNumber},
      {"threshold", kNumber},
      {"tick_rate", kNumber},
      {"title", kWord},
      {"to", kList},
      {"type", kWord},
      {"unit", kWord},
      {"use", kList},
      {"v", kListOrNumber},
      {"value", kNumber},
      {"variants", kMap},
      {"viscous", kAny},
      {"weights", kListOrNumber},
      {"when", kScalar},
      {"width", kNumber},
      {"with", kMap},
      {"x", kListOrNumber},
  };
  return kValues;
}

std::string quote(const std::string& text) {
  return "\"" + text + "\"";  // keys are letters and '_'
}

std::string reference(const std::string& name) {
  return R"({"$ref": "#/definitions/)" + name + "\"}";
}

/// `{"key": value, ...}` of what the keys stand for, those given first.
std::string properties(const KeyNames& keys, const std::map<std::string, std::string>& given = {}) {
  std::string text;
  for (const std::string& key : keys) {
    const auto own = given.find(key);
    const auto known = values().find(key);
    text += (text.empty() ? "" : ", ") + quote(key) + ": " +
            (own != given.end()        ? own->second
             : known != values().end() ? known->second
                                       : kAny);
  }
  return "{" + text + "}";
}

std::string closed(const KeyNames& keys, const std::map<std::string, std::string>& given = {}) {
  return R"({"type": "object", "additionalProperties": false, "properties": )" +
         properties(keys, given) + "}";
}

KeyNames withElementKeys(KeyNames keys) {
  keys.insert(keys.end(), elementKeys().begin(), elementKeys().end());
  return keys;
}

/// Elements of a part, by name; each may be a table of many.
std::string namedElements(const std::string& element) {
  return R"({"type": "object", "additionalProperties": {"anyOf": [)" + reference("table") + ", " +
         reference(element) + "]}}";
}

std::string listed(const std::string& element) {
  return R"({"type": "array", "items": )" + reference(element) + "}";
}

/// Parts that scenes and definitions have.
std::map<std::string, std::string> parts() {
  return {{"mats", namedElements("mat")},       {"generators", listed("generator")},
          {"lias", namedElements("lia")},       {"agents", namedElements("agent")},
          {"ports", namedElements("port")},     {"inputs", namedElements("input")},
          {"outputs", namedElements("output")}, {"use", listed("instance")}};
}

/// An element whose type decides which keys it has. One whose type is an expression may have any.
std::string byType(const std::string& part, const KeysOfTypes& kinds) {
  std::string words;
  std::string cases;
  for (const auto& [word, keys] : kinds) {
    const bool is_new = words.find(quote(word)) == std::string::npos;
    words += is_new ? (words.empty() ? "" : ", ") + quote(word) : "";
    if (!keys.empty() && is_new) {
      cases += std::string(cases.empty() ? "" : ", ") +
               R"({"if": {"properties": {"type": {"const": )" + quote(word) +
               R"(}}, "required": ["type"]}, "then": )" + reference(part + "." + word) + "}";
    }
  }
  return R"({"type": "object", "properties": {"type": {"anyOf": [{"enum": [)" + words +
         R"(]}, {"type": "string", "pattern": "[={]"}]}}, "allOf": [)" + cases + "]}";
}

/// Merges, for each word, the keys that it has with a table and without.
KeysOfTypes merged(const KeysOfTypes& kinds) {
  KeysOfTypes all;
  for (const auto& [word, keys] : kinds) {
    const auto same = std::find_if(all.begin(), all.end(), [&, &sought = word](const auto& each) {
      return each.first == sought;
    });
    if (same == all.end()) {
      all.emplace_back(word, keys);
      continue;
    }
    for (const std::string& key : keys) {
      if (std::find(same->second.begin(), same->second.end(), key) == same->second.end()) {
        same->second.push_back(key);
      }
    }
  }
  return all;
}

class Definitions {
 public:
  void add(const std::string& name, const std::string& schema) {
    text_ += (text_.empty() ? "\n    " : ",\n    ") + quote(name) + ": " + schema;
  }
  void addTypes(const std::string& part, const KeysOfTypes& kinds) {
    for (const auto& [word, keys] : kinds) {
      if (!keys.empty()) {
        add(part + "." + word, closed(withElementKeys(keys)));
      }
    }
    add(part, byType(part, kinds));
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string definitions() {
  Definitions all;
  all.add("table", R"({"type": "object", "required": ["columns", "rows"]})");
  all.addTypes("mat", keysOfMats());
  all.addTypes("generator", keysOfGenerators());
  all.addTypes("lia", merged(keysOfLias()));
  all.add("parameter", closed(parameterKeys()));
  all.add("section", closed(withElementKeys(sectionKeys())));
  all.add("agent", closed(withElementKeys(agentKeys()), {{"gesture", closed(gestureKeys())}}));
  all.add("port", closed(withElementKeys(portKeys()), {{"filter", closed(filterKeys())}}));
  all.add("input", closed(withElementKeys(inputKeys())));
  all.add("output",
          closed(withElementKeys(outputKeys()), {{"at", R"({"type": ["string", "array"]})"}}));
  all.add("instance", closed(instanceKeys()));
  all.add("definition", closed(definitionKeys(), [] {
            auto own = parts();
            own["params"] = R"({"type": "object", "additionalProperties": )" +
                            closed(parameterSpecKeys()) + "}";
            return own;
          }()));
  all.add("variant", closed(variantKeys()));
  return all.text();
}

}  // namespace

std::string schemaOfScenes() {
  KeyNames keys = sceneKeys();
  keys.insert(keys.end(), languageKeys().begin(), languageKeys().end());
  std::map<std::string, std::string> own = parts();
  const auto mapOf = [](const std::string& element) {
    return R"({"type": "object", "additionalProperties": )" + reference(element) + "}";
  };
  own["about"] =
      closed(aboutKeys(), {{"picture", closed(cameraKeys(), {{"from", kList}, {"at", kList}})}});
  own["parameters"] = mapOf("parameter");
  own["sections"] = mapOf("section");
  own["define"] = mapOf("definition");
  own["variants"] = mapOf("variant");
  return "{\n  \"$schema\": \"http://json-schema.org/draft-07/schema#\",\n"
         "  \"title\": \"A scene of Ergotic\",\n  \"type\": \"object\",\n"
         "  \"additionalProperties\": false,\n  \"properties\": " +
         properties(keys, own) + ",\n  \"definitions\": {" + definitions() + "\n  }\n}\n";
}

}  // namespace ergotic::scene
