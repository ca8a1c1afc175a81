// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/players/scene_map.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "files/read_file.hpp"

namespace ergotic::tgr {

PlayMap readPlayMapFile(const std::string& path) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 20U;
  return readPlayMap(files::readFile(path, kMaxBytes), path);
}

std::string mapBeside(const std::string& scene_file) {
  const std::filesystem::path scene(scene_file);
  const std::filesystem::path map =
      scene.parent_path() / "maps" / (scene.stem().string() + ".yaml");
  std::error_code error;
  return std::filesystem::is_regular_file(map, error) ? map.string() : "";
}

PlayMap usualMap(const scene::Scene& scene) {
  constexpr int kMiddleC = 60;
  constexpr double kWayM = 0.02;
  PlayMap map;
  KeyMove move;
  move.to_m = {kWayM};
  for (const scene::Port& port : scene.ports) {
    if (port.slice >= 0) {
      move.indices.push_back(port.slice);
    }
  }
  if (!move.indices.empty()) {
    std::sort(move.indices.begin(), move.indices.end());
    KeyLine line;
    line.first_note = kMiddleC;
    line.moves.push_back(move);
    map.keys.push_back(line);
  }
  return map;
}

std::vector<std::string> leaveOut(PlayMap& map,
                                  const std::function<bool(const std::string&)>& is_there) {
  std::set<std::string> left_out;
  const auto is_missing = [&](const std::string& end_effector) {
    const bool is_left_out = !end_effector.empty() && !is_there(end_effector);
    if (is_left_out) {
      left_out.insert(end_effector);
    }
    return is_left_out;
  };
  const auto leave_out_of = [&](auto& lines, const auto& end_effector_of) {
    lines.erase(std::remove_if(lines.begin(), lines.end(),
                               [&](const auto& line) { return is_missing(end_effector_of(line)); }),
                lines.end());
  };
  for (KeyLine& line : map.keys) {
    leave_out_of(line.moves, [](const KeyMove& move) { return move.end_effector; });
  }
  map.keys.erase(std::remove_if(map.keys.begin(), map.keys.end(),
                                [](const KeyLine& line) { return line.moves.empty(); }),
                 map.keys.end());
  leave_out_of(map.controls, [](const ControlLine& line) { return line.motion.end_effector; });
  for (KeyLine& line : map.keys) {
    for (auto* const motion : {&line.bend, &line.slide}) {
      if (*motion && is_missing((*motion)->end_effector)) {
        motion->reset();
      }
    }
  }
  return {left_out.begin(), left_out.end()};
}

std::vector<std::pair<int, int>> notesWithKeys(const PlayMap& map) {
  constexpr int kNotes = 128;
  std::vector<std::pair<int, int>> ranges;
  for (int note = 0; note < kNotes; ++note) {
    const int sounding = note + map.transpose;
    const bool has_key =
        std::any_of(map.keys.begin(), map.keys.end(), [sounding](const KeyLine& line) {
          return sounding >= line.first_note && sounding <= line.last_note;
        });
    if (has_key && !ranges.empty() && ranges.back().second == note - 1) {
      ranges.back().second = note;
    } else if (has_key) {
      ranges.emplace_back(note, note);
    }
  }
  return ranges;
}

std::map<std::string, ParameterRange> rangesOf(const scene::Scene& scene) {
  std::map<std::string, ParameterRange> ranges;
  for (const scene::Parameter& parameter : scene.parameters) {
    ranges[parameter.name] = {parameter.minimum, parameter.value, parameter.maximum};
  }
  return ranges;
}

}  // namespace ergotic::tgr
