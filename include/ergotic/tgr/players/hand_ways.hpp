// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace ergotic::tgr {

/// Where a hand shall go.
struct Stroke {
  std::string end_effector;  ///< empty: `index` is a slice
  int index = 0;
  double target_m = 0.0;
  double glide_s = 0.0;  ///< on a path of minimum jerk that takes so long; 0: see `after_s`
  /// A glide begins so much later than the note; what is no glide is there so much later, on a
  /// straight line from the stroke before.
  double after_s = 0.0;
  bool lets_go = false;  ///< of the hand; the target has no effect
};
using Strokes = std::vector<Stroke>;

/// What hands were told, so that one that is under way can be sent elsewhere without a jump.
///
/// A tick draws straight lines between targets, and begins a glide where the hand is. Between the
/// two, and from within a line, a stroke to where the hand is at that time makes a corner.
/// Times are in s, of one clock that does not go back. Thread: one
class HandWays {
 public:
  /// Which hand: an end-effector's coordinate, or a slice.
  using Hand = std::pair<std::string, int>;

  /// What a hand that follows lags behind, s: no staircase is heard of what comes in steps.
  static constexpr double kLagS = 0.02;

  /// \param rest_m  where a hand is that was told nothing
  /// \return where it was told to be last
  double toldOf(const Hand& hand, double rest_m) const;

  /// Goes there on a path of minimum jerk. \param after_s  it begins so much later than now
  void glide(const Hand& hand,
             double target_m,
             double glide_s,
             double after_s,
             double now_s,
             Strokes& strokes);

  /// Goes there on a straight line, within `kLagS` if that is not too fast. A glide that is under
  /// way goes on to its end first: it is what a note sounds by.
  /// \param rest_m  as `toldOf`. \param speed  m/s, at most
  void follow(const Hand& hand,
              double target_m,
              double rest_m,
              double speed,
              double now_s,
              Strokes& strokes);

  /// No effect on one that was told nothing.
  void letGo(const Hand& hand, Strokes& strokes);
  /// All have let go by themselves.
  void clear() { ways_.clear(); }

 private:
  struct Way {
    double begin_s = 0.0;
    double end_s = 0.0;
    double from_m = 0.0;
    double to_m = 0.0;
    bool is_glide = false;
    double lineAt(double time_s) const;  // of one that is no glide
  };
  std::map<Hand, Way> ways_;  // the newest of each
};

}  // namespace ergotic::tgr
