// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/rt/audio_processor.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/mailbox.hpp"
#include "ergotic/rt/realtime.hpp"
#include "ergotic/rt/ring.hpp"
#include "ergotic/station/frame_fifo.hpp"
#include "ergotic/station/frame_port.hpp"
#include "ergotic/station/limiter.hpp"
#include "ergotic/station/output_scope.hpp"
#include "ergotic/station/take_port.hpp"

namespace ergotic::station {

struct AudioBridgeConfig {
  physics::Rates rates;
  int output_channels = 24;  ///< as StationConfig::output_channels
  int input_channels = 12;   ///< as StationConfig::input_channels
  /// Ring depth: host frames from the due time of a tick to the sound of its first frame,
  /// 1...kMaxLatencyFrames. Raised when a host starts whose period needs more.
  int latency_frames = 3 * 256;
  bool limited = false;  ///< a Limiter precedes the host
};

/// A MIDI message, and when it came.
struct MidiArrival {
  double time_s = 0.0;  ///< CLOCK_MONOTONIC, a period after it came
  /// The tick that was due a period after it came, with its fraction; NaN while no ticks are tied
  /// to the host's frames.
  double tick = 0.0;
  rt::MidiMessage message;
};

/// Levels of the output signal before the limiter.
struct Loudness {
  float peak = 0.0F;                ///< largest magnitude, relative to full scale
  std::int64_t limited_frames = 0;  ///< frames that the limiter attenuated
};

/// The only place where ticks and audio periods meet: index arithmetic, nothing else.
///
/// While a host is connected, station frame f sounds at host frame f + offset, and tick n is due
/// when host frame n R + offset - latency begins. `offset` is chosen once per connection so that
/// the tick due next stays due when it was (to half a frame): haptics do not feel the host come or
/// go. What the ring does not hold when the host asks becomes zeros, reported as underrun; what
/// comes late is discarded; the relation never shifts.
///
/// Capture goes the other way under the same rule: station frame f takes host frame
/// f + offset - latency - (period + R), the newest that is always there.
///
/// Four kinds of thread: the host's set-up thread (audioStarted), any (audioStopped, xrun), the
/// host's real-time thread (process), the tick (everything else).
class AudioBridge : public rt::AudioProcessor, public FramePort {
 public:
  static constexpr int kMaxLatencyFrames = 1 << 14;
  /// Frames by which the latency exceeds a period and a tick at least: room for a late wake-up.
  static constexpr int kMarginFrames = 64;

  /// Realtime: no. Thread: setup
  /// \throws Exception if a setting is outside its range
  explicit AudioBridge(const AudioBridgeConfig& config);

  // The host:
  /// Realtime: no. Thread: host
  /// \throws Exception if the host's rate is not the station's, or its period needs a ring deeper
  ///         than kMaxLatencyFrames
  void audioStarted(double sample_rate_hz, std::uint32_t period_frames) override;
  /// Realtime: yes. Thread: any
  void audioStopped() noexcept override;
  /// Realtime: yes. Thread: host RT
  ERGOTIC_REALTIME void process(const rt::Period& period) noexcept override;
  /// Realtime: yes. Thread: any
  void xrun() noexcept override;

  /// \return false if none waits. Realtime: yes. Thread: one, any
  bool popMidi(MidiArrival& arrival) noexcept { return midi_.pop(arrival); }

  // The tick:
  /// Realtime: yes. Thread: tick
  ERGOTIC_REALTIME void push(std::int64_t first,
                             const float* frames,
                             int nframes) noexcept override;
  /// Realtime: yes. Thread: tick
  ERGOTIC_REALTIME bool pull(std::int64_t first, float* frames, int nframes) noexcept override;
  /// Realtime: yes. Thread: tick
  bool popEvent(Event& event) noexcept override;
  /// Realtime: yes. Thread: any
  AudioStatus status() const noexcept override;

  /// Takes news of the host: connects, disconnects, follows its clock. Before each tick.
  /// \param tick    the tick that runs next
  /// \param due_ns  its present due time, CLOCK_MONOTONIC
  /// Realtime: yes. Thread: tick
  ERGOTIC_REALTIME void track(std::int64_t tick, std::int64_t due_ns) noexcept;
  /// True while a host's clock says when ticks are due. Realtime: yes. Thread: tick
  bool isMaster() const noexcept { return connected_; }
  /// Due time of a tick by the host's clock. \pre isMaster(). Realtime: yes. Thread: tick
  std::int64_t dueNs(std::int64_t tick) const noexcept;

  /// The tick source stops: the bridge plays silence until `track` connects again, without
  /// underruns. Realtime: yes. Thread: tick
  void disconnect() noexcept;

  /// Port through which a recorded take is mixed with the instrument, before volume and limiter.
  const std::shared_ptr<TakePort>& takes() const noexcept { return takes_; }

