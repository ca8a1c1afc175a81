// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/station.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"

namespace ergotic::station {
namespace {

constexpr double kSwapFadeS = 0.005;
constexpr std::int64_t kLookInsideTicks = 50;  // a replay must look at the same ticks
constexpr double kMaxOfModel = 1e9;  // N, or full scales: a model that gives more has blown up
constexpr std::size_t kMaxKeyframeParameters = 1U << 12U;
constexpr std::int64_t kWhenever = std::numeric_limits<std::int64_t>::max();

/// False for what is not a number, too.
bool isWithinSanityLimit(double value) noexcept {
  return std::abs(value) <= kMaxOfModel;
}

void checkRange(const char* what, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw Exception(std::string(what) + " is " + std::to_string(value) + ", allowed " +
                    std::to_string(low) + "..." + std::to_string(high));
  }
}

const StationConfig& checked(const StationConfig& config) {
  checkRange("audio rate (Hz)", config.rates.audio_hz, 8000.0, 192000.0);
  checkRange("frames per tick", config.rates.ratio, 1, physics::kMaxRatio);
  checkRange("output channels", config.output_channels, 1, 256);
  checkRange("input channels", config.input_channels, 0, 256);
  checkRange("max_stall (s)", config.max_stall_s, 0.001, 1.0);
  checkRange("max_stalls", config.max_stalls, 1, 1e6);
  checkRange("display rate (Hz)", config.display_hz, 1.0, 1000.0);
  checkRange("presence (s)", config.presence_s, 0.0, 10.0);
  checkRange("glide (s)", config.glide_s, 0.001, 10.0);
  checkRange("first tick", static_cast<double>(config.first_tick), 0.0, 1e15);
  return config;
}

int openDriver(tgr::Driver& driver, double tick_rate_hz) {
  driver.open(tick_rate_hz);
  return driver.slices();
}

tgr::SafetyConfig safetyOf(const StationConfig& config, const tgr::Driver& driver) {
  tgr::SafetyConfig safety = config.safety;
  safety.slice_damping = trustedDamping(driver.declaredDamping());
  return safety;
}

std::int64_t atLeastOne(double value) {
  return std::max<std::int64_t>(1, std::llround(value));
}

std::uint64_t allSlices(int slices) {
  return ~std::uint64_t{0} >> static_cast<unsigned>(tgr::kMaxSlices - slices);
}

int lowestBit(std::uint64_t bits) {
  int bit = 0;
  while ((bits & 1U) == 0 && bit < tgr::kMaxSlices) {
    bits >>= 1U;
    ++bit;
  }
  return bit;
}

std::size_t samples(int frames, int channels) {
  return static_cast<std::size_t>(frames) * static_cast<std::size_t>(channels);
}

}  // namespace

double trustedDamping(double declared) noexcept {
  constexpr double kShare = 0.5;
  constexpr double kMax = 100.0;
  return std::min(kShare * declared, kMax);
}

Station::Station(const StationConfig& config,
                 std::unique_ptr<tgr::Driver> driver,
                 std::unique_ptr<Performer> performer,
                 std::shared_ptr<Interlock> interlock)
    : config_(checked(config)),
      tick_ns_(1e9 / config.rates.gesturalHz()),
      max_catch_up_(atLeastOne(config.max_stall_s * config.rates.gesturalHz())),
      display_ticks_(atLeastOne(config.rates.gesturalHz() / config.display_hz)),
      driver_(std::move(driver)),
      slices_(openDriver(*driver_, config.rates.gesturalHz())),
      interlock_(std::move(interlock)),
      glide_ticks_(atLeastOne(config.glide_s * config.rates.gesturalHz())),
      presence_ticks_(
          config.presence_s > 0.0 ? atLeastOne(config.presence_s * config.rates.gesturalHz()) : 0),
      chain_(safetyOf(config, *driver_), slices_, 1e-9 * tick_ns_, driver_->extraDelayTicks()),
      fade_(static_cast<int>(std::ceil(kSwapFadeS * config.rates.gesturalHz())),
            config.rates.ratio),
      performer_(std::move(performer)),
      uncalibrated_(driver_->uncalibrated()),
      tick_(config.first_tick),
      frames_out_(samples(config.rates.ratio, config.output_channels)),
      frames_in_(samples(config.rates.ratio, config.input_channels)),
      commands_(config.command_ring),
      events_(config.event_ring + config.command_ring),
      gestures_(config.record_ring) {
  checkFits(*performer_);
  keyframe_.state.reserve(config.keyframe_bytes);
  keyframe_.parameters.reserve(kMaxKeyframeParameters);
}

