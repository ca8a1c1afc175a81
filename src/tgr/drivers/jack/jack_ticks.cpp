// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/jack/jack_ticks.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "constants.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::tgr {
namespace {

constexpr int kMaxRatio = 48;  ///< frames per tick, see docs/tgr.md

/// `1, 2, 4`: the frames per tick that cut a period evenly.
std::string divisorsOf(std::uint32_t period) {
  std::ostringstream list;
  for (std::uint32_t r = 1; r <= std::min<std::uint32_t>(period, kMaxRatio); ++r) {
    if (period % r == 0) {
      list << (r == 1 ? "" : ", ") << r;
    }
  }
  return list.str();
}

void silence(const rt::Period& period) noexcept {
  for (int c = 0; c < period.output_channels; ++c) {
    std::fill_n(period.outputs[c], period.nframes, 0.0F);
  }
}

}  // namespace

void JackTicks::open(double tick_rate_hz) {
  const std::lock_guard<std::mutex> lock(refusal_mutex_);
  refusal_.clear();
  tick_rate_hz_ = tick_rate_hz;
  pinned_ = 0;
  fresh_ = true;
  last_positions_.fill(0.0);
  open_ = true;
}

std::string JackTicks::refusal() const {
  const std::lock_guard<std::mutex> lock(refusal_mutex_);
  return refusal_;
}

void JackTicks::start(TickTarget& target) {
  gate_.close();
  target_ = &target;
  fresh_ = true;
  gate_.open();
}

void JackTicks::checkRates(double sample_rate_hz, std::uint32_t period_frames) const {
  std::ostringstream message;
  const double frames_per_tick = sample_rate_hz / tick_rate_hz_;
  const double ratio = std::round(frames_per_tick);
  if (ratio < 1.0 || std::abs(frames_per_tick - ratio) > 1e-6 * ratio) {
    message << "the JACK server runs at " << sample_rate_hz << " Hz, which is no multiple of the "
            << tick_rate_hz_ << " Hz of the ticks: start one of them at a rate that fits";
  } else if (period_frames % static_cast<std::uint32_t>(ratio) != 0) {
    message << "the JACK server's period is " << period_frames << " frames, a tick is " << ratio
            << ", which does not divide it; allowed: " << divisorsOf(period_frames)
            << " frames per tick, or a period that is a multiple of " << ratio;
  } else if (pinned_ != 0 && period_frames != pinned_) {
    message << "the JACK server's period changed from " << pinned_ << " to " << period_frames
            << " frames, and with it the delay on which force limits rest: go back to " << pinned_
            << " or open the device again";
  } else {
    return;
  }
  throw Exception(message.str());
}

void JackTicks::audioStarted(double sample_rate_hz, std::uint32_t period_frames) {
  const std::lock_guard<std::mutex> lock(refusal_mutex_);
  try {
    checkRates(sample_rate_hz, period_frames);
    refusal_.clear();
  } catch (const Exception& error) {
    refusal_ = error.what();
    throw;
  }
  ratio_ = static_cast<int>(std::lround(sample_rate_hz / tick_rate_hz_));
  period_ = period_frames;
  frame_ns_ = kNsPerS / sample_rate_hz;
  restarted_ = true;
  running_ = true;
}

void JackTicks::process(const rt::Period& period) noexcept {
  silence(period);
  const std::int64_t left_out = framesLeftOut(period);
  if (!gate_.enter()) {
    return;
  }
  owed_ = fresh_.exchange(false) ? 0 : owed_ + left_out;
  now_ = &period;
  catchUp();
  runTicks(period);
  now_ = nullptr;
  if (safe_) {  // perhaps only since some ticks ago
    silence(period);
  } else {
    beat(period);
  }
  gate_.leave();
}

/// Counts the frames left out before this period, and predicts the begin of the next one. Negative
/// if the host gave two periods one time.
std::int64_t JackTicks::framesLeftOut(const rt::Period& period) noexcept {
  std::int64_t left_out = period.start.frames - next_frame_;
  if (restarted_) {  // another server counts anew; time goes on
    const auto passed_ns = static_cast<double>(period.start.time_ns - next_ns_);
    left_out = std::llround(std::max(passed_ns, 0.0) / frame_ns_);
    restarted_ = false;
  }
  next_frame_ = period.start.frames + period.nframes;
  next_ns_ = period.start.time_ns + std::llround(period.nframes * frame_ns_);
  return left_out;
}

void JackTicks::catchUp() noexcept {
  const std::int64_t missed = std::max<std::int64_t>(owed_, 0) / ratio_;
  if (missed == 0) {
    return;
  }
  const auto stall_ns = static_cast<double>(owed_) * frame_ns_;
  owed_ -= missed * ratio_;
  first_ = 0;
  may_push_ = false;
  target_->missed(missed, std::llround(stall_ns));
}

void JackTicks::runTicks(const rt::Period& period) noexcept {
  const auto ratio = static_cast<std::uint32_t>(ratio_.load());
  for (first_ = 0; first_ < period.nframes; first_ += ratio) {
    may_push_ = true;
    // A tick is due when its frames would come if they came one by one.
    const std::int64_t due_ns = period.start.time_ns + std::llround(first_ * frame_ns_);
    target_->tick(rt::monotonicNs() - due_ns);
  }
}

void JackTicks::beat(const rt::Period& period) noexcept {
  if (period.output_channels > slices_ && period.wired) {
    beat_ = -beat_;
    std::fill_n(period.outputs[slices_], period.nframes, beat_);
  }
}

std::uint32_t JackTicks::exchange(const double* forces, double* positions) noexcept {
  const bool safe = safe_;
  std::uint32_t flags = safe ? kMadeSafe : kExchangeOk;
  if (!open_ || !running_ || (now_ != nullptr && !now_->wired)) {
    flags |= kDeviceLost;
  } else if (now_ == nullptr) {
    flags |= kMissingSample;
  } else {
    readPositions();
    if (!safe && may_push_) {
      writeForces(forces);
    }
  }
  std::copy_n(last_positions_.begin(), slices_, positions);
  return flags;
}

void JackTicks::readPositions() noexcept {
  const int ratio = ratio_;
  for (int i = 0; i < slices_; ++i) {
    const float* from = now_->inputs[i] + first_;
    double sum = 0.0;
    for (int frame = 0; frame < ratio; ++frame) {
      sum += static_cast<double>(from[frame]);
    }
    last_positions_[static_cast<std::size_t>(i)] = volts_per_unit_ * sum / ratio;
  }
}

void JackTicks::writeForces(const double* forces) noexcept {
  for (int i = 0; i < slices_; ++i) {
    const double units = forces[i] / volts_per_unit_;
    const double force = std::isnan(units) ? 0.0 : std::clamp(units, -1.0, 1.0);
    std::fill_n(now_->outputs[i] + first_, ratio_.load(), static_cast<float>(force));
  }
}

}  // namespace ergotic::tgr
