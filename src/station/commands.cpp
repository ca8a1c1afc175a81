// SPDX-License-Identifier: BSD-3-Clause
// What operators ask of the tick, and the swap that follows from it.
#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/station/station.hpp"

namespace ergotic::station {
namespace {

// A storm of commands must not make a tick long.
constexpr int kCommandsPerTick = 16;

bool carriesOwnership(Command::Type type) {
  return type == Command::Type::kSwap || type == Command::Type::kParameter;
}

bool carriesOwnership(Event::Type type) {
  return type == Event::Type::kSwapped || type == Event::Type::kParameter;
}

}  // namespace

bool Station::submit(const Command& command) {
  if (command.type == Command::Type::kSwap) {
    if (command.performer == nullptr) {
      throw Exception("a swap needs a performer");
    }
    checkFits(*command.performer);
  }
  if (command.type == Command::Type::kParameter && command.coefficients == nullptr) {
    throw Exception("a parameter change needs coefficients");
  }
  // The event ring keeps `command_ring` places for what is handed back: it can never be lost.
  const bool owes = carriesOwnership(command.type);
  if (owes && owed_ >= config_.command_ring) {
    return false;
  }
  if (command.type == Command::Type::kEngage) {
    driver_->rearm();
  }
  if (!commands_.push(command)) {
    return false;
  }
  owed_ += owes ? 1U : 0U;
  return true;
}

bool Station::poll(Event& event) noexcept {
  if (!events_.pop(event)) {
    return false;
  }
  owed_ -= carriesOwnership(event.type) ? 1U : 0U;
  return true;
}

void Station::drainCommands() noexcept {
  Command command;
  for (int i = 0; i < kCommandsPerTick && commands_.pop(command); ++i) {
    obey(command);
  }
  // Not within a fade: a replay starts at full gain.
  for (; keyframes_wanted_ > 0 && fade_.isFull(); --keyframes_wanted_) {
    takeKeyframe();
  }
}

void Station::obey(const Command& command) noexcept {
  switch (command.type) {
    case Command::Type::kEngage:
      engage();
      break;
    case Command::Type::kStop:
      stop();
      break;
    case Command::Type::kSwap:
      takeSwap(command.performer);
      break;
    case Command::Type::kParameter:
      takeCoefficients(command);
      break;
    case Command::Type::kConfigure:
    case Command::Type::kRecover:
    case Command::Type::kEmergencyStop:
    case Command::Type::kPresence:
    case Command::Type::kInject:
      break;
    case Command::Type::kKeyframe:
      ++keyframes_wanted_;
      break;
  }
}

void Station::engage() noexcept {
  if (blown_up_) {
    state_ = ForceState::kReady;  // the refusal is told each time
    fault(FaultReason::kModelBlowUp, -1);
    return;
  }
  // From zero in any case: the driver may have been made safe and re-armed within one tick.
  chain_.recover();
  chain_.engage();
  state_ = ForceState::kEngaging;
  fault_ = FaultReason::kNone;
  Event engaged = event(Event::Type::kEngaged);
  engaged.value = config_.safety.ramp_s;
  tell(engaged);
}

void Station::stop() noexcept {
  chain_.disengage();
  force_.fill(0.0);
  if (state_ != ForceState::kFault) {
    state_ = ForceState::kReady;
  }
  tell(event(Event::Type::kStopped));
}

void Station::takeSwap(Performer* next) noexcept {
  if (incoming_ != nullptr) {
    Event superseded = event(Event::Type::kSwapped);
    superseded.performer = incoming_.release();
    handBack(superseded);
  }
  incoming_.reset(next);
}

/// A swap waits for the fade-out of the old performer, which itself waits for the end of the
/// fade-in of an earlier swap.
void Station::advanceSwap() noexcept {
  if (incoming_ == nullptr) {
    return;
  }
  if (fade_.isFull()) {
    fade_.startOut();
    return;
  }
  if (!fade_.isSilent()) {
    return;
  }
  performer_.swap(incoming_);
  blown_up_ = false;
  fade_.startIn();
  chain_.resume();
  Event swapped = event(Event::Type::kSwapped);
  swapped.performer = incoming_.release();
  swapped.index = 1;
  handBack(swapped);
}

void Station::takeCoefficients(const Command& command) noexcept {
  Performer& target = incoming_ != nullptr ? *incoming_ : *performer_;
  const auto index = static_cast<std::size_t>(command.index);
  if (command.index >= 0 && index < target.parameters.size()) {
    target.parameters[index] = command.value;
  }
  Event taken = event(Event::Type::kParameter);
  taken.index = command.index;
  taken.value = command.value;
  taken.coefficients =
      target.instrument->exchange(std::unique_ptr<physics::Coefficients>(command.coefficients))
          .release();
  handBack(taken);
}

void Station::takeKeyframe() noexcept {
  const physics::Instrument& instrument = *performer_->instrument;
  Event taken = event(Event::Type::kKeyframe);
  // Within the capacities reserved at the start, resizing and assigning do not allocate.
  if (!instrument.isUnderWay() && instrument.stateSize() <= keyframe_.state.capacity() &&
      performer_->parameters.size() <= keyframe_.parameters.capacity()) {
    keyframe_.tick = tick_;
    keyframe_.state.resize(instrument.stateSize());
    instrument.saveState(keyframe_.state.data());
    keyframe_.parameters.assign(performer_->parameters.begin(), performer_->parameters.end());
    taken.index = 1;
  }
  tell(taken);
}

}  // namespace ergotic::station