Station::~Station() {
  driver_->close();
  Command command;
  while (commands_.pop(command)) {
    std::unique_ptr<Performer> performer(command.performer);
    std::unique_ptr<physics::Coefficients> coefficients(command.coefficients);
    std::unique_ptr<tgr::Rig> rig(command.rig);
  }
  Event event;
  while (events_.pop(event)) {
    std::unique_ptr<Performer> performer(event.performer);
    std::unique_ptr<physics::Coefficients> coefficients(event.coefficients);
    std::unique_ptr<tgr::Rig> rig(event.rig);
  }
}

void Station::checkFits(const Performer& performer) const {
  const physics::Rates& rates = performer.instrument->rates();
  if (rates.ratio != config_.rates.ratio || rates.audio_hz != config_.rates.audio_hz) {
    throw Exception("the model is compiled for " + std::to_string(rates.audio_hz) + " Hz, " +
                    std::to_string(rates.ratio) + " frames per tick; the station runs at " +
                    std::to_string(config_.rates.audio_hz) + " Hz, " +
                    std::to_string(config_.rates.ratio));
  }
  const std::uint64_t beyond = performer.rig->slicesInUse() & ~allSlices(slices_);
  if (beyond != 0) {
    throw Exception("the end-effectors need slice " + std::to_string(lowestBit(beyond)) +
                    ", the device has 0..." + std::to_string(slices_ - 1));
  }
}

void Station::cycle(const Timing& timing) noexcept {
  heartbeat_.fetch_add(1, std::memory_order_relaxed);
  const std::int64_t begin = rt::monotonicNs();
  followInterlock();
  moveHands(0, kWhenever);
  Slices positions{};
  const std::uint32_t met = driver_->exchange(force_.data(), positions.data());
  const std::int64_t exchanged = rt::monotonicNs();
  const std::uint32_t flags = accept(positions, met, 0);
  runTick(positions, flags);
  classify(timing, exchanged - begin, rt::monotonicNs() - exchanged);
}

void Station::catchUp(std::int64_t ticks, std::int64_t stall_ns) noexcept {
  if (ticks < 1) {
    return;
  }
  heartbeat_.fetch_add(1, std::memory_order_relaxed);
  const std::int64_t run = std::min(ticks, max_catch_up_);
  const double stall_s = 1e-9 * static_cast<double>(stall_ns);
  if (meter_ != nullptr) {
    meter_->wake_up.add(stall_ns);
  }
  if (driver_->isSteppedByExchange() && !driver_->canHurt()) {
    noteStall(run, ticks - run, stall_s);
    runWithExchanges(run);
    return;
  }
  moveHands(ticks - 1, kWhenever);
  force_.fill(0.0);
  Slices target{};
  const std::uint32_t met = driver_->exchange(force_.data(), target.data());
  const std::uint32_t flags = accept(target, met, ticks - 1) | GestureTick::kCatchUp;
  noteStall(run, ticks - run, stall_s);
  runInterpolated(run, target, flags);
}

