// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/station_controller.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <ros/console.h>
#include <ros/this_node.h>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/station/judge_hands.hpp"
#include "files/printable.hpp"
#include "ros/display/handles.hpp"
#include "ros/interface/model_loader.hpp"

namespace ergotic::node {
namespace {

using CommandType = station::Command::Type;
using EventType = station::Event::Type;

constexpr std::int64_t kObeyTimeoutNs = 1'000'000'000;
// From a call to its arrival, where the caller has to find the service first, on a busy machine.
constexpr std::int64_t kOnItsWayNs = 500'000'000;
constexpr std::size_t kGestureBatch = 256;
constexpr std::int64_t kLevelsPeriodNs = 66'000'000;
const char kWasOnItsWay[] =
    "it was on its way when somebody asked for an emergency stop: ask again";
const char kTooMany[] = "too many requests wait for the real-time thread";

/// Number of a node; two names get the same one with a probability of 2^-64.
station::Caller numberOf(const std::string& node) {
  return std::hash<std::string>{}(node);
}

}  // namespace

void StationController::begin(std::unique_ptr<Engine> engine,
                              station::Performer* performer,
                              std::shared_ptr<Picture> picture) {
  {
    const std::lock_guard lock(engine_mutex_);
    engine_ = std::move(engine);
  }
  gestures_.resize(kGestureBatch);
  submitted_ = performer;
  parameters_ = performer->parameters;
  gesture_values_ = engine_->station().driver().gestureValues();
  next_value_ = 0;
  publishers_.configure(engine_->parameters(), engine_->hands());
  place(endEffectors());
  play(performer, std::move(picture), false);
  if (engine_->parameters().autoengage) {
    engage({{rt::monotonicNs(), began_}, ::ros::this_node::getName()},
           std::make_shared<std::promise<Answer>>());
  }
}

void StationController::swap(std::unique_ptr<station::Performer> performer,
                             const Swap& with,
                             const Promise& promise) {
  if (!engine_) {
    return answer(promise, false, kNothingPlays);
  }
  station::Command swap;
  swap.type = CommandType::kSwap;
  swap.performer = performer.get();
  const bool waits = with.end_effectors && engine_->hands().canHurt();
  swap.index =
      static_cast<int>(waits ? station::SwapForce::kNever : engine_->parameters().force_after_swap);
  swap.caller = numberOf(with.loader);
  const std::vector<double> parameters = performer->parameters;  // the tick's from now on
  try {
    requireNoneComing();
    // End-effectors may have changed while the model was made.
    const Hands& hands = engine_->hands();
    station::giveHands(*performer, with.end_effectors.value_or(endEffectors()), hands.slices(),
                       hands.traits());
    if (!engine_->station().submit(swap)) {
      return answer(promise, false, kTooMany);
    }
  } catch (const Exception& refusal) {
    return answer(promise, false, refusal.what());
  }
  const PresetValues kept = with.is_again ? changedValues() : PresetValues();
  submitted_ = performer.release();
  parameters_ = parameters;
  forgetChanges();
  incoming_.push_back({submitted_, with, promise, bringBack(kept)});
}

void StationController::engage(const ForceRequest& request, const Promise& promise) {
  if (guide_.isUnderWay()) {
    return answer(promise, false, "a slice is being calibrated: finish or abort first");
  }
  if (const auto slice = engine_ ? engine_->hands().uncheckedSlice() : std::nullopt) {
    return answer(
        promise, false,
        "slice " + std::to_string(*slice) +
            " was not checked since it was calibrated: rosrun ergotic calibrate check --slice " +
            std::to_string(*slice) + ", hands off");
  }
  if (const auto breach = own_host_.breach()) {
    ROS_ERROR_STREAM("engage: " << *breach);
    return answer(promise, false, *breach);
  }
  this->request(CommandType::kEngage, request, promise);
}

void StationController::recover(const ForceRequest& request, const Promise& promise) {
  if (request.arrival.time_ns < emergency_ns_ + kOnItsWayNs) {
    return answer(promise, false, kWasOnItsWay);
  }
  if (engine_) {
    try {
      engine_->recover();
    } catch (const Exception& failure) {
      return answer(promise, false, failure.what());
    }
  }
  this->request(CommandType::kRecover, request, promise);
}

void StationController::setParameter(const std::string& name,
                                     double value,
                                     const Promise& promise) {
  if (!engine_) {
    return answer(promise, false, kNothingPlays);
  }
  const auto& known = submitted_->instrument->scene().parameters;
  const auto found = std::find_if(known.begin(), known.end(), [&name](const auto& parameter) {
    return parameter.name == name;
  });
  if (found == known.end()) {
    return answer(promise, false, unknownParameter(name, submitted_->instrument->scene()));
  }
  const auto index = static_cast<std::size_t>(found - known.begin());
  try {
    if (!set(index, value, {name + " is set", promise})) {
      answer(promise, false, kTooMany);
    }
  } catch (const Exception& refusal) {
    answer(promise, false, refusal.what());
  }
}

bool StationController::command(CommandType type, int index, double value) {
  station::Command command;
  command.type = type;
  command.index = index;
  command.value = value;
  return submit(command);
}

bool StationController::submit(const station::Command& command) {
  const bool taken = engine_->station().submit(command);
  if (!taken) {
    ROS_ERROR_STREAM(kTooMany);
  }
  return taken;
}

void StationController::request(CommandType type,
                                const ForceRequest& request,
                                const Promise& promise) {
  if (!engine_) {
    return answer(promise, false, kNothingPlays);
  }
  station::Command command;
  command.type = type;
  command.id = ++last_request_;
  command.asked = request.arrival.ticket;
  command.caller = numberOf(request.caller);
  if (!submit(command)) {
    return answer(promise, false, kTooMany);
  }
  requests_[command.id] = {request.caller, promise, rt::monotonicNs() + kObeyTimeoutNs};
}

void StationController::poll() {
  if (!engine_) {
    return;
  }
  if (publishers_.takeNewListener()) {
    command(CommandType::kKeyframe);
  }
  station::Event event;
  while (engine_->station().poll(event)) {
    take(event);
  }
  pollGestures();
  if (const station::Snapshot* snapshot = engine_->station().snapshot()) {
    publishers_.show(*snapshot, engine_->station().driver().uncalibrated());
  }
  if (engine_->standsStill()) {
    publishers_.showStandstill();
  }
  takes_.poll(picture_);
  pollGestureValues();
  pollMorph();
  if (playing_->motion.refresh() && !takes_.isShown()) {
    publishers_.show(playing_->motion.latest(), playing_->instrument->scene());
  }
  pollCalibration();
  pollLevels();
  pollScope();
  giveUp();
  reportWarnings();
  if (const std::string counted = disturbances_.ofLastMinute(rt::monotonicNs()); !counted.empty()) {
    ROS_WARN_STREAM(counted);
  }
}

void StationController::pollGestures() {
  std::size_t count = 0;
  do {
    count = engine_->station().pollGestures(gestures_.data(), gestures_.size());
    publishers_.show(gestures_.data(), count);
  } while (count == gestures_.size());
}

std::string StationController::setVolume(double volume) {
  if (!(volume >= 0.0 && volume <= 1.0)) {
    return "volume is " + std::to_string(volume) + ", allowed: 0...1";
  }
  if (!engine_ || engine_->bridge() == nullptr) {
    return engine_ ? "there is no sound to set a volume of: jack is none" : kNothingPlays;
  }
  engine_->bridge()->setVolume(static_cast<float>(volume));
  return "";
}

/// Output channels of the scene that plays, from 0.
std::set<int> StationController::usedChannels() const {
  std::set<int> channels;
  for (const scene::Output& output : playing_->instrument->scene().outputs) {
    if (output.channel >= 0) {
      channels.insert(output.channel);
    }
  }
  return channels;
}

/// Publishes the scope. The sound is copied for it only while the topic has subscribers.
void StationController::pollScope() {
  station::AudioBridge* const bridge = engine_->bridge();
  if (bridge == nullptr) {
    return;
  }
  bridge->scope().watch(publishers_.wantsScope());
  const std::int64_t now_ns = rt::monotonicNs();
  if (!publishers_.wantsScope() || now_ns < scope_due_ns_ || !bridge->scope().refresh()) {
    return;
  }
  scope_due_ns_ = now_ns + kLevelsPeriodNs;
  constexpr auto kFrames = static_cast<std::ptrdiff_t>(station::OutputScope::kFrames);
  const std::vector<float>& block = bridge->scope().latest();
  Scope scope;
  scope.rate = playing_->instrument->rates().audio_hz;
  for (const int channel : usedChannels()) {
    const auto first = block.begin() + kFrames * channel;
    if (block.end() - first >= kFrames) {
      scope.channels.push_back(static_cast<std::uint32_t>(channel) + 1);
      scope.samples.insert(scope.samples.end(), first, first + kFrames);
    }
  }
  publishers_.show(std::move(scope));
}

void StationController::pollLevels() {
  station::AudioBridge* const bridge = engine_->bridge();
  const std::int64_t now_ns = rt::monotonicNs();
  if (bridge == nullptr || !publishers_.wantsLevels() || now_ns < levels_due_ns_) {
    return;
  }
  levels_due_ns_ = now_ns + kLevelsPeriodNs;
  Levels levels;
  const std::vector<float> peaks = bridge->takePeaks();
  for (const int channel : usedChannels()) {
    if (static_cast<std::size_t>(channel) < peaks.size()) {
      levels.channels.push_back(static_cast<std::uint32_t>(channel) + 1);
      levels.peaks.push_back(peaks[static_cast<std::size_t>(channel)]);
    }
  }
  levels.volume = bridge->volume();
  const std::int64_t limited = bridge->loudness().limited_frames;
  levels.limited = limited != limited_frames_ ? 1U : 0U;
  limited_frames_ = limited;
  publishers_.show(std::move(levels));
}

void StationController::take(const station::Event& event) {
  if (event.type == EventType::kHold) {
    return publishers_.showHold(event, playing_->instrument->scene());
  }
  const Event told = publishers_.show(event, &playing_->instrument->scene());
  log(told);
  switch (event.type) {
    case EventType::kSwapped:
      return takeSwapped(event);
    case EventType::kParameter: {
      const std::unique_ptr<physics::Coefficients> old(event.coefficients);
      if (incoming_.empty()) {  // else it is of one that does not play yet
        publishers_.showParameter(event.index, event.value);
      }
      answer(changes_.front().promise, true, changes_.front().done);
      return changes_.pop_front();
    }
    case EventType::kConfigured:
      return takeConfigured(event);
    case EventType::kAudioStopped:  // with JACK, notes that end are not heard
      return releaseKeys();
    case EventType::kKeyframe:
      return takeKeyframe(event);
    default:
      return takeObeyed(event, told.text);
  }
}

void StationController::log(const Event& event) {
  const std::string text = "tick " + std::to_string(event.tick) + ": " + event.text;
  if (event.type == Event::FAULT || event.type == Event::TICKS_LOST) {
    ROS_ERROR_STREAM(text);
  } else if (!Disturbances::isOne(event)) {
    ROS_DEBUG_STREAM(text);
  } else if (disturbances_.isFirst(event)) {
    ROS_WARN_STREAM(text << " (further ones are counted once a minute)");
  }
}

std::string StationController::whatPlays(bool force_waits) const {
  return answerOn(playing_->instrument->scene().name, publishers_.status().message, force_waits);
}

void StationController::takeObeyed(const station::Event& event, const std::string& text) {
  const auto waiter = requests_.find(event.id);
  if (waiter == requests_.end()) {
    return;
  }
  if (event.type == EventType::kEngaged) {
    ROS_INFO_STREAM("force was let out by " << waiter->second.caller);
  }
  answer(waiter->second.promise, event.type != EventType::kRefused, text);
  requests_.erase(waiter);
}

void StationController::takeSwapped(const station::Event& event) {
  const std::unique_ptr<station::Performer> done(event.performer);
  if (event.index == 0) {  // it never played
    const auto lost = std::find_if(incoming_.begin(), incoming_.end(),
                                   [&done](const auto& i) { return i.performer == done.get(); });
    answer(lost->promise, false, "a newer model was loaded meanwhile");
    incoming_.erase(lost);
    return;
  }
  Incoming next = std::move(incoming_.front());
  incoming_.pop_front();
  if (next.with.end_effectors) {
    place(*next.with.end_effectors);
  }
  play(next.performer, std::move(next.with.picture), next.with.is_again);
  answer(next.promise, true,
         whatPlays(!interlock_->read().isOpen()) +
             (next.left_out.empty() ? "" : "\nnot as they were: " + next.left_out));
}

void StationController::takeKeyframe(const station::Event& event) {
  if (event.index != 0) {
    publishers_.show(engine_->station().keyframe(), *playing_->instrument);
  } else {
    ROS_WARN(
        "the state of this model is too large for a keyframe: no recording of it can be "
        "rendered");
  }
}

/// Withdraws requests whose deadline has passed, so that none brings force that nobody expects.
void StationController::giveUp() {
  const std::int64_t now_ns = rt::monotonicNs();
  while (!requests_.empty() && now_ns > requests_.begin()->second.deadline_ns) {
    interlock_->stop();
    answer(requests_.begin()->second.promise, false,
           "not obeyed and withdrawn, the station is: " + publishers_.status().state_text);
    requests_.erase(requests_.begin());
  }
}

void StationController::play(station::Performer* performer,
                             std::shared_ptr<Picture> picture,
                             bool is_again) {
  playing_ = performer;
  std::vector<double> values = parameters_;
  if (performer != submitted_) {  // nobody could change it before it is replaced
    values.clear();
    for (const scene::Parameter& parameter : performer->instrument->scene().parameters) {
      values.push_back(parameter.value);
    }
  }
  takes_.halt();
  picture_ = std::move(picture);
  publishers_.showModel(*performer, picture_, noteAbout(*performer), values);
  const scene::Scene& scene = performer->instrument->scene();
  holders_.play(performer, modulesToHold(), performer->instrument->rates().gesturalHz());
  showHandles();
  showPresets();
  findPlayMap(scene, is_again);
  command(CommandType::kKeyframe);
}

void StationController::reportWarnings() {
  for (const std::string& warning : engine_->takeWarnings()) {
    ROS_WARN_STREAM(warning);
    publishers_.addMessage(warning);
  }
}

void StationController::take(const Take::Request& request,
                             const std::shared_ptr<std::string>& path,
                             const Promise& promise) {
  if (!engine_) {
    return answer(promise, false, kNothingPlays);
  }
  Answer outcome{false, "action is " + std::to_string(request.action) + ", allowed: 0...7"};
  switch (request.action) {
    case Take::Request::RECORD:
      outcome = takes_.record(request.name, playing_->instrument->scene().name);
      if (outcome.ok) {
        command(CommandType::kKeyframe);
      }
      break;
    case Take::Request::FINISH:
      takes_.finish(promise);
      *path = takes_.path();
      return;
    case Take::Request::REPLAY:
      takes_.replay(request.name, engine_->bridge(), engine_->station().config().rates.audio_hz,
                    engine_->parameters().display_zoom, promise);
      *path = takes_.path();
      return;
    case Take::Request::HALT:
      outcome = takes_.halt();
      break;
    case Take::Request::RENAME:
    case Take::Request::STAR:
    case Take::Request::UNSTAR:
    case Take::Request::DELETE:
      outcome = takes_.change(request);
      break;
    default:
      break;
  }
  *path = takes_.path();
  answer(promise, outcome.ok, outcome.message);
}

void StationController::close() {
  playing_ = nullptr;
  submitted_ = nullptr;
  incoming_.clear();
  changes_.clear();
  forgetChanges();
  configurations_.clear();
  requests_.clear();
  guide_.abort();
  sampled_.reset();
  check_ = {};
  std::unique_ptr<Engine> closing;
  {
    const std::lock_guard lock(engine_mutex_);
    closing = std::move(engine_);
  }
  if (closing) {
    closing.reset();
    publishers_.showSilence("closed");
    preset_topic_.showNothing();
  }
  takes_.close();  // after the device is: a disk may take its time
  picture_.reset();
}

void StationController::tellPresence(bool is_held) {
  const std::lock_guard lock(engine_mutex_);
  if (engine_) {
    engine_->station().tellPresence(is_held);
  }
}

bool StationController::makeSafe(tgr::FaultReason reason) {
  if (reason == tgr::FaultReason::kEmergencyStop) {
    emergency_ns_ = rt::monotonicNs();
  }
  interlock_->latch(reason);
  const std::lock_guard lock(engine_mutex_);
  if (engine_) {
    engine_->station().makeSafe(reason);
  }
  return engine_ != nullptr;
}

}  // namespace ergotic::node
