// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "support/places.hpp"

namespace ergotic::test {

/// What stands between ```yaml and ``` in a document of the repository, in order.
inline std::vector<std::string> yamlIn(const std::string& document) {
  const std::string text = textOf(repository(document));
  const std::string begin = "\n```yaml\n";
  std::vector<std::string> blocks;
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
    at += begin.size();
    blocks.push_back(text.substr(at, text.find("```", at) - at));
  }
  return blocks;
}

}  // namespace ergotic::test
