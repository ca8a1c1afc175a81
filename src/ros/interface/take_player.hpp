// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "ergotic/bag/recording.hpp"
#include "ergotic/station/take_port.hpp"
#include "replay/replay.hpp"
#include "ros/display/display.hpp"

namespace ergotic::node {

/// Plays a recorded take through the port of the audio host, in a thread of its own that reads the
/// bag, builds the model anew and stays a quarter of a second ahead of the sound.
/// Thread: command thread, all of it; none of these waits, but the destructor, for a model that is
/// built
class TakePlayer {
 public:
  /// \param path          of the bag
  /// \param port          not null, and silent
  /// \param rate_hz       of the sound
  /// \param display_zoom  of the picture
  TakePlayer(const std::string& path,
             std::shared_ptr<station::TakePort> port,
             double rate_hz,
             double display_zoom);
  ~TakePlayer();
  TakePlayer(const TakePlayer&) = delete;
  TakePlayer& operator=(const TakePlayer&) = delete;

  /// Ends the replay; it fades within 5 ms.
  void halt();

  enum class State : std::uint8_t { kReads, kPlays, kOver };
  struct News {
    State state = State::kReads;
    std::string message;  ///< error or flaw at the end; empty: none
    bool failed = false;  ///< there was no sound at all
    double played_s = 0.0;
    double length_s = 0.0;
    std::shared_ptr<Picture> picture;  ///< picture of its model, once; else null
  };
  News news();
  struct Seen {
    station::MotionFrame motion;
    std::shared_ptr<Picture> picture;  ///< picture of the next model; null: the same model
  };
  /// Motion of the take at the present output position, if it has changed since the last call.
  std::optional<Seen> motion();

 private:
  void run(const std::string& path);
  void play(replay::Replay& replay);
  void keepMotion(replay::Replay& replay, std::int64_t frame);
  bool push(const std::vector<float>& frames, int nframes);
  void waitUntilSilent();
  std::int64_t played() const { return port_->sounded() - first_frame_; }

  std::shared_ptr<station::TakePort> port_;
  double rate_hz_;
  double display_zoom_;
  const physics::Instrument* pictured_ = nullptr;  // of the thread
  std::int64_t first_frame_;                       // of the port
  std::atomic<bool> halts_{false};
  std::mutex mutex_;  // of what follows
  News news_;
  std::deque<std::pair<std::int64_t, Seen>> motion_;  // by frames of the take
  std::thread thread_;
};

}  // namespace ergotic::node
