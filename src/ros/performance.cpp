// SPDX-License-Identifier: BSD-3-Clause
#include "ros/performance.hpp"

#include <algorithm>
#include <utility>

#include <ros/console.h>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ros/model_loader.hpp"

namespace ergotic::node {
namespace {

using CommandType = station::Command::Type;
using EventType = station::Event::Type;
using station::ForceState;

constexpr std::int64_t kStateTimeoutNs = 1'000'000'000;
constexpr std::size_t kGestureBatch = 256;
constexpr double kLogPeriodS = 5.0;
const char kNothingPlays[] = "nothing plays: load a model first";
const char kTooMany[] = "too many requests wait for the real-time thread";

void answer(const Promise& promise, bool ok, std::string message) {
  promise->set_value({ok, std::move(message)});
}

bool forceFlows(ForceState state) {
  return state == ForceState::kEngaging || state == ForceState::kPlaying;
}

bool forceRests(ForceState state) {
  return !forceFlows(state);
}

void log(const Event& event) {
  switch (event.type) {
    case Event::FAULT:
    case Event::TICKS_LOST:
      ROS_ERROR_STREAM("tick " << event.tick << ": " << event.text);
      break;
    case Event::LATE_TICK:
    case Event::STALL:
    case Event::UNDERRUN:
    case Event::AUDIO_SKIPPED:
      ROS_WARN_STREAM_THROTTLE(kLogPeriodS, "tick " << event.tick << ": " << event.text);
      break;
    default:
      ROS_DEBUG_STREAM("tick " << event.tick << ": " << event.text);
  }
}

}  // namespace

void Performance::begin(std::unique_ptr<Engine> engine, station::Performer* performer) {
  {
    const std::lock_guard lock(engine_mutex_);
    engine_ = std::move(engine);
  }
  gestures_.resize(kGestureBatch);
  submitted_ = performer;
  parameters_ = performer->parameters;
  feed_.configure(engine_->parameters());
  play(performer);
  if (engine_->parameters().autoengage) {
    command(CommandType::kEngage);
  }
}

void Performance::swap(std::unique_ptr<station::Performer> performer, const Promise& promise) {
  if (!engine_) {
    return answer(promise, false, kNothingPlays);
  }
  station::Command swap;
  swap.type = CommandType::kSwap;
  swap.performer = performer.get();
  const std::vector<double> parameters = performer->parameters;  // the tick's from now on
  try {
    if (!engine_->station().submit(swap)) {
      return answer(promise, false, kTooMany);
    }
  } catch (const Exception& refusal) {
    return answer(promise, false, refusal.what());
  }
  submitted_ = performer.release();
  parameters_ = parameters;
  incoming_.push_back({submitted_, promise});
}

void Performance::engage(const Promise& promise) {
  if (!engine_) {
    return answer(promise, false, kNothingPlays);
  }
  command(CommandType::kEngage);
  awaitState(&forceFlows, promise);
}

void Performance::stop(const Promise& promise) {
  if (!engine_) {
    return answer(promise, true, "nothing plays");
  }
  command(CommandType::kStop);
  awaitState(&forceRests, promise);
}

void Performance::setParameter(const std::string& name, double value, const Promise& promise) {
  if (!engine_) {
    return answer(promise, false, kNothingPlays);
  }
  const auto& known = submitted_->instrument->scene().parameters;
  const auto found = std::find_if(known.begin(), known.end(), [&name](const auto& parameter) {
    return parameter.name == name;
  });
  if (found == known.end()) {
    return answer(promise, false, "the model has no parameter " + name);
  }
  const auto index = found - known.begin();
  std::vector<double> values = parameters_;
  values[static_cast<std::size_t>(index)] = value;
  try {
    auto coefficients = submitted_->instrument->prepare(values);
    station::Command change;
    change.type = CommandType::kParameter;
    change.index = static_cast<int>(index);
    change.value = value;
    change.coefficients = coefficients.get();
    if (!engine_->station().submit(change)) {
      return answer(promise, false, kTooMany);
    }
    static_cast<void>(coefficients.release());  // comes back with its event
  } catch (const Exception& refusal) {
    return answer(promise, false, refusal.what());
  }
  parameters_ = std::move(values);
  changes_.push_back({name, promise});
}

void Performance::setTarget(int slice, double target_m, const Promise& promise) {
  if (!engine_) {
    return answer(promise, false, kNothingPlays);
  }
  const bool taken = engine_->setTarget(slice, target_m);
  answer(promise, taken, taken ? "" : "no such slice, or the target is not within -0.1...0.1 m");
}

void Performance::command(CommandType type) {
  station::Command command;
  command.type = type;
  if (!engine_->station().submit(command)) {
    ROS_ERROR_STREAM(kTooMany);
  }
}

void Performance::awaitState(StateTest is_met, const Promise& promise) {
  waiters_.push_back({is_met, promise, rt::monotonicNs() + kStateTimeoutNs});
}

void Performance::poll() {
  if (!engine_) {
    return;
  }
  if (feed_.takeNewListener()) {
    command(CommandType::kKeyframe);
  }
  station::Event event;
  while (engine_->station().poll(event)) {
    take(event);
  }
  std::size_t count = 0;
  do {
    count = engine_->station().pollGestures(gestures_.data(), gestures_.size());
    feed_.show(gestures_.data(), count);
  } while (count == gestures_.size());
  if (const station::Snapshot* snapshot = engine_->station().snapshot()) {
    feed_.show(*snapshot);
    answerWaiters(*snapshot);
  }
  if (playing_->motion.refresh()) {
    feed_.show(playing_->motion.latest(), playing_->instrument->scene());
  }
  giveUpWaiters();
  reportWarnings();
}

void Performance::take(const station::Event& event) {
  log(feed_.show(event, &playing_->instrument->scene()));
  if (event.type == EventType::kSwapped) {
    takeSwapped(event);
  } else if (event.type == EventType::kParameter) {
    const std::unique_ptr<physics::Coefficients> old(event.coefficients);
    answer(changes_.front().promise, true, changes_.front().name + " is set");
    changes_.pop_front();
  } else if (event.type == EventType::kKeyframe) {
    takeKeyframe(event);
  }
}

void Performance::takeSwapped(const station::Event& event) {
  const std::unique_ptr<station::Performer> done(event.performer);
  if (event.index == 0) {  // it never played
    const auto lost = std::find_if(incoming_.begin(), incoming_.end(),
                                   [&done](const auto& i) { return i.performer == done.get(); });
    answer(lost->promise, false, "a newer model was loaded meanwhile");
    incoming_.erase(lost);
    return;
  }
  const Incoming next = incoming_.front();
  incoming_.pop_front();
  play(next.performer);
  answer(next.promise, true, feed_.status().message);
}

void Performance::takeKeyframe(const station::Event& event) {
  if (event.index != 0) {
    feed_.show(engine_->station().keyframe(), *playing_->instrument);
  } else {
    ROS_WARN(
        "the state of this model is too large for a keyframe: no recording of it can be "
        "rendered");
  }
}

void Performance::answerWaiters(const station::Snapshot& snapshot) {
  const auto is_done = [this, &snapshot](const Waiter& waiter) {
    const bool met = waiter.is_met(snapshot.state);
    if (met) {
      answer(waiter.promise, true, feed_.status().state_text);
    }
    return met;
  };
  waiters_.erase(std::remove_if(waiters_.begin(), waiters_.end(), is_done), waiters_.end());
}

void Performance::giveUpWaiters() {
  const std::int64_t now_ns = rt::monotonicNs();
  const auto is_over = [this, now_ns](const Waiter& waiter) {
    const bool over = now_ns > waiter.deadline_ns;
    if (over) {
      answer(waiter.promise, false, "not obeyed, the station is: " + feed_.status().state_text);
    }
    return over;
  };
  waiters_.erase(std::remove_if(waiters_.begin(), waiters_.end(), is_over), waiters_.end());
}

void Performance::play(station::Performer* performer) {
  playing_ = performer;
  feed_.showModel(*performer, noteOn(*performer));
  command(CommandType::kKeyframe);
}

void Performance::reportWarnings() {
  for (const std::string& warning : engine_->takeWarnings()) {
    ROS_WARN_STREAM(warning);
    feed_.addMessage(warning);
  }
}

void Performance::close() {
  playing_ = nullptr;
  submitted_ = nullptr;
  incoming_.clear();
  changes_.clear();
  waiters_.clear();
  std::unique_ptr<Engine> closing;
  {
    const std::lock_guard lock(engine_mutex_);
    closing = std::move(engine_);
  }
  if (closing) {
    closing.reset();
    feed_.showSilence("closed");
  }
}

void Performance::makeSafe() {
  const std::lock_guard lock(engine_mutex_);
  if (engine_) {
    engine_->station().makeSafe();
  }
}

}  // namespace ergotic::node
