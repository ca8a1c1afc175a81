// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/programs.hpp"

#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <vector>

#include "ergotic/exception.hpp"

namespace ergotic::node {
namespace {

using std::filesystem::path;

/// Scenes for measurements are no instruments.
bool isInstrument(const path& file) {
  constexpr char kMeasured[] = "_truths";
  const std::string name = file.stem().string();
  const std::size_t end = name.rfind(kMeasured);
  const bool is_measured = end != std::string::npos && end + sizeof kMeasured - 1 == name.size();
  return (file.extension() == ".yaml" || file.extension() == ".mdl") && !is_measured;
}

/// Instruments of a folder, sorted by name; of two files of one name the later replaces the first.
std::vector<path> instrumentsIn(const path& folder) {
  std::error_code error;  // of a folder that cannot be read nothing is listed
  std::set<path> files;
  for (std::filesystem::directory_iterator next(folder, error), end; next != end && !error;
       next.increment(error)) {
    if (isInstrument(next->path())) {
      files.insert(next->path());
    }
  }
  std::vector<path> instruments;
  std::map<std::string, std::size_t> places;
  for (const path& file : files) {
    const auto [place, is_new] = places.emplace(file.stem().string(), instruments.size());
    if (is_new) {
      instruments.push_back(file);
    } else {
      instruments[place->second] = file;
    }
  }
  return instruments;
}

}  // namespace

std::string sceneOfProgram(int program, const std::string& playing) {
  const std::string wish = "program " + std::to_string(program);
  std::error_code error;
  if (!std::filesystem::is_regular_file(playing, error)) {
    throw Exception(wish + ": what plays came as a text, allowed: while a scene of a file plays");
  }
  const path folder = std::filesystem::absolute(playing).parent_path();
  const std::vector<path> instruments = instrumentsIn(folder);
  if (static_cast<std::size_t>(program) >= instruments.size()) {
    throw Exception(
        wish + ", allowed: " +
        (instruments.empty() ? "none" : "0..." + std::to_string(instruments.size() - 1)) +
        ", the scenes in " + folder.string());
  }
  return instruments[static_cast<std::size_t>(program)].string();
}

}  // namespace ergotic::node
