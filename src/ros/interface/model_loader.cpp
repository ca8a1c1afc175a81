// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/model_loader.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "ergotic/exception.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "files/printable.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"

namespace ergotic::node {
namespace {

constexpr double kMdlRateHz = 44100.0;

void addLine(std::string& text, const std::string& line) {
  text += (text.empty() ? "" : "\n") + line;
}

/// `path`, or `path#variant`, unless there is a file of that name.
scene::Scene readFile(const std::string& model) {
  const std::size_t hash = model.rfind('#');
  std::error_code unknown;  // reading says what is wrong with it
  if (hash == std::string::npos || std::filesystem::exists(model, unknown)) {
    return scene::readSceneFile(model);
  }
  return scene::readSceneFile(model.substr(0, hash), {}, {model.substr(hash + 1)});
}

/// Choice for a text without a folder: such a text may not name other files.
const scene::Choice kTextAlone = {"", false};

}  // namespace

bool isText(const std::string& model) {
  return model.find('\n') != std::string::npos;
}

scene::Scene readModel(const std::string& model) {
  if (model.empty()) {
    throw Exception("no model is named, allowed: a path, or YAML of more than one line");
  }
  return isText(model) ? scene::readYaml(model, "inline.yaml", {}, kTextAlone) : readFile(model);
}

std::string handsBeside(const std::string& model) {
  if (isText(model)) {
    return "";
  }
  std::error_code unknown;
  const std::size_t hash = model.rfind('#');
  const bool is_variant = hash != std::string::npos && !std::filesystem::exists(model, unknown);
  const std::filesystem::path scene = is_variant ? model.substr(0, hash) : model;
  const std::filesystem::path hands = scene.parent_path() / "hands" / scene.stem().concat(".yaml");
  return std::filesystem::is_regular_file(hands, unknown) ? hands.string() : "";
}

std::string endEffectorsWith(const std::string& model, const std::string& playing, bool can_hurt) {
  const std::string own = handsBeside(model);
  if (can_hurt || own == handsBeside(playing)) {
    return "";
  }
  return own.empty() ? "none" : own;
}

std::string noteAbout(const station::Performer& performer) {
  const physics::Instrument& instrument = *performer.instrument;
  const scene::Scene& scene = instrument.scene();
  const double audio_hz = instrument.rates().audio_hz;
  std::string note;
  for (const std::string& warning : performer.warnings) {
    addLine(note, warning);
  }
  if (scene.time_unit_s != 1.0 && audio_hz != kMdlRateHz) {
    std::ostringstream text;
    text << scene.file << ": counts in samples of " << kMdlRateHz << " Hz and runs at " << audio_hz
         << " Hz: converted through SI units, it keeps its pitch but not its samples";
    addLine(note, text.str());
  }
  return note;
}

std::string answerOn(const std::string& model, const std::string& note, bool force_waits) {
  std::string answer = "plays " + scene::quoted(model);
  if (force_waits) {
    answer += "; call engage for force";
  }
  std::istringstream lines(note);
  for (std::string line; std::getline(lines, line);) {
    if (line.find(": note: ") == std::string::npos) {
      addLine(answer, line);
    }
  }
  return answer;
}

std::string unknownParameter(const std::string& name, const scene::Scene& scene) {
  constexpr std::size_t kShownName = 64;  // of what a stranger says, bytes
  constexpr std::size_t kListed = 20;
  std::string text =
      "the model has no parameter " + scene::quoted(files::printable(name, kShownName));
  const auto& known = scene.parameters;
  text += known.empty() ? ", and no other" : ", it has: ";
  for (std::size_t i = 0; i < std::min(known.size(), kListed); ++i) {
    text += (i == 0 ? "" : ", ") + known[i].name + " = " + scene::numberText(known[i].minimum) +
            "..." + scene::numberText(known[i].maximum) +
            (known[i].unit.empty() ? "" : " " + known[i].unit);
  }
  return text + (known.size() > kListed ? ", ..." : "");
}

std::string textHash(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  }
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
  return digits;
}

}  // namespace ergotic::node