  /// Levels since the bridge was made. Realtime: yes. Thread: any
  Loudness loudness() const noexcept {
    return {peak_.load(std::memory_order_relaxed), limited_frames_.load(std::memory_order_relaxed)};
  }
  /// Master volume of all outputs, 0...1, which is reached within 20 ms: at 1 the sound passes bit
  /// for bit. Realtime: yes. Thread: any
  void setVolume(float volume) noexcept { volume_.store(volume, std::memory_order_relaxed); }
  float volume() const noexcept { return volume_.load(std::memory_order_relaxed); }
  /// Peak magnitude of each output channel since the last call, relative to full scale, after the
  /// volume and before the limiter. Realtime: no. Thread: one, any
  std::vector<float> takePeaks();
  /// Scope of the output signal, after the volume and before the limiter. Thread: one, any
  OutputScope& scope() noexcept { return scope_; }
  /// Ring depth of the present connection. Realtime: yes. Thread: any
  int latencyFrames() const noexcept { return latency_.load(std::memory_order_relaxed); }
  /// Messages for operators (a raised latency, sound beyond full scale); each is returned once.
  /// Realtime: no. Thread: any
  std::vector<std::string> takeWarnings();

 private:
  /// Relation of frames in this connection, chosen by the tick and sent to the host's thread.
  struct Relation {
    std::uint32_t connection = 0;  // 0: none
    std::int64_t offset = 0;       // host frame - station frame
    std::int64_t first = 0;        // first station frame that is pushed
  };
  struct Reading {
    std::uint32_t connection = 0;
    rt::FrameTime start;
  };
  /// Frames that were not played, reported to the tick.
  struct Loss {
    Event::Type type = Event::Type::kUnderrun;
    std::int64_t first = 0;
    std::int64_t frames = 0;
    std::int64_t host_frame = 0;
  };

  /// \param relation  null: no ticks are tied to the host's frames
  void noteMidi(const rt::Period& period, const Relation* relation) noexcept;
  void capture(const rt::Period& period) noexcept;
  void play(const rt::Period& period, const Relation& relation) noexcept;
  const float* mix(const float* live) noexcept;
  float gainOf(const float* frame, int channels) noexcept;
  float nextVolume() noexcept;
  void noteSkipped(const rt::Period& period, const Relation& relation) noexcept;
  void tellLoss(const Loss& loss) noexcept;
  void noteUnderrun(const Relation& relation, std::int64_t first, std::int64_t end) noexcept;
  void connect(std::int64_t tick, std::int64_t due_ns) noexcept;
  void announce(Event::Type type, std::int64_t station_frame) noexcept;
  bool hostRuns(std::uint32_t connection) const noexcept;

  AudioBridgeConfig config_;
  rt::Ring<MidiArrival> midi_{1024};
  std::atomic<float> volume_{1.0F};
  float present_volume_ = 1.0F;                    // the host's real-time thread has it
  float volume_step_;                              // per frame
  std::vector<std::atomic<float>> channel_peaks_;  // [output channels]

  // Shared.
  std::atomic<bool> running_{false};
  std::atomic<std::int64_t> last_period_ns_{0};  // a host that is stopped does not say so
  std::atomic<std::uint32_t> connection_{0};     // counts audioStarted
  std::atomic<int> latency_;
  std::atomic<int> input_lag_{0};
  std::atomic<std::int64_t> underruns_{0};
  std::atomic<std::int64_t> underrun_frames_{0};
  std::atomic<std::int64_t> xruns_{0};
  std::atomic<std::int64_t> dropped_records_{0};
  std::atomic<bool> clock_locked_{false};
  std::atomic<float> peak_{0.0F};
  std::atomic<std::int64_t> limited_frames_{0};
  FrameFifo to_host_;
  FrameFifo from_host_;
  std::shared_ptr<TakePort> takes_;  // not null
  OutputScope scope_;
  rt::Mailbox<Reading> readings_;    // host RT -> tick
  rt::Mailbox<Relation> relations_;  // tick -> host RT
  rt::Ring<Loss> losses_;            // host RT -> tick
  std::mutex warnings_mutex_;        // set-up threads only
  std::vector<std::string> warnings_;
  bool loudness_is_told_ = false;  // with warnings_mutex_

  // The host's real-time thread.
  std::vector<float> capture_frame_;
  std::vector<float> mixed_frame_;  // [output channels]
  Limiter limiter_;
  std::int64_t expected_ = 0;      // host frame after the last block
  std::int64_t underrun_end_ = 0;  // station frame after the last missing one
  std::uint32_t played_ = 0;       // connection of the last block played

  // The tick.
  rt::FrameClock clock_;
  std::uint32_t followed_ = 0;  // connection whose readings feed the clock
  int readings_seen_ = 0;
  bool connected_ = false;
  Relation relation_;
  std::int64_t next_frame_ = 0;  // after the last one pushed
  Event announced_;
  bool has_announced_ = false;
};

}  // namespace ergotic::station
