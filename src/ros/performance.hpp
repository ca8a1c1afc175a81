// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ros/engine.hpp"
#include "ros/feed.hpp"

namespace ergotic::node {

/// Outcome of what a caller asked for, in words.
struct Answer {
  bool ok = false;
  std::string message;
};
using Promise = std::shared_ptr<std::promise<Answer>>;

/// What plays, and what was asked of it: the operator's side of the station.
///
/// Requests are answered when the real-time thread has obeyed, or said why not.
/// Thread: operator, all but `makeSafe`
class Performance {
 public:
  explicit Performance(Feed& feed) : feed_(feed) {}
  ~Performance() { close(); }
  Performance(const Performance&) = delete;
  Performance& operator=(const Performance&) = delete;

  Engine* engine() { return engine_.get(); }

  /// Takes over a running engine and the performer it was made with.
  void begin(std::unique_ptr<Engine> engine, station::Performer* performer);
  void swap(std::unique_ptr<station::Performer> performer, const Promise& promise);
  void engage(const Promise& promise);
  void stop(const Promise& promise);
  void setParameter(const std::string& name, double value, const Promise& promise);
  void setTarget(int slice, double target_m, const Promise& promise);

  /// Brings the news of the station to ROS and to those who wait for them.
  void poll();

  /// Forces to zero, device closed, waiting requests refused.
  void close();

  /// Force to zero at once, latched. Thread: any
  void makeSafe();

 private:
  using StateTest = bool (*)(station::ForceState);
  /// A model on its way into the station, which owns it.
  struct Incoming {
    station::Performer* performer = nullptr;
    Promise promise;
  };
  /// Somebody waits for a parameter to take effect.
  struct Change {
    std::string name;
    Promise promise;
  };
  /// Somebody waits for a state of the force.
  struct Waiter {
    StateTest is_met = nullptr;
    Promise promise;
    std::int64_t deadline_ns = 0;
  };

  void command(station::Command::Type type);
  void awaitState(StateTest is_met, const Promise& promise);
  void take(const station::Event& event);
  void takeSwapped(const station::Event& event);
  void takeKeyframe(const station::Event& event);
  void answerWaiters(const station::Snapshot& snapshot);
  void giveUpWaiters();
  void play(station::Performer* performer);
  void reportWarnings();

  Feed& feed_;
  std::mutex engine_mutex_;  // held while engine_ changes, and by makeSafe
  std::unique_ptr<Engine> engine_;
  station::Performer* playing_ = nullptr;    // owned by the station
  station::Performer* submitted_ = nullptr;  // the newest, owned by the station
  std::vector<double> parameters_;           // of submitted_, as submitted
  std::deque<Incoming> incoming_;
  std::deque<Change> changes_;
  std::vector<Waiter> waiters_;
  std::vector<station::GestureTick> gestures_;
};

}  // namespace ergotic::node
