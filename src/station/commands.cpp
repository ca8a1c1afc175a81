// SPDX-License-Identifier: BSD-3-Clause
// What operators ask of the tick, and the swap that follows from it.
#include <algorithm>
#include <cmath>
#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/station/station.hpp"

namespace ergotic::station {
namespace {

// A storm of commands must not make a tick long.
constexpr int kCommandsPerTick = 16;

// Of a keyframe it is the buffer: until it comes back nobody else may write it.
bool carriesOwnership(Command::Type type) {
  return type == Command::Type::kSwap || type == Command::Type::kParameter ||
         type == Command::Type::kConfigure || type == Command::Type::kKeyframe;
}

bool carriesOwnership(Event::Type type) {
  return type == Event::Type::kSwapped || type == Event::Type::kParameter ||
         type == Event::Type::kConfigured || type == Event::Type::kKeyframe;
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
  if (command.type == Command::Type::kConfigure && command.rig == nullptr) {
    throw Exception("a configuration needs a rig");
  }
  // The event ring keeps `command_ring` places for what is handed back: it can never be lost.
  if (command.type == Command::Type::kKeyframe && keyframe_asked_) {
    return true;
  }
  const bool owes = carriesOwnership(command.type);
  if (owes && owed_ >= config_.command_ring) {
    return false;
  }
  if (commands_.writable() == 0) {
    return false;
  }
  Command stamped = command;
  stamped.asked = command.asked == kAskedNow ? interlock_->ticket() : command.asked;
  commands_.push(stamped);
  owed_ += owes ? 1U : 0U;
  keyframe_asked_ = keyframe_asked_ || command.type == Command::Type::kKeyframe;
  return true;
}

/// Re-arms the driver in the tick and not before: while no tick runs, a device may still have the
/// last force. makeSafe latches the interlock before the driver, so that a concurrent makeSafe
/// either shows in the ticket here, or reaches the driver after `rearm`.
void Station::rearm(Ticket asked) noexcept {
  driver_->rearm();
  if (interlock_->ticket() != asked) {
    driver_->makeSafeInTick();
  }
}

bool Station::poll(Event& event) noexcept {
  if (!events_.pop(event)) {
    return false;
  }
  owed_ -= carriesOwnership(event.type) ? 1U : 0U;
  keyframe_asked_ = keyframe_asked_ && event.type != Event::Type::kKeyframe;
  return true;
}

/// While another thread is at the last tick, nothing may be changed: commands wait, without force.
void Station::drainCommands() noexcept {
  if (!performer_->instrument->finish()) {
    return;
  }
  Command command;
  for (int i = 0; i < kCommandsPerTick && commands_.pop(command); ++i) {
    obey(command);
  }
  for (std::size_t hand = 0; hand < hold_wishes_.size(); ++hand) {
    if (hold_wishes_[hand].refresh()) {
      takeHold(hand, hold_wishes_[hand].latest());
    }
  }
  if (keyframe_wanted_ && mayTakeKeyframe()) {
    keyframe_wanted_ = false;
    takeKeyframe();
  }
}

void Station::obey(const Command& command) noexcept {
  switch (command.type) {
    case Command::Type::kEngage:
      engage(command);
      break;
    case Command::Type::kSwap:
      takeSwap(command);
      break;
    case Command::Type::kParameter:
      takeCoefficients(command);
      break;
    case Command::Type::kConfigure:
      takeRig(command.rig);
      break;
    case Command::Type::kRecover:
      recover(command);
      break;
    case Command::Type::kInject:
      takeInjection(command);
      break;
    case Command::Type::kKeyframe:
      keyframe_wanted_ = true;
      break;
  }
}

void Station::engage(const Command& command) noexcept {
  followInterlock();  // of a stop that came just now: what it takes must not be taken later
  const Interlock::Reading now = interlock_->read();
  if (now.isLatched()) {
    return refuse(command, Refusal::kFault);
  }
  if (now.state == ForceState::kUncalibrated) {
    return refuse(command, Refusal::kUncalibrated);
  }
  if (presence_ticks_ > 0 && !present_) {
    return refuse(command, Refusal::kPresence);
  }
  if (gliding_ > 0) {
    return refuse(command, Refusal::kBusy);
  }
  if (!interlock_->engage(command.asked)) {
    return refuse(command, Refusal::kOutdated);
  }
  if (!now.isOpen()) {   // who has force keeps it: to begin again would be a kick
    chain_.disengage();  // from zero in any case
    chain_.engage();
  }
  engager_ = command.caller;
  Event engaged = event(Event::Type::kEngaged);
  engaged.id = command.id;
  engaged.value = config_.safety.ramp_s;
  tell(engaged);
}

void Station::refuse(const Command& command, Refusal refusal) noexcept {
  Event refused = event(Event::Type::kRefused);
  refused.id = command.id;
  refused.index = static_cast<std::int64_t>(refusal);
  tell(refused);
}

void Station::recover(const Command& command) noexcept {
  const bool anew = blown_up_;
  if (!interlock_->recover(command.asked)) {
    return refuse(command, Refusal::kOutdated);
  }
  rearm(command.asked);
  if (anew) {
    performer_->restart();
    letGo();
    blown_up_ = false;
  }
  inject_ticks_ = 0;
  is_latched_ = false;
  chain_.recover();
  Event recovered = event(Event::Type::kRecovered);
  recovered.id = command.id;
  recovered.index = anew ? 1 : 0;
  tell(recovered);
}

void Station::takeSwap(const Command& command) noexcept {
  if (incoming_ != nullptr) {
    Event superseded = event(Event::Type::kSwapped);
    superseded.performer = incoming_.release();
    handBack(superseded);
  }
  incoming_.reset(command.performer);
  incoming_force_ = static_cast<SwapForce>(command.index);
  incoming_caller_ = command.caller;
}

/// A swap takes the force away for the length of a ramp, which is a kick as a stall is.
bool Station::keepsForce() noexcept {
  const bool may = incoming_force_ == SwapForce::kAlways ||
                   (incoming_force_ == SwapForce::kCaller && incoming_caller_ == engager_);
  return may && !isKickedTooOften();
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
  letGo();
  blown_up_ = false;
  gliding_ = 0;
  fade_.startIn();
  chain_.resume();
  Event swapped = event(Event::Type::kSwapped);
  if (hasForce() && !keepsForce()) {
    stop();
    followInterlock();
    swapped.value = 1.0;
  }
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
  taken.frame = incoming_ != nullptr ? -1 : taken.frame;
  taken.coefficients =
      target.instrument->exchange(std::unique_ptr<physics::Coefficients>(command.coefficients))
          .release();
  handBack(taken);
}

/// Starts the glide of the ports from `glide_`, their former positions, to their present ones.
void Station::glideFromThere() noexcept {
  const std::vector<double>& there = performer_->positions;
  for (std::size_t i = 0; i < there.size(); ++i) {
    glide_[i] -= there[i];
  }
  gliding_ = glide_ticks_;
}

/// Replaces the rig. The ports of the present model glide from their positions under the old rig to
/// those under the new one, so that the model gets no step in position.
void Station::takeRig(tgr::Rig* next) noexcept {
  Event configured = event(Event::Type::kConfigured);
  stop();
  followInterlock();
  if (incoming_ != nullptr) {
    configured.rig = incoming_->rig.release();
    incoming_->rig.reset(next);
    return handBack(configured);
  }
  configured.rig = performer_->rig.release();
  performer_->rig.reset(next);
  std::copy(performer_->positions.begin(), performer_->positions.end(), glide_.begin());
  const double time_s = 1e-9 * tick_ns_ * static_cast<double>(performer_->ticks);
  next->toModel(position_.data(), time_s, performer_->positions.data());
  glideFromThere();
  handBack(configured);
}

void Station::takeInjection(const Command& command) noexcept {
  if (!config_.allow_fault_injection) {
    return;
  }
  if (command.index >= static_cast<int>(InjectedModelFault::kNotANumber)) {
    injected_ = static_cast<InjectedModelFault>(command.index);
    inject_ticks_ = static_cast<std::int64_t>(command.value);
    inject_age_ = 0;
    inject_from_ = position_;
  }
  Event injected = event(Event::Type::kInjected);
  injected.index = command.index;
  injected.value = command.value;
  tell(injected);
}

bool Station::hold(std::size_t hand, const Hold& hold, const Performer* model) noexcept {
  const auto is_finite = [](double place) { return std::isfinite(place); };
  const bool is_valid = hand < holds_.size() &&
                        std::all_of(hold.at.begin(), hold.at.end(), is_finite) &&
                        std::all_of(hold.goal.begin(), hold.goal.end(), is_finite) &&
                        hold.ticks_left >= 0 && hold.ticks_left <= kMaxHoldTicks &&
                        hold.stiffness >= 0.0 && hold.damping >= 0.0 && hold.most_force >= 0.0;
  if (is_valid) {
    hold_wishes_[hand].draft() = {hold, model};
    hold_wishes_[hand].publish();
  }
  return is_valid;
}

void Station::takeHold(std::size_t hand, const HoldWish& wish) noexcept {
  const physics::Instrument& instrument = *performer_->instrument;
  const int mat = wish.hold.mat;
  const bool lets_go = mat == physics::Touch::kNothing;
  const bool is_recorded = wish.model == nullptr;
  if ((!is_recorded && wish.model != performer_.get()) ||
      (!lets_go && (mat < 0 || mat >= instrument.touchables() || !instrument.canTouch(mat)))) {
    return;
  }
  Hold& hold = holds_[hand];
  const Hold before = std::exchange(hold, lets_go ? Hold() : wish.hold);
  if (!lets_go && !is_recorded) {
    const bool goes_on = before.mat == mat;
    hold.takes_hold = !goes_on || before.takes_hold;
    hold.at = goes_on ? before.at : hold.at;
  }
  tellHold(hand);
}

void Station::tellHold(std::size_t index) noexcept {
  Event told = event(Event::Type::kHold);
  told.index = static_cast<std::int64_t>(index);
  told.hold = holds_[index];
  tell(told);
}

/// No keyframe is taken within a fade, as a replay starts at full gain, nor, if the state is large,
/// while there is force, as copying takes long.
bool Station::mayTakeKeyframe() const noexcept {
  const bool is_short = performer_->instrument->stateSize() <= config_.keyframe_bytes_in_force;
  return fade_.isFull() && (is_short || !hasForce());
}

void Station::takeKeyframe() noexcept {
  const physics::Instrument& instrument = *performer_->instrument;
  Event taken = event(Event::Type::kKeyframe);
  // Within the capacities reserved at the start, resizing and assigning do not allocate.
  if (instrument.stateSize() <= keyframe_.state.capacity() &&
      performer_->parameters.size() <= keyframe_.parameters.capacity()) {
    keyframe_.tick = tick_;
    keyframe_.state.resize(instrument.stateSize());
    instrument.saveState(keyframe_.state.data());
    keyframe_.parameters.assign(performer_->parameters.begin(), performer_->parameters.end());
    taken.index = 1;
  }
  handBack(taken);
  for (std::size_t i = 0; i < holds_.size(); ++i) {  // a replay begins with them
    if (holds_[i].mat != physics::Touch::kNothing) {
      tellHold(i);
    }
  }
}

}  // namespace ergotic::station
