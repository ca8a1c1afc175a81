// SPDX-License-Identifier: BSD-3-Clause
// What changes parameters: presets, morphs to them, gestures, and the way back.
#include <algorithm>
#include <utility>

#include <ros/console.h>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ros/interface/model_loader.hpp"
#include "ros/interface/station_controller.hpp"

namespace ergotic::node {
namespace {

// What preparing a change costs is a matter of the model, and others wait.
constexpr std::int64_t kMorphNs = 2'000'000;

}  // namespace

/// \return false if too many wait: then nothing is changed
/// \throws Exception if it is out of range
bool StationController::change(std::size_t index, double value, Change change) {
  std::vector<double> values = parameters_;
  values[index] = value;
  auto coefficients = submitted_->instrument->prepare(values);
  station::Command command;
  command.type = station::Command::Type::kParameter;
  command.index = static_cast<int>(index);
  command.value = value;
  command.coefficients = coefficients.get();
  if (!engine_->station().submit(command)) {
    return false;
  }
  static_cast<void>(coefficients.release());  // comes back with its event
  parameters_ = std::move(values);
  changes_.push_back(std::move(change));
  return true;
}

/// Changes a parameter, as `change`, with undo; a morph excludes it from now on.
bool StationController::set(std::size_t index, double value, Change change) {
  const std::vector<double> before = parameters_;
  if (!this->change(index, value, std::move(change))) {
    return false;
  }
  if (value != before[index]) {
    history_.note(before, rt::monotonicNs());
  }
  morph_.leave(index);
  endMorph();
  return true;
}

/// Values of the parameters that differ from those of the scene.
PresetValues StationController::changedValues() const {
  PresetValues values;
  const auto& known = submitted_->instrument->scene().parameters;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (parameters_[i] != known[i].value) {
      values[known[i].name] = parameters_[i];
    }
  }
  return values;
}

/// Restores values in a model that is about to play. \return values that it does not get, in words
std::string StationController::bringBack(const PresetValues& values) {
  const auto& known = submitted_->instrument->scene().parameters;
  FittingValues fitting = fittingValues(values, known);
  for (std::size_t i = 0; i < known.size(); ++i) {
    const auto found = fitting.values.find(known[i].name);
    if (found != fitting.values.end() && !change(i, found->second, {})) {
      fitting.left_out += (fitting.left_out.empty() ? "" : "; ") + known[i].name;
    }
  }
  return fitting.left_out;
}

/// Sets what the gestures of simulated devices ask for by now. What was meant for another scene is
/// passed over.
void StationController::pollGestureValues() {
  const std::int64_t end_ns = rt::monotonicNs() + kMorphNs;
  const double now_s = engine_->station().driver().gestureTime();
  while (next_value_ < gesture_values_.size() && gesture_values_[next_value_].time_s <= now_s &&
         rt::monotonicNs() < end_ns) {
    const tgr::GestureValue& next = gesture_values_[next_value_];
    try {
      const auto& known = submitted_->instrument->scene().parameters;
      if (!set(tgr::parameterOf(next, known), next.value, {})) {
        return;
      }
    } catch (const Exception& refusal) {
      const std::string warning = std::string(refusal.what()) + "; the row is passed over";
      ROS_WARN_STREAM(warning);
      publishers_.addMessage(warning);
    }
    ++next_value_;
  }
}

std::optional<ParametersNow> StationController::parametersNow() const {
  if (!engine_) {
    return std::nullopt;
  }
  const scene::Scene& scene = submitted_->instrument->scene();
  ParametersNow now;
  now.scene.name = scene.name;
  now.scene.file = scene.file;
  now.scene.text = scene.text;
  now.scene.parameters = scene.parameters;
  now.values = parameters_;
  return now;
}

void StationController::recall(const PresetValues& values, double seconds, const Promise& promise) {
  if (!engine_) {
    return answer(promise, false, kNothingPlays);
  }
  const auto& known = submitted_->instrument->scene().parameters;
  std::map<std::size_t, double> targets;
  for (const auto& [name, value] : values) {
    const auto found =
        std::find_if(known.begin(), known.end(),
                     [wanted = name](const auto& parameter) { return parameter.name == wanted; });
    if (found == known.end()) {  // another model was loaded meanwhile
      return answer(promise, false, unknownParameter(name, submitted_->instrument->scene()));
    }
    targets[static_cast<std::size_t>(found - known.begin())] = value;
  }
  is_undoing_ = false;
  moveTo(targets, seconds, {"the preset is recalled", promise});
}

void StationController::undo(const Promise& promise) {
  if (!engine_) {
    return answer(promise, false, kNothingPlays);
  }
  if (!history_.canUndo()) {
    return answer(promise, false, "no change of parameters is left to be undone");
  }
  const std::vector<double> values = history_.undo();
  std::map<std::size_t, double> targets;
  for (std::size_t i = 0; i < values.size(); ++i) {
    targets[i] = values[i];
  }
  is_undoing_ = true;
  moveTo(targets, 0.0, {"the last change of parameters is undone", promise});
}

/// Starts a morph, in place of the one that is under way.
void StationController::moveTo(const std::map<std::size_t, double>& values,
                               double seconds,
                               Change change) {
  morph_ = {};
  endMorph();
  morph_ = Morph(submitted_->instrument->scene().parameters, parameters_, values, rt::monotonicNs(),
                 seconds);
  if (seconds > 0.0) {
    answer(change.promise, true, change.done);
  } else {
    morphed_ = std::move(change);
  }
  pollMorph();
  endMorph();  // where nothing had to be changed
}

void StationController::pollMorph() {
  preset_topic_.showUndo(history_.canUndo());
  if (morph_.isOver()) {
    return;
  }
  const std::int64_t begin_ns = rt::monotonicNs();
  const auto set = [this, begin_ns](std::size_t index, double value) {
    const std::vector<double> before = parameters_;
    try {
      if (rt::monotonicNs() > begin_ns + kMorphNs || !change(index, value, {})) {
        return false;
      }
    } catch (const Exception& refusal) {  // nobody waits for this step, the others go on
      ROS_WARN_STREAM_THROTTLE(1.0, refusal.what());
      return true;
    }
    if (!is_undoing_) {
      history_.note(before, begin_ns);
    }
    return true;
  };
  morph_.step(begin_ns, set);
  if (morph_.isOver() && morphed_.promise && !changes_.empty() && !changes_.back().promise) {
    changes_.back() = std::exchange(morphed_, {});
  }
  endMorph();
}

/// Answers the caller who waits for a morph that is over, if the last step did not.
void StationController::endMorph() {
  if (morph_.isOver() && morphed_.promise) {
    answer(std::exchange(morphed_.promise, nullptr), true, morphed_.done);
  }
}

/// Clears morph and history, when another scene is loaded.
void StationController::forgetChanges() {
  morph_ = {};
  answer(std::exchange(morphed_.promise, nullptr), false, "another model was loaded meanwhile");
  history_.clear();
}

void StationController::showPresets() {
  if (playing_ == nullptr) {
    return;
  }
  const std::string scene = presetsOf(playing_->instrument->scene());
  std::vector<std::string> names;
  try {
    for (const auto& [name, unused] : PresetFile(presetFolder(), scene).read()) {
      names.push_back(name);
    }
  } catch (const std::exception& refusal) {
    ROS_WARN_STREAM(refusal.what());
    publishers_.addMessage(refusal.what());
  }
  preset_topic_.show(scene, names);
}

}  // namespace ergotic::node
