// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/loader.hpp"

#include <exception>
#include <utility>

#include <ros/console.h>
#include <ros/this_node.h>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"
#include "ergotic/station/judge_hands.hpp"
#include "ros/interface/convert.hpp"
#include "ros/interface/model_loader.hpp"
#include "ros/interface/programs.hpp"

namespace ergotic::node {
namespace {

constexpr std::int64_t kPatienceNs = 10'000'000'000;  // for devices that are busy

/// \param[out] verdict  also set when the model is refused for its sake
std::unique_ptr<station::Performer> makePerformer(scene::Scene scene,
                                                  const physics::Rates& rates,
                                                  const physics::CompileOptions& options,
                                                  const station::PerformerPolicy& policy,
                                                  std::string& verdict) {
  try {
    auto performer = station::makePerformer(std::move(scene), rates, options, policy);
    verdict = physics::toString(performer->certificate.verdict);
    return performer;
  } catch (const station::RefusedScene& refusal) {
    verdict = physics::toString(refusal.verdict());
    throw;
  }
}

void logStage(const std::string& stage) {
  ROS_INFO_STREAM(stage);
}

double audioRateFor(const Parameters& parameters) {
  if (parameters.jack) {
    if (const auto found = findJackRate(parameters.jack_name, parameters.jack_wait)) {
      return *found;
    }
    ROS_WARN_STREAM("no JACK server within "
                    << parameters.jack_wait << " s: plays without sound at "
                    << parameters.audio_rate << " Hz until one with that rate appears");
  }
  return parameters.audio_rate;
}

}  // namespace

/// \return none: those that are there stay
std::optional<tgr::EndEffectors> Loader::endEffectorsFor(const Wish& wish) const {
  std::string wanted = wish.end_effectors;
  if (wanted == kOwnEndEffectors) {
    const auto terms = command_thread_.terms();
    wanted = terms ? endEffectorsWith(wish.model, terms->scene_file, terms->can_hurt) : "";
  }
  if (wanted.empty()) {
    return std::nullopt;
  }
  return wanted == "none" ? tgr::EndEffectors() : readEndEffectors(wanted);
}

LoadModel::Response Loader::load(const std::string& model,
                                 bool allow_unproven,
                                 const std::string& loader,
                                 const std::string& end_effectors) {
  return load({model, allow_unproven, loader, end_effectors, false});
}

Answer Loader::reload(const std::string& loader) {
  if (last_.model.empty()) {
    return {false, kNothingPlays};
  }
  if (isText(last_.model)) {
    return {false, "the scene came as a text: there is no file that could be read again"};
  }
  const LoadModel::Response response =
      load({last_.model, last_.allow_unproven, loader, "", has_played_});
  return {response.success != 0U, response.message};
}

LoadModel::Response Loader::load(const Wish& wish) {
  LoadModel::Response response;
  Answer answer;
  is_device_missing_ = false;
  try {
    const std::optional<tgr::EndEffectors> end_effectors = endEffectorsFor(wish);
    answer = play(readModel(wish.model), wish, end_effectors, response.verdict);
  } catch (const DeviceError& missing) {
    is_device_missing_ = true;
    answer = {false, missing.what()};
  } catch (const std::exception& refusal) {
    answer = {false, refusal.what()};
  }
  if (answer.ok || !has_played_) {
    last_ = wish;
    has_played_ = answer.ok;
  }
  if (answer.ok) {
    ROS_INFO_STREAM(answer.message);
  } else {
    ROS_ERROR_STREAM(answer.message);
    command_thread_.tell(answer.message);
  }
  rt::trimHeap();  // a text takes far more memory while it is read than what plays does
  response.success = answer.ok ? 1U : 0U;
  response.message = answer.message;
  return response;
}

/// \return false if there shall be none
bool Loader::waitUntilNextTry(std::int64_t end_ns) const {
  constexpr std::int64_t kPauseNs = 50'000'000;
  constexpr int kPauses = 10;
  for (int i = 0; i < kPauses && !gives_up_; ++i) {
    rt::sleepUntilNs(rt::monotonicNs() + kPauseNs);
  }
  return !gives_up_ && rt::monotonicNs() < end_ns;
}

void Loader::loadFromParameters() {
  try {
    const Parameters parameters = readParameters(node_);
    if (parameters.model.empty()) {
      return;
    }
    const std::int64_t end_ns = rt::monotonicNs() + kPatienceNs;
    do {
      load(parameters.model, true, ::ros::this_node::getName());
    } while (is_device_missing_ && waitUntilNextTry(end_ns));
  } catch (const Exception& refusal) {
    ROS_ERROR_STREAM(refusal.what());
    command_thread_.tell(refusal.what());
  }
}

/// Loads a program. A program change does not ask for force: force is kept only if the station
/// engaged it by itself.
void Loader::loadProgram(int program) {
  try {
    const auto terms = command_thread_.terms();
    if (!terms) {
      throw Exception(kNothingPlays);
    }
    const MidiPrograms allowed = terms->parameters.midi_programs;
    if (allowed == MidiPrograms::kNever ||
        (allowed == MidiPrograms::kSimulated && terms->can_hurt)) {
      return;
    }
    load(sceneOfProgram(program, terms->scene_file), false, ::ros::this_node::getName(),
         kOwnEndEffectors);
  } catch (const Exception& refusal) {
    ROS_WARN_STREAM(refusal.what());
    command_thread_.tell(refusal.what());
  }
}

Answer Loader::play(scene::Scene scene,
                    const Wish& wish,
                    const std::optional<tgr::EndEffectors>& end_effectors,
                    std::string& verdict) {
  const auto terms = command_thread_.terms();
  if (!terms) {
    return start(std::move(scene), wish.allow_unproven, end_effectors, verdict);
  }
  station::PerformerPolicy policy;
  policy.on_stage = logStage;
  policy.allow_unproven = wish.allow_unproven && terms->parameters.allow_unproven;
  policy.max_load = terms->parameters.max_load;
  policy.slices = terms->slices;
  policy.device = terms->device;
  policy.end_effectors = end_effectors.value_or(terms->end_effectors);
  const physics::Rates rates =
      physics::chooseRates(scene, terms->rates.audio_hz, terms->rates.gesturalHz());
  auto performer =
      makePerformer(std::move(scene), rates, terms->parameters.compile, policy, verdict);
  const auto picture = toPicture(*performer->instrument, terms->parameters.display_zoom);
  Answer answer = command_thread_.swap(std::move(performer),
                                       {picture, wish.loader, end_effectors, wish.is_again});
  if (answer.ok && end_effectors) {
    description_.update(command_thread_);
  }
  return answer;
}

Answer Loader::start(scene::Scene scene,
                     bool allow_unproven,
                     const std::optional<tgr::EndEffectors>& end_effectors,
                     std::string& verdict) {
  const Parameters given = readParameters(node_);
  tgr::StationDevices devices = readDevices(given);
  devices.end_effectors = end_effectors.value_or(devices.end_effectors);
  auto hands = std::make_unique<Hands>(std::move(devices), given.allow_fault_injection);
  const physics::Rates rates =
      physics::chooseRates(scene, audioRateFor(given), given.gestural_rate);
  hands->probe(rates.gesturalHz(), given.safety.slice_mass_kg);
  hands->checkGestures(scene.parameters);
  const Parameters parameters = withStallLimits(given, hands->canHurt());
  station::PerformerPolicy policy;
  policy.on_stage = logStage;
  policy.allow_unproven = allow_unproven && parameters.allow_unproven;
  policy.max_load = parameters.max_load;
  policy.slices = hands->slices();
  policy.device = hands->traits();
  policy.end_effectors = hands->config().end_effectors;
  auto performer = makePerformer(std::move(scene), rates, parameters.compile, policy, verdict);
  station::giveHands(*performer, policy.end_effectors, policy.slices, policy.device);
  station::Performer* const first = performer.get();
  const auto picture = toPicture(*first->instrument, parameters.display_zoom);
  auto engine = std::make_unique<Engine>(parameters, std::move(hands), std::move(performer),
                                         command_thread_.interlock());
  if (parameters.require_master) {
    const std::string emergency_stop = node_.resolveName("emergency_stop");
    engine->watchMaster({emergency_stop, node_.resolveName("stop")}, {emergency_stop});
  }
  // Those of an earlier launch live on with the ROS master.
  if (const std::string list = unusual(given); !list.empty()) {
    ROS_INFO_STREAM("parameters that are not the default: " << list);
  }
  Answer answer = command_thread_.begin(std::move(engine), first, picture);
  description_.update(command_thread_);
  return answer;
}

}  // namespace ergotic::node