/// \param run  ticks that are caught up \param lost  those before them, which are not
void Station::noteStall(std::int64_t run, std::int64_t lost, double stall_s) noexcept {
  Event stalled = event(Event::Type::kStall);
  stalled.index = run;
  stalled.value = stall_s;
  tell(stalled);
  ++counters_.stalls;
  counters_.catch_up_ticks += run;
  if (lost > 0) {
    Event told = event(Event::Type::kTicksLost);
    told.index = lost;
    tell(told);
    counters_.lost_ticks += lost;
    skip(lost);
    if (!interlock_->read().isLatched()) {
      stall_s_ = stall_s;
      stalls_borne_ = 0;
    }
    fault(FaultReason::kStall, -1);
  }
  kick(stall_s);
}

/// A device that is stepped by its exchanges has stood still with the ticks. Each tick hears of the
/// moves that were asked for before its time.
void Station::runWithExchanges(std::int64_t ticks) noexcept {
  const std::int64_t now_ns = rt::monotonicNs();
  for (std::int64_t left = ticks - 1; left >= 0; --left) {
    followInterlock();
    moveHands(0, now_ns - static_cast<std::int64_t>(static_cast<double>(left) * tick_ns_));
    Slices positions{};
    const std::uint32_t met = driver_->exchange(force_.data(), positions.data());
    const std::uint32_t flags = accept(positions, met, 0);
    runTick(positions, flags);
  }
}

void Station::runInterpolated(std::int64_t ticks,
                              const Slices& target,
                              std::uint32_t flags) noexcept {
  chain_.resume();
  const Slices origin = position_;
  for (std::int64_t i = 1; i < ticks; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(ticks);
    Slices between{};
    for (std::size_t s = 0; s < static_cast<std::size_t>(slices_); ++s) {
      between[s] = origin[s] + part * (target[s] - origin[s]);
    }
    runTick(between, flags);
  }
  runTick(target, flags);
}

bool Station::move(const tgr::HandMove& move, double due_tick) noexcept {
  return move.isValid(slices_) && driver_->hasHand(move.slice) &&
         moves_.push({move, due_tick, rt::monotonicNs()});
}

/// A move that is due at a tick is so much later than the tick of this exchange, whenever it was
/// asked for. \param missed  ticks between the last one that ran and the tick of this exchange
/// \param asked_until_ns  moves that are due at once wait for a later tick if they were asked for
/// later
void Station::moveHands(std::int64_t missed, std::int64_t asked_until_ns) noexcept {
  for (std::size_t i = 0; i < kWaitingMoves; ++i) {
    const DueMove* next = moves_.front();
    if (next == nullptr) {
      return;
    }
    const bool is_due_at_a_tick = !std::isnan(next->due_tick);
    if (!is_due_at_a_tick && next->asked_ns > asked_until_ns) {
      return;
    }
    tgr::HandMove move = next->move;
    if (is_due_at_a_tick) {
      const double ticks = next->due_tick - static_cast<double>(tick_ + missed);
      move.time_s = tgr::HandMove::kOnArrival;
      move.delay_s = 1e-9 * tick_ns_ * std::max(ticks, 0.0);
    }
    driver_->move(move);
    DueMove taken;
    moves_.pop(taken);
  }
}

void Station::rest() noexcept {
  stop();
  followInterlock();
  present_ = false;
  Slices positions{};
  driver_->exchange(force_.data(), positions.data());
}

/// The interlock first: a recovery under way then sees that it came too late, and latches the
/// driver again if it had set it free before.
void Station::makeSafe(FaultReason reason) noexcept {
  interlock_->latch(reason);
  driver_->makeSafe();
}

std::uint32_t Station::accept(Slices& positions,
                              std::uint32_t exchange_flags,
                              std::int64_t host_missed) noexcept {
  if (driver_->uncalibrated() != uncalibrated_) {
    followCalibration();  // what is away while another calibration comes has not jumped
  }
  const std::uint64_t held = chain_.validate(positions.data(), exchange_flags, host_missed);
  followInterlock();
  if ((exchange_flags & tgr::kMadeSafe) != 0) {
    fault(FaultReason::kMadeSafe, -1);
  } else if (chain_.fault() != FaultReason::kNone) {
    fault(chain_.fault(), chain_.faultSlice());
  }
  return held != 0 ? GestureTick::kHeld : 0U;
}

