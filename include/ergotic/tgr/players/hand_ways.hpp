// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace ergotic::tgr {

/// Motion command for one hand.
struct Stroke {
  std::string end_effector;  ///< empty: `index` is a slice
  int index = 0;
  double target_m = 0.0;
  double glide_s = 0.0;  ///< duration of a minimum-jerk path; 0: see `after_s`
  /// A glide begins so much later than the note; what is no glide is there so much later, on a
  /// straight line from the stroke before.
  double after_s = 0.0;
  bool lets_go = false;  ///< the hand lets go; the target has no effect
};
using Strokes = std::vector<Stroke>;

/// Record of the commands to hands, so that a moving hand can be redirected without a jump.
///
/// A tick draws straight lines between targets, and begins a glide at the hand's position. If a
/// hand is redirected within a line, or to a line after a glide, a stroke to its position at that
/// time is added first.
/// Times are in s, of one clock that does not go back. Thread: one
class HandWays {
 public:
  /// A hand: an end-effector's coordinate, or a slice.
  using Hand = std::pair<std::string, int>;

  /// Lag of a hand that follows, s; it smooths a staircase of input values.
  static constexpr double kLagS = 0.02;

  /// \param rest_m  position of a hand that has no command yet
  /// \return target of its last command
  double toldOf(const Hand& hand, double rest_m) const;

  /// \return where its commands have brought the hand by a time, or will have, m
  double placeAt(const Hand& hand, double rest_m, double time_s) const;

  /// \return when its last command has brought a hand to its target; one without a command: 0
  double arrivalOf(const Hand& hand) const;

  /// Goes there on a path of minimum jerk.
  /// \param rest_m  as `toldOf`. \param after_s  it begins so much later than now
  void glide(const Hand& hand,
             double target_m,
             double rest_m,
             double glide_s,
             double after_s,
             double now_s,
             Strokes& strokes);

  /// Where a hand goes evenly, and between which ends it goes to and fro after that.
  struct Swing {
    double to_m = 0.0;
    double other_m = 0.0;
    int turns = 0;
  };
  /// Goes there evenly, at a speed in m/s. A hand without a command is at 0.
  /// \param after_s  as for a glide
  void draw(const Hand& hand,
            const Swing& swing,
            double speed,
            double after_s,
            double now_s,
            Strokes& strokes);

  /// Moves a hand on a straight line, within `kLagS` if that is not too fast. A glide that is under
  /// way is finished first, as it makes the sound of a note.
  /// \param rest_m  as `toldOf`. \param speed  m/s, at most
  void follow(const Hand& hand,
              double target_m,
              double rest_m,
              double speed,
              double now_s,
              Strokes& strokes);

  /// Stops a hand that is on its way, within `kLagS`.
  void stop(const Hand& hand, double now_s, Strokes& strokes);

  /// Makes a hand let go; no effect on a hand without a command.
  void letGo(const Hand& hand, Strokes& strokes);
  /// Clears the record after all hands have let go by themselves.
  void clear() { ways_.clear(); }

 private:
  struct Way {
    double begin_s = 0.0;
    double end_s = 0.0;
    double from_m = 0.0;
    double to_m = 0.0;
    bool is_glide = false;
    double other_m = 0.0;  // after end_s it goes there and back again
    int turns = 0;         // as often as that
    double turn_s = 0.0;   // from end to end
    double placeAt(double time_s) const;
    double overS() const { return end_s + turns * turn_s; }
  };
  std::map<Hand, Way> ways_;  // the newest of each
};

}  // namespace ergotic::tgr
