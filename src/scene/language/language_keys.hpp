// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

/// The keys of what only the language has.
namespace ergotic::scene {

/// Keys of a scene, beside those of a plain one.
const std::vector<std::string>& languageKeys();
/// Keys of every element.
const std::vector<std::string>& elementKeys();
const std::vector<std::string>& definitionKeys();
const std::vector<std::string>& instanceKeys();
/// Keys of a parameter of a definition.
const std::vector<std::string>& parameterSpecKeys();
const std::vector<std::string>& variantKeys();

/// Whether a word is one of a list.
template <class List>
bool contains(const List& list, const std::string& word) {
  return std::find(std::begin(list), std::end(list), word) != std::end(list);
}

}  // namespace ergotic::scene