void Station::runTick(const Slices& positions, std::uint32_t flags) noexcept {
  advanceSwap();
  followPresence();
  drainCommands();
  if (pullInputs()) {
    flags |= GestureTick::kAudioInput;
  }
  movePorts(positions);
  tickInstrument();
  pushFrames();
  updateForces((flags & GestureTick::kCatchUp) != 0);
  if (!(chain_.gain() > 0.0)) {
    flags |= GestureTick::kNoForce;
  }
  record(positions, flags);
  relayAudioEvents();
  fade_.advance();
  if (tick_ % display_ticks_ == 0) {
    publish();
  }
  ++tick_;
  ++counters_.ticks;
}

/// A sample that is not finite becomes 0. \return true if live sound entered the instrument
bool Station::pullInputs() noexcept {
  const int model_channels = performer_->instrument->inputChannels();
  if (model_channels == 0) {
    return false;
  }
  const int ratio = config_.rates.ratio;
  const bool sound = frame_port_ != nullptr && config_.input_channels > 0 &&
                     frame_port_->pull(tick_ * ratio, frames_in_.data(), ratio);
  std::fill(performer_->inputs.begin(), performer_->inputs.end(), 0.0);
  if (!sound) {
    return false;
  }
  const int shared = std::min(model_channels, config_.input_channels);
  for (int r = 0; r < ratio; ++r) {
    const float* from = frames_in_.data() + samples(r, config_.input_channels);
    double* to = performer_->inputs.data() + samples(r, model_channels);
    for (int c = 0; c < shared; ++c) {
      const bool is_finite = std::isfinite(from[c]);
      to[c] = is_finite ? static_cast<double>(from[c]) : 0.0;
      counters_.bad_input_samples += is_finite ? 0 : 1;
    }
  }
  return true;
}

void Station::movePorts(const Slices& positions) noexcept {
  for (std::size_t s = 0; s < static_cast<std::size_t>(slices_); ++s) {
    velocity_[s] = (positions[s] - position_[s]) * config_.rates.gesturalHz();
  }
  position_ = positions;
  Performer& p = *performer_;
  const double time_s = 1e-9 * tick_ns_ * static_cast<double>(p.ticks++);
  const std::uint64_t uncalibrated = driver_->uncalibrated();
  const std::uint64_t changed = std::exchange(uncalibrated_, uncalibrated) ^ uncalibrated;
  const bool other_scale = (changed & p.rig->slicesInUse()) != 0;
  if (other_scale) {
    std::copy(p.positions.begin(), p.positions.end(), glide_.begin());
  }
  const std::uint64_t beyond = p.rig->toModel(positions.data(), time_s, p.positions.data());
  if (other_scale) {
    glideFromThere();
  }
  if (beyond != 0) {
    fault(FaultReason::kWorkspace, lowestBit(beyond));
  }
  if (gliding_ > 0) {
    const double left = static_cast<double>(--gliding_) / static_cast<double>(glide_ticks_);
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
      p.positions[i] += left * glide_[i];
    }
    if (gliding_ == 0) {
      chain_.resume();
    }
  }
}

