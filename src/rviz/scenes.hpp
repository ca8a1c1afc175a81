// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace ergotic::panel {

/// An instrument that can be chosen.
struct SceneEntry {
  std::string model;  ///< argument of `load_model`: path, or path#variant
  std::string name;   ///< name as `status.model` gives it
  std::string title;  ///< title in the list
  std::string about;  ///< description; may be empty
  /// Path of what it looks like, `pictures/NAME.png` beside a scene `NAME.yaml`; empty: none is
  /// there
  std::string picture;
};

/// The scene in a text, and its variants. A text that is no scene is described as far as it can be:
/// the station says what is wrong with it when it is chosen.
/// \param path  where it was read
std::vector<SceneEntry> scenesOf(const std::string& path, const std::string& text);

/// Scenes (`*.yaml`) of some folders, not of their subfolders, sorted by title. Files that cannot
/// be read are left out.
std::vector<SceneEntry> scenesIn(const std::vector<std::string>& folders);

/// Comment at the begin of a text, as one line; without its parts for programs.
std::string leadingComment(const std::string& text);

}  // namespace ergotic::panel
