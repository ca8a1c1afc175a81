// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/language_keys.hpp"

namespace ergotic::scene {

const std::vector<std::string>& languageKeys() {
  static const std::vector<std::string> kKeys = {"include", "let",      "defaults",
                                                 "define",  "variants", "use"};
  return kKeys;
}

const std::vector<std::string>& elementKeys() {
  static const std::vector<std::string> kKeys = {"for", "when", "class"};
  return kKeys;
}

const std::vector<std::string>& definitionKeys() {
  static const std::vector<std::string> kKeys = {"doc",   "params", "needs",      "gives", "let",
                                                 "use",   "mats",   "generators", "lias",  "agents",
                                                 "ports", "inputs", "outputs",    "truths"};
  return kKeys;
}

const std::vector<std::string>& instanceKeys() {
  static const std::vector<std::string> kKeys = {"is", "as",     "with", "in",
                                                 "at", "rotate", "for",  "when"};
  return kKeys;
}

const std::vector<std::string>& parameterSpecKeys() {
  static const std::vector<std::string> kKeys = {"doc", "unit", "default", "range", "kind"};
  return kKeys;
}

const std::vector<std::string>& variantKeys() {
  static const std::vector<std::string> kKeys = {"doc", "let", "set"};
  return kKeys;
}

}  // namespace ergotic::scene