/// Moves each hold by one tick towards its goal; a hold that attaches in this tick does not move
/// yet.
void Station::moveHolds() noexcept {
  for (std::size_t i = 0; i < holds_.size(); ++i) {
    Hold& hold = holds_[i];
    physics::Touch& touch = touches_[i];
    touch.mat = hold.mat;
    touch.takes_hold = hold.takes_hold;
    touch.from = hold.at;
    touch.to = hold.at;
    touch.stiffness = hold.stiffness;
    touch.damping = hold.damping;
    touch.most_force = hold.most_force;
    if (!hold.takes_hold && hold.ticks_left > 0) {
      const double part = 1.0 / hold.ticks_left;
      for (std::size_t k = 0; k < hold.at.size(); ++k) {
        touch.to[k] = hold.at[k] + part * (hold.goal[k] - hold.at[k]);
      }
      --hold.ticks_left;
    }
  }
}

void Station::letGo() noexcept {
  holds_ = Holds();
  touches_ = {};
}

void Station::tickInstrument() noexcept {
  if (blown_up_) {
    return;
  }
  Performer& p = *performer_;
  moveHolds();
  p.instrument->tick(
      {p.positions.data(), p.forces.data(), p.inputs.data(), p.outputs.data(), touches_.data()});
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    holds_[i].at = touches_[i].to;
    holds_[i].takes_hold = touches_[i].takes_hold;
    if (!std::all_of(holds_[i].at.begin(), holds_[i].at.end(), isWithinSanityLimit)) {
      holds_[i] = Hold();  // what it took hold of has blown up
    }
  }
  if (p.instrument->isUnderWay() && !std::exchange(is_held_up_, true)) {
    kick(0.0);
  }
  const bool look_inside = tick_ % kLookInsideTicks == 0;
  if (!std::all_of(p.forces.begin(), p.forces.end(), isWithinSanityLimit) ||
      (look_inside && !p.instrument->isFinite())) {
    blowUp();
  }
}

void Station::pushFrames() noexcept {
  std::fill(frames_out_.begin(), frames_out_.end(), 0.0F);
  const int model_channels = performer_->instrument->outputChannels();
  const int shared = std::min(model_channels, config_.output_channels);
  bool sane = true;
  for (int r = 0; r < config_.rates.ratio && !blown_up_; ++r) {
    const double gain = fade_.gainAt(r);
    const double* from = performer_->outputs.data() + samples(r, model_channels);
    float* to = frames_out_.data() + samples(r, config_.output_channels);
    for (int c = 0; c < shared; ++c) {
      to[c] = static_cast<float>(gain * from[c]);
      sane = sane && isWithinSanityLimit(from[c]);
    }
  }
  if (!sane) {
    blowUp();
    std::fill(frames_out_.begin(), frames_out_.end(), 0.0F);
  }
  if (frame_port_ != nullptr) {
    frame_port_->push(tick_ * config_.rates.ratio, frames_out_.data(), config_.rates.ratio);
  }
}

void Station::updateForces(bool muted) noexcept {
  force_.fill(0.0);
  followCalibration();
  if (is_held_up_) {  // as after a stall, once the tick is whole
    chain_.resume();
    is_held_up_ = performer_->instrument->isUnderWay();
    return;
  }
  if (muted || blown_up_ || gliding_ > 0) {
    return;
  }
  performer_->rig->toDevice(performer_->forces.data(), force_.data());
  injectModelFault();
  chain_.limit(force_.data(), fade_.isFadingOut() ? fade_.gainAt(config_.rates.ratio - 1) : 1.0);
  if (chain_.fault() != FaultReason::kNone) {
    fault(chain_.fault(), chain_.faultSlice());
  }
  if (chain_.mutedSlice() >= 0) {
    kick(FaultReason::kFrozen, chain_.mutedSlice());
  }
  for (std::size_t s = 0; s < static_cast<std::size_t>(slices_); ++s) {
    counters_.peak_force_n = std::max(counters_.peak_force_n, std::abs(force_[s]));
  }
  if (chain_.gain() >= 1.0 && interlock_->play()) {
    tell(event(Event::Type::kPlaying));
  }
}

void Station::blowUp() noexcept {
  blown_up_ = true;
  fault(FaultReason::kModelBlowUp, -1);
}

}  // namespace ergotic::station
