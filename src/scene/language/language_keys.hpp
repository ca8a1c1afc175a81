// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

/// The keys of what only the language has.
namespace ergotic::scene {

/// Of a scene, beside those of a plain one.
const std::vector<std::string>& languageKeys();
/// Of every element.
const std::vector<std::string>& elementKeys();
const std::vector<std::string>& definitionKeys();
const std::vector<std::string>& instanceKeys();
/// Of what a definition takes.
const std::vector<std::string>& parameterSpecKeys();
const std::vector<std::string>& variantKeys();

}  // namespace ergotic::scene
