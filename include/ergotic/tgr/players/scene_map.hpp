// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ergotic/scene/scene.hpp"
#include "ergotic/tgr/players/play_map.hpp"

/// Maps of the notes that play a scene.
namespace ergotic::tgr {

/// \throws TextError as readPlayMap, Exception if the file cannot be read
PlayMap readPlayMapFile(const std::string& path);

/// \return the file `folder/maps/NAME.yaml` of a scene `folder/NAME.yaml`; empty if there is none
std::string mapBeside(const std::string& scene_file);

/// Map for a scene without a map: each slice is a key, from middle C on.
PlayMap usualMap(const scene::Scene& scene);

/// Removes the lines that move coordinates of end-effectors that do not exist.
/// \return their names, each once, in order
std::vector<std::string> leaveOut(PlayMap& map,
                                  const std::function<bool(const std::string&)>& is_there);

/// \return the first and the last note of each range of notes that have a key, 0...127, in order
std::vector<std::pair<int, int>> notesWithKeys(const PlayMap& map);

/// Ranges of all parameters of a scene, by name.
std::map<std::string, ParameterRange> rangesOf(const scene::Scene& scene);

}  // namespace ergotic::tgr
