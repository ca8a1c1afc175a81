// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/sound_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "ergotic/audio/wav.hpp"
#include "ergotic/exception.hpp"
#include "tools/lib/options.hpp"

namespace ergotic::tools {
namespace {

const scene::Input& inputNamed(const scene::Scene& scene, const std::string& name) {
  const auto found = std::find_if(scene.inputs.begin(), scene.inputs.end(),
                                  [&](const scene::Input& input) { return input.name == name; });
  if (found == scene.inputs.end()) {
    std::string names;
    for (const scene::Input& input : scene.inputs) {
      names += (names.empty() ? "" : ", ") + input.name;
    }
    throw Exception("--input " + name +
                    ": the scene has no such input, it has: " + (names.empty() ? "none" : names));
  }
  return *found;
}

std::vector<double> readSound(const std::string& path,
                              double rate_hz,
                              std::vector<std::string>& warnings) {
  audio::WavReader reader(path);
  std::ostringstream message;
  if (reader.sampleRate() != rate_hz) {
    message << path << ": sample rate " << reader.sampleRate() << " Hz, the instrument runs at "
            << rate_hz << " Hz; convert the file or choose --rate " << reader.sampleRate();
    throw Exception(message.str());
  }
  if (reader.channels() != 1) {
    message << path << ": " << reader.channels() << " channels, an input takes 1";
    throw Exception(message.str());
  }
  std::vector<double> sound = reader.readAll();
  if (sound.empty()) {
    warnings.push_back(path + ": warning: the file has no frames, so the input is silent");
  } else if (reader.isUnfinished()) {
    warnings.push_back(path +
                       ": warning: the header does not say how long the sound is, as when "
                       "its recorder was killed; it is read up to the end of the file");
  }
  const auto bad = std::find_if_not(sound.begin(), sound.end(),
                                    [](double sample) { return std::isfinite(sample); });
  if (bad != sound.end()) {
    message << path << ": frame " << bad - sound.begin() << " is " << *bad
            << ", allowed: finite numbers";
    throw Exception(message.str());
  }
  return sound;
}

}  // namespace

SoundInputs::SoundInputs(const std::vector<std::string>& files,
                         const scene::Scene& scene,
                         double rate_hz)
    : sounds_(static_cast<std::size_t>(scene.inputChannels())), any_(!files.empty()) {
  for (const std::string& file : files) {
    const auto [name, path] = splitAssignment(file);
    const scene::Input& input = inputNamed(scene, name);
    sounds_[static_cast<std::size_t>(input.channel)] = readSound(path, rate_hz, warnings_);
  }
}

}  // namespace ergotic::tools
