// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/audio_bridge.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "ergotic/exception.hpp"

namespace ergotic::station {
namespace {

constexpr std::int64_t kStillNs = 1'000'000'000;  // without a period, many times the longest
constexpr double kClockBandwidthHz = 0.5;
constexpr double kVolumeS = 0.02;      // from silence to full volume
constexpr int kReadingsToConnect = 8;  // the first periods of a host are the least regular
constexpr std::size_t kFifoFrames = 2U * AudioBridge::kMaxLatencyFrames;
constexpr double kTakesS = 0.25;  // of a take that is ready before it sounds
constexpr std::size_t kLosses = 1U << 10U;

const AudioBridgeConfig& checkedBridge(const AudioBridgeConfig& config) {
  if (config.latency_frames < 1 || config.latency_frames > AudioBridge::kMaxLatencyFrames) {
    throw Exception("ring depth is " + std::to_string(config.latency_frames) +
                    " frames, allowed 1..." + std::to_string(AudioBridge::kMaxLatencyFrames));
  }
  if (config.output_channels < 1 || config.input_channels < 0) {
    throw Exception("audio channels: " + std::to_string(config.output_channels) + " out, " +
                    std::to_string(config.input_channels) +
                    " in; at least 1 out and 0 in are needed");
  }
  return config;
}

}  // namespace

AudioBridge::AudioBridge(const AudioBridgeConfig& config)
    : config_(checkedBridge(config)),
      volume_step_(static_cast<float>(1.0 / (kVolumeS * config.rates.audio_hz))),
      channel_peaks_(static_cast<std::size_t>(config.output_channels)),
      latency_(config.latency_frames),
      to_host_(kFifoFrames, config.output_channels),
      from_host_(kFifoFrames, config.input_channels),
      takes_(std::make_shared<TakePort>(static_cast<std::size_t>(kTakesS * config.rates.audio_hz),
                                        config.output_channels,
                                        config.rates.audio_hz)),
      scope_(config.output_channels),
      losses_(kLosses),
      capture_frame_(static_cast<std::size_t>(config.input_channels)),
      mixed_frame_(static_cast<std::size_t>(config.output_channels)),
      limiter_(config.rates.audio_hz),
      clock_(config.rates.audio_hz, kClockBandwidthHz) {}

void AudioBridge::audioStarted(double sample_rate_hz, std::uint32_t period_frames) {
  running_.store(false, std::memory_order_release);
  if (std::abs(sample_rate_hz - config_.rates.audio_hz) > 0.5) {
    throw Exception("the audio host runs at " + std::to_string(sample_rate_hz) +
                    " Hz, the station at " + std::to_string(config_.rates.audio_hz) +
                    " Hz: start one of them at the other's rate");
  }
  const int lag = static_cast<int>(period_frames) + config_.rates.ratio;
  const int needed = lag + kMarginFrames;
  if (needed > kMaxLatencyFrames) {
    throw Exception("the audio host's period is " + std::to_string(period_frames) +
                    " frames, allowed 1..." +
                    std::to_string(kMaxLatencyFrames - kMarginFrames - config_.rates.ratio));
  }
  if (needed > config_.latency_frames) {
    const std::lock_guard<std::mutex> lock(warnings_mutex_);
    warnings_.push_back("ring depth raised from " + std::to_string(config_.latency_frames) +
                        " to " + std::to_string(needed) + " frames: the host's period is " +
                        std::to_string(period_frames));
  }
  latency_.store(std::max(needed, config_.latency_frames), std::memory_order_relaxed);
  input_lag_.store(lag, std::memory_order_relaxed);
  connection_.fetch_add(1, std::memory_order_release);
  last_period_ns_.store(rt::monotonicNs(), std::memory_order_relaxed);
  running_.store(true, std::memory_order_release);
}

void AudioBridge::audioStopped() noexcept {
  running_.store(false, std::memory_order_release);
}

void AudioBridge::xrun() noexcept {
  xruns_.fetch_add(1, std::memory_order_relaxed);
}

std::vector<float> AudioBridge::takePeaks() {
  std::vector<float> peaks;
  for (std::atomic<float>& channel : channel_peaks_) {
    peaks.push_back(channel.exchange(0.0F, std::memory_order_relaxed));
  }
  return peaks;
}

std::vector<std::string> AudioBridge::takeWarnings() {
  const std::lock_guard<std::mutex> lock(warnings_mutex_);
  if (const Loudness now = loudness(); now.limited_frames > 0 && !loudness_is_told_) {
    loudness_is_told_ = true;
    const auto db = [](double amplitude) { return 20.0 * std::log10(amplitude); };
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << std::showpos << "the sound came to "
         << db(static_cast<double>(now.peak)) << " dBFS so far; what is above "
         << db(Limiter::kCeiling)
         << " dBFS is turned down by the limiter: play softer, or lower the gain of the outputs";
    warnings_.push_back(text.str());
  }
  std::vector<std::string> taken;
  taken.swap(warnings_);
  return taken;
}

bool AudioBridge::hostRuns(std::uint32_t connection) const noexcept {
  return running_.load(std::memory_order_acquire) &&
         connection_.load(std::memory_order_acquire) == connection;
}

// The host's real-time thread

void AudioBridge::process(const rt::Period& period) noexcept {
  const std::uint32_t connection = connection_.load(std::memory_order_acquire);
  last_period_ns_.store(rt::monotonicNs(), std::memory_order_relaxed);
  readings_.draft() = {connection, period.start};
  readings_.publish();
  capture(period);
  relations_.refresh();
  const Relation& relation = relations_.latest();
  const bool is_tied = relation.connection == connection && hostRuns(connection);
  noteMidi(period, is_tied ? &relation : nullptr);
  if (is_tied) {
    play(period, relation);
    return;
  }
  to_host_.clear();
  for (int c = 0; c < period.output_channels; ++c) {
    std::fill_n(period.outputs[c], period.nframes, 0.0F);
  }
}

/// Maps frames to ticks as `dueNs` does: time between messages is preserved to the frame.
void AudioBridge::noteMidi(const rt::Period& period, const Relation* relation) noexcept {
  for (int i = 0; i < period.midi_messages; ++i) {
    const rt::MidiMessage& message = period.midi[i];
    double tick = std::numeric_limits<double>::quiet_NaN();
    if (relation != nullptr) {
      const std::int64_t station_frame = period.start.frames + message.offset - relation->offset +
                                         latency_.load(std::memory_order_relaxed);
      tick = static_cast<double>(station_frame) / config_.rates.ratio;
    }
    const double time_s =
        1e-9 * static_cast<double>(period.start.time_ns) + message.offset / config_.rates.audio_hz;
    midi_.push({time_s, tick, message});
  }
}

void AudioBridge::capture(const rt::Period& period) noexcept {
  if (config_.input_channels == 0) {
    return;
  }
  const int shared = std::min(period.input_channels, config_.input_channels);
  for (std::uint32_t i = 0; i < period.nframes; ++i) {
    for (int c = 0; c < shared; ++c) {
      capture_frame_[static_cast<std::size_t>(c)] = period.inputs[c][i];
    }
    if (!from_host_.push(period.start.frames + i, capture_frame_.data(), 1)) {
      return;  // nobody pulls: the rest of the block would find no room either
    }
  }
}

void AudioBridge::play(const rt::Period& period, const Relation& relation) noexcept {
  noteSkipped(period, relation);
  const std::int64_t start = period.start.frames - relation.offset;
  const int shared = std::min(period.output_channels, config_.output_channels);
  for (int c = shared; c < period.output_channels; ++c) {
    std::fill_n(period.outputs[c], period.nframes, 0.0F);
  }
  std::int64_t missing_from = relation.first;  // of the open underrun, if it is before `frame`
  bool missing = false;
  for (std::uint32_t i = 0; i < period.nframes; ++i) {
    const std::int64_t station_frame = start + i;
    const float* live = to_host_.take(station_frame);
    const float* heard = mix(live);
    const float gain = heard != nullptr ? gainOf(heard, shared) : 0.0F;
    scope_.take(heard, shared, present_volume_);
    for (int c = 0; c < shared; ++c) {
      period.outputs[c][i] = heard != nullptr ? gain * heard[c] : 0.0F;
    }
    const bool lost = live == nullptr && station_frame >= relation.first;
    if (lost && !missing) {
      missing_from = station_frame;
    } else if (!lost && missing) {
      noteUnderrun(relation, missing_from, station_frame);
    }
    missing = lost;
  }
  to_host_.release();
  if (missing) {
    noteUnderrun(relation, missing_from, start + period.nframes);
  }
}

/// Sum of the instrument's and the take's frame; without a take, the instrument's frame unchanged.
const float* AudioBridge::mix(const float* live) noexcept {
  float gain = 0.0F;
  const float* const take = takes_->next(gain);
  if (take == nullptr) {
    return live;
  }
  for (std::size_t c = 0; c < mixed_frame_.size(); ++c) {
    mixed_frame_[c] = (live != nullptr ? live[c] : 0.0F) + gain * take[c];
  }
  return mixed_frame_.data();
}

float AudioBridge::nextVolume() noexcept {
  const float way = volume_.load(std::memory_order_relaxed) - present_volume_;
  present_volume_ += std::clamp(way, -volume_step_, volume_step_);
  return present_volume_;
}

/// 1 at full volume if nothing limits it.
float AudioBridge::gainOf(const float* frame, int channels) noexcept {
  const float volume = nextVolume();
  float peak = 0.0F;
  for (int c = 0; c < channels; ++c) {
    const float size = volume * std::abs(frame[c]);
    std::atomic<float>& channel = channel_peaks_[static_cast<std::size_t>(c)];
    if (size > channel.load(std::memory_order_relaxed)) {
      channel.store(size, std::memory_order_relaxed);
    }
    peak = std::max(peak, size);
  }
  if (peak > peak_.load(std::memory_order_relaxed)) {
    peak_.store(peak, std::memory_order_relaxed);
  }
  const float gain = config_.limited ? limiter_.gainFor(peak) : 1.0F;
  if (gain < 1.0F) {
    limited_frames_.fetch_add(1, std::memory_order_relaxed);
  }
  return volume * gain;
}

/// Counts frames that the host skipped: after an xrun its frame count has advanced without a call.
void AudioBridge::noteSkipped(const rt::Period& period, const Relation& relation) noexcept {
  const std::int64_t from = std::max(expected_ - relation.offset, relation.first);
  const std::int64_t frames = period.start.frames - relation.offset - from;
  if (played_ == relation.connection && frames > 0) {
    tellLoss({Event::Type::kAudioSkipped, from, frames, from + relation.offset});
  }
  played_ = relation.connection;
  expected_ = period.start.frames + period.nframes;
}

void AudioBridge::noteUnderrun(const Relation& relation,
                               std::int64_t first,
                               std::int64_t end) noexcept {
  // One that goes on through several blocks counts once.
  underruns_.fetch_add(first == underrun_end_ ? 0 : 1, std::memory_order_relaxed);
  underrun_frames_.fetch_add(end - first, std::memory_order_relaxed);
  underrun_end_ = end;
  tellLoss({Event::Type::kUnderrun, first, end - first, first + relation.offset});
}

void AudioBridge::tellLoss(const Loss& loss) noexcept {
  if (!losses_.push(loss)) {
    dropped_records_.fetch_add(1, std::memory_order_relaxed);
  }
}

// The tick

void AudioBridge::push(std::int64_t first, const float* frames, int nframes) noexcept {
  next_frame_ = first + nframes;
  if (connected_) {
    to_host_.push(first, frames, nframes);  // if there is no room, `process` misses and reports it
  }
}

bool AudioBridge::pull(std::int64_t first, float* frames, int nframes) noexcept {
  const auto channels = static_cast<std::size_t>(config_.input_channels);
  const std::size_t count = static_cast<std::size_t>(nframes) * channels;
  std::fill_n(frames, count, 0.0F);
  if (!connected_) {
    return false;
  }
  const std::int64_t host_first = first + relation_.offset -
                                  latency_.load(std::memory_order_relaxed) -
                                  input_lag_.load(std::memory_order_relaxed);
  for (int i = 0; i < nframes; ++i) {
    if (const float* from = from_host_.take(host_first + i)) {
      std::copy_n(from, channels, frames + static_cast<std::size_t>(i) * channels);
    }
  }
  from_host_.release();
  return std::any_of(frames, frames + count, [](float s) { return s != 0.0F; });
}

void AudioBridge::track(std::int64_t tick, std::int64_t due_ns) noexcept {
  if (connected_ && !hostRuns(relation_.connection)) {
    disconnect();
  }
  if (!readings_.refresh()) {
    return;
  }
  const Reading& reading = readings_.latest();
  if (!hostRuns(reading.connection)) {
    return;
  }
  if (reading.connection != followed_) {
    followed_ = reading.connection;
    readings_seen_ = 0;
    clock_.reset();
  }
  clock_.update(reading.start);
  clock_locked_.store(clock_.isLocked(), std::memory_order_relaxed);
  ++readings_seen_;
  if (!connected_ && clock_.isLocked() && readings_seen_ >= kReadingsToConnect) {
    connect(tick, due_ns);
  }
}

std::int64_t AudioBridge::dueNs(std::int64_t tick) const noexcept {
  return clock_.timeOf(tick * config_.rates.ratio + relation_.offset -
                       latency_.load(std::memory_order_relaxed));
}

void AudioBridge::connect(std::int64_t tick, std::int64_t due_ns) noexcept {
  relation_.connection = followed_;
  relation_.first = tick * config_.rates.ratio;
  relation_.offset = std::llround(clock_.frameAt(due_ns)) +
                     latency_.load(std::memory_order_relaxed) - relation_.first;
  relations_.draft() = relation_;
  relations_.publish();
  from_host_.clear();  // an earlier host may have counted from elsewhere
  connected_ = true;
  announce(Event::Type::kAudioStarted, relation_.first);
}

void AudioBridge::disconnect() noexcept {
  if (!connected_) {
    return;
  }
  connected_ = false;
  clock_locked_.store(false, std::memory_order_relaxed);
  announce(Event::Type::kAudioStopped, next_frame_);
  relations_.draft() = Relation{};
  relations_.publish();
}

void AudioBridge::announce(Event::Type type, std::int64_t station_frame) noexcept {
  announced_ = Event{};
  announced_.type = type;
  announced_.tick = station_frame / config_.rates.ratio;
  announced_.frame = station_frame;
  announced_.value = static_cast<double>(station_frame + relation_.offset);
  has_announced_ = true;
}

bool AudioBridge::popEvent(Event& event) noexcept {
  if (has_announced_) {
    event = announced_;
    has_announced_ = false;
    return true;
  }
  Loss loss;
  if (!losses_.pop(loss)) {
    return false;
  }
  event = Event{};
  event.type = loss.type;
  event.tick = loss.first / config_.rates.ratio;
  event.frame = loss.first;
  event.index = loss.frames;
  event.value = static_cast<double>(loss.host_frame);
  return true;
}

AudioStatus AudioBridge::status() const noexcept {
  const std::int64_t silent_ns =
      rt::monotonicNs() - last_period_ns_.load(std::memory_order_relaxed);
  const bool running = running_.load(std::memory_order_relaxed) && silent_ns < kStillNs;
  return {running,
          clock_locked_.load(std::memory_order_relaxed),
          underruns_.load(std::memory_order_relaxed),
          underrun_frames_.load(std::memory_order_relaxed),
          xruns_.load(std::memory_order_relaxed),
          dropped_records_.load(std::memory_order_relaxed)};
}

}  // namespace ergotic::station
