// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/take_player.hpp"

#include <algorithm>
#include <chrono>
#include <sstream>

#include "ergotic/exception.hpp"
#include "ros/interface/convert.hpp"

namespace ergotic::node {
namespace {

using namespace std::chrono_literals;

constexpr auto kPause = 5ms;
constexpr int kPausesUntilSilent = 100;

/// Accepts every model: a model that has been played may be played again, whatever its certificate.
station::PerformerPolicy policyOfTakes() {
  station::PerformerPolicy policy;
  policy.allow_unproven = true;
  policy.allow_unstable = true;
  return policy;
}

}  // namespace

TakePlayer::TakePlayer(const std::string& path,
                       std::shared_ptr<station::TakePort> port,
                       double rate_hz,
                       double display_zoom)
    : port_(std::move(port)),
      rate_hz_(rate_hz),
      display_zoom_(display_zoom),
      first_frame_(port_->sounded()) {
  thread_ = std::thread([=] { run(path); });
}

TakePlayer::~TakePlayer() {
  halt();
  thread_.join();
}

void TakePlayer::halt() {
  halts_ = true;
  port_->close();
}

TakePlayer::News TakePlayer::news() {
  const std::lock_guard lock(mutex_);
  News now = news_;
  news_.picture.reset();
  now.played_s =
      std::clamp(static_cast<double>(played()) / rate_hz_, 0.0, std::max(news_.length_s, 0.0));
  return now;
}

std::optional<TakePlayer::Seen> TakePlayer::motion() {
  std::optional<Seen> newest;
  const std::lock_guard lock(mutex_);
  while (!motion_.empty() && motion_.front().first <= played()) {
    Seen next = std::move(motion_.front().second);
    if (newest && !next.picture) {
      next.picture = std::move(newest->picture);
    }
    newest = std::move(next);
    motion_.pop_front();
  }
  return newest;
}

void TakePlayer::run(const std::string& path) {
  std::string message;
  bool failed = true;
  try {
    replay::Replay replay(bag::readRecording(path), policyOfTakes());
    if (replay.rates().audio_hz != rate_hz_) {
      std::ostringstream text;
      text << path << ": was recorded at " << replay.rates().audio_hz << " Hz, the sound is at "
           << rate_hz_ << " Hz: start JACK at its rate, or play the file that `render --gesture "
           << path << " --out take.wav` writes";
      throw Exception(text.str());
    }
    {
      std::shared_ptr<Picture> picture = toPicture(replay.instrument(), display_zoom_);
      pictured_ = &replay.instrument();
      const std::lock_guard lock(mutex_);
      news_.picture = std::move(picture);
      news_.length_s = static_cast<double>(replay.ticksLeft() * replay.rates().ratio) / rate_hz_;
      news_.state = State::kPlays;
    }
    failed = false;
    play(replay);
    message = replay.flaws().empty() ? "" : path + ": " + replay.flaws().front();
  } catch (const std::exception& failure) {
    message = failure.what();
  }
  waitUntilSilent();
  const std::lock_guard lock(mutex_);
  news_.state = State::kOver;
  news_.message = message;
  news_.failed = failed;
  motion_.clear();
}

void TakePlayer::play(replay::Replay& replay) {
  const int ratio = replay.rates().ratio;
  const auto channels = static_cast<std::size_t>(replay.outputChannels());
  const auto heard = static_cast<std::size_t>(port_->channels());
  std::vector<double> made(static_cast<std::size_t>(ratio) * channels);
  std::vector<float> frames(static_cast<std::size_t>(ratio) * heard);
  if (halts_) {
    return;
  }
  port_->open();
  for (std::int64_t frame = 0; replay.next(made.data()); frame += ratio) {
    for (std::size_t r = 0; r < static_cast<std::size_t>(ratio); ++r) {
      for (std::size_t c = 0; c < std::min(channels, heard); ++c) {
        frames[r * heard + c] = static_cast<float>(made[r * channels + c]);
      }
    }
    keepMotion(replay, frame);
    if (!push(frames, ratio)) {
      return;
    }
  }
}

/// A take may go from one model to the next.
void TakePlayer::keepMotion(replay::Replay& replay, std::int64_t frame) {
  const station::MotionFrame* const motion = replay.motion();
  if (motion == nullptr) {
    return;
  }
  Seen seen{*motion, nullptr};
  if (std::exchange(pictured_, &replay.instrument()) != &replay.instrument()) {
    seen.picture = toPicture(replay.instrument(), display_zoom_);
  }
  const std::lock_guard lock(mutex_);
  motion_.emplace_back(frame, std::move(seen));
}

/// \return false if it shall end
bool TakePlayer::push(const std::vector<float>& frames, int nframes) {
  while (!halts_) {
    if (port_->push(frames.data(), nframes)) {
      return true;
    }
    std::this_thread::sleep_for(kPause);
  }
  return false;
}

/// Waits for the end of the sound: at its end the take sounds on; a halted one fades, if JACK runs.
void TakePlayer::waitUntilSilent() {
  for (int i = 0; !port_->isSilent() && (!halts_ || i < kPausesUntilSilent); i += halts_ ? 1 : 0) {
    std::this_thread::sleep_for(kPause);
  }
  port_->close();
}

}  // namespace ergotic::node
