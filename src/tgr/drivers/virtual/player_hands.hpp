// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "ergotic/tgr/driver.hpp"
#include "tgr/drivers/virtual/virtual_slice.hpp"

namespace ergotic::tgr {

/// Computes when the moves of a source are due, by the clock of the device. A source (a mouse, a
/// program) stamps them by a clock of its own, and they arrive with jitter. Of the last 32
/// arrivals, the one with the least delay gives the offset between the clocks. A move is due so
/// long after that as the move behind it usually took to arrive (15 of the last 16 did), 12 ms at
/// most: the hand then knows its next target. Realtime: yes.
class MoveTiming {
 public:
  static constexpr double kMaxDelayS = 0.012;

  /// \param stamp_s  time by the source's clock. \param now_s  when the move arrived
  /// \return due time, s, by the device's clock; not before the move arrived
  double dueAt(double stamp_s, double now_s) noexcept;

 private:
  static constexpr std::size_t kWaits = 16;
  void count(double interval_s, double late_s) noexcept;
  double delay() const noexcept;
  double leastOffset(double now_s) const noexcept;

  struct Arrival {
    double time_s = 0.0;
    double offset_s = 0.0;  // from the source's clock to the device's
  };
  static constexpr std::size_t kArrivals = 32;
  std::array<Arrival, kArrivals> arrivals_{};  // a ring
  std::size_t arrived_ = 0;
  double last_stamp_s_ = 0.0;
  double last_now_s_ = 0.0;
  double last_due_s_ = 0.0;
  std::array<double, kWaits> waits_{};  // from when a move could be due to when the next was there
  std::size_t counted_ = 0;
};

/// The hands that players move, one per slice, in place of the gesture's.
///
/// A hand that attaches begins at the slice's position. Its target moves on straight lines from
/// move to move (at the times of MoveTiming), at most `kMaxSpeed` fast; then it rests. A hand that
/// lets go follows the slice, its pull fades within `kFadeS`, and the slice is free.
///
/// Times are in s, of one clock that does not stop. Realtime: yes. Thread: who steps the device
class PlayerHands {
 public:
  static constexpr double kMaxSpeed = 2.0;  ///< m/s
  static constexpr double kFadeS = 0.02;

  /// State of the hand at a slice over a step.
  struct Holding {
    HandTarget target;
    double acceleration = 0.0;  ///< m/s^2, acceleration of the target on a glide, fed forward
    HandGrip grip = HandGrip::kConfigured;
    double strength = 1.0;  ///< 0...1, scale of spring and damper
  };

  /// Resets to the state in which no hand has held anything.
  void clear() noexcept { *this = PlayerHands(); }

  /// \pre move.isValid
  void take(const HandMove& move, double now_s) noexcept;

  /// Whether a player's hand has held the slice since `clear`.
  bool owns(int slice) const noexcept { return at(slice).state != State::kNever; }

  /// Moves the hand on by a step from `now_s`. \param present  where the slice is, and its speed
  /// \pre owns(slice)
  Holding step(int slice, const HandTarget& present, double now_s, double step_s) noexcept;

 private:
  enum class State : std::uint8_t { kNever, kTakesHold, kHolds, kLetsGo };
  /// A target and the time at which it applies; a glide to it begins then.
  struct Knot {
    double time_s = 0.0;
    double target_m = 0.0;
    double glide_s = 0.0;
  };
  /// A path of minimum jerk; before its begin and after its end the target rests.
  struct Glide {
    double begin_s = 0.0;
    double length_s = 0.0;
    double from_m = 0.0;
    double way_m = 0.0;
    double placeAt(double time_s) const noexcept;
    double accelerationAt(double time_s) const noexcept;
  };
  /// The hand at one slice. Its target is on the line from `from` to the first knot.
  struct Hand {
    static constexpr std::size_t kKnots = 64;
    void add(const Knot& knot, double now_s) noexcept;
    double placeAt(double time_s) noexcept;
    const Knot& newest() const noexcept { return knots[(first + count - 1) % kKnots]; }

    State state = State::kNever;
    HandGrip grip = HandGrip::kConfigured;
    bool jumps = false;
    Knot from;
    std::array<Knot, kKnots> knots{};  // a ring
    std::size_t first = 0;
    std::size_t count = 0;
    Glide glide;
    double target_m = 0.0;  // where it is now
    double strength = 1.0;
    double stretch_m = 0.0;  // of one that lets go
    double timeout_s = 0.0;
    double heard_s = 0.0;
  };
  static Holding fade(Hand& hand, const HandTarget& present, double step_s) noexcept;
  const Hand& at(int slice) const noexcept { return hands_[static_cast<std::size_t>(slice)]; }

  std::array<Hand, kMaxSlices> hands_{};
  std::array<MoveTiming, kMaxHandSources> timings_{};
};

}  // namespace ergotic::tgr
