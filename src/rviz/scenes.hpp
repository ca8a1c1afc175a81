// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace ergotic::panel {

/// An instrument that can be chosen.
struct SceneEntry {
  std::string model;  ///< for `load_model`: path, or path#variant
  std::string name;   ///< as `status.model` says when it plays
  std::string title;  ///< for the list
  std::string about;  ///< what it is, in words; may be empty
  /// Path of what it looks like, `pictures/NAME.png` beside a scene `NAME.yaml`; empty: none is
  /// there
  std::string picture;
};

/// The scene in a text, and its variants. A text that is no scene is described as far as it can be:
/// the station says what is wrong with it when it is chosen.
/// \param path  where it was read
std::vector<SceneEntry> scenesOf(const std::string& path, const std::string& text);

/// All scenes (`*.yaml`) of some folders, not of those below, by their titles. What cannot be read
/// is left out.
std::vector<SceneEntry> scenesIn(const std::vector<std::string>& folders);

/// The comment that a text begins with, as one line; without what it says to machines.
std::string leadingComment(const std::string& text);

}  // namespace ergotic::panel
