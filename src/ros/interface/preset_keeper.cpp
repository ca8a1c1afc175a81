// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/preset_keeper.hpp"

#include "ergotic/exception.hpp"
#include "ros/interface/file_name.hpp"
#include "ros/interface/variant_file.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"

namespace ergotic::node {
namespace {

constexpr scene::Limits kMorphLimits{"s", 0.0, 60.0};

PresetValues valuesOf(const ParametersNow& now) {
  PresetValues values;
  for (std::size_t i = 0; i < now.values.size(); ++i) {
    values[now.scene.parameters[i].name] = now.values[i];
  }
  return values;
}

}  // namespace

PresetKeeper::PresetKeeper(CommandThread& command_thread)
    : command_thread_(command_thread), folder_(presetFolder()) {}

Preset::Response PresetKeeper::serve(const Preset::Request& request) {
  Preset::Response response;
  Answer answer;
  try {
    answer = act(request, response.path);
  } catch (const std::exception& refusal) {
    answer = {false, refusal.what()};
  }
  response.success = answer.ok ? 1U : 0U;
  response.message = answer.message;
  return response;
}

Answer PresetKeeper::act(const Preset::Request& request, std::string& path) {
  if (request.action > Preset::Request::SAVE) {
    return {false, "action is " + std::to_string(request.action) + ", allowed: 0...4"};
  }
  if (request.action == Preset::Request::UNDO) {
    return command_thread_.undo();
  }
  requireFileName("preset", request.name);
  const std::lock_guard lock(mutex_);
  switch (request.action) {
    case Preset::Request::KEEP:
      return keep(request.name, path);
    case Preset::Request::RECALL:
      return recall(request.name, request.seconds);
    case Preset::Request::FORGET:
      return forget(request.name);
    default:
      return save(request.name, path);
  }
}

PresetFile PresetKeeper::fileOf(const ParametersNow& now) const {
  return {folder_, presetsOf(now.scene)};
}

Answer PresetKeeper::keep(const std::string& name, std::string& path) {
  const ParametersNow now = command_thread_.parametersNow();
  if (now.values.empty()) {
    return {false, "the scene that plays has no parameters to keep"};
  }
  const PresetFile file = fileOf(now);
  file.keep(name, valuesOf(now));
  path = file.path();
  command_thread_.showPresets();
  return {true, "preset " + scene::quoted(name) + " is kept in " + path};
}

Answer PresetKeeper::recall(const std::string& name, double seconds) {
  if (!kMorphLimits.hold(seconds)) {
    return {false, scene::outOfRange("seconds", seconds, kMorphLimits)};
  }
  const ParametersNow now = command_thread_.parametersNow();
  const FittingValues fitting = fittingValues(fileOf(now).at(name), now.scene.parameters);
  const std::string left_out = fitting.left_out.empty() ? "" : "; left out: " + fitting.left_out;
  if (fitting.values.empty()) {
    return {false, "nothing of preset " + scene::quoted(name) + " can be recalled" + left_out};
  }
  Answer answer = command_thread_.recall(fitting.values, seconds);
  if (answer.ok) {
    answer.message =
        "preset " + scene::quoted(name) +
        (seconds > 0.0 ? " is reached in " + scene::numberText(seconds) + " s" : " is recalled") +
        left_out;
  }
  return answer;
}

Answer PresetKeeper::forget(const std::string& name) {
  fileOf(command_thread_.parametersNow()).forget(name);
  command_thread_.showPresets();
  return {true, "preset " + scene::quoted(name) + " is forgotten"};
}

Answer PresetKeeper::save(const std::string& name, std::string& path) {
  const ParametersNow now = command_thread_.parametersNow();
  const SavedVariant saved = saveVariant(folder_, now.scene, name, valuesOf(now));
  path = saved.path;
  return {true, "variant " + scene::quoted(name) + " is written: load_model " + path + "#" + name +
                    (saved.is_written_out ? ". The scene is written out in it, without its comments"
                                          : "")};
}

}  // namespace ergotic::node
