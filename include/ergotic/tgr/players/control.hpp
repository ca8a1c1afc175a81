// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ergotic::tgr {

/// A control that a player moves (wheel, knob, pressure, axis), on any channel.
struct Control {
  enum class Kind : std::uint8_t {
    kController,  ///< 0...1
    kBend,        ///< -1...1, 0 when released
    kPressure,    ///< 0...1, of a channel, or of its most pressed key
    kAxis         ///< axis of a gamepad, see GamepadAxis
  };
  Kind kind = Kind::kController;
  int number = 0;  ///< MIDI number of a controller, or number of an axis

  bool operator==(const Control& other) const {
    return kind == other.kind && number == other.number;
  }
  /// Whether the control returns to a middle, 0, when released: bends and sticks, -1...1.
  bool hasMiddle() const;
};

/// "controller 21", "the pitch bend", "the pressure", "left_x of the gamepad".
std::string nameOf(const Control& control);

/// -1...1 of the 14 bits of a bend; both ends are reached, and so is 0.
double bendOf(int low, int high);

/// A parameter of the scene shall have another value.
struct ParameterChange {
  std::string parameter;
  double share = 0.0;  ///< share of the range, 0...1; -1...1 if it is bent
  bool is_bent = false;
};

/// Range of a parameter; `usual` is its value when a bend is 0.
struct ParameterRange {
  double low = 0.0;
  double usual = 0.0;
  double high = 1.0;
};

/// Value of a parameter: linear in the share, or logarithmic if the range has more than two decades
/// above zero.
double valueOf(const ParameterChange& change, const ParameterRange& range);

/// Binds the next control that a player moves to a parameter. Thread: one
class Learner {
 public:
  struct Learnt {
    Control control;
    std::string parameter;
  };

  /// \param parameter  that the next control shall move; empty: it waits for none any more
  void wait(std::string parameter);
  /// Removes all learnt bindings, and stops waiting.
  void forget();

  /// \param share  where the control is, -1...1
  /// \return the new binding, if the control moved by more than `kLittle` since it was first
  /// received
  std::optional<Learnt> hear(const Control& control, double share);

  /// Parameter that a control was bound to by learning. \return null for others
  const std::string* parameterOf(const Control& control) const;

  /// Threshold: a hand resting on a wheel, and a source of occasional values, bind nothing.
  static constexpr double kLittle = 8.5 / 127.0;

 private:
  std::string parameter_;
  std::vector<std::pair<Control, double>> first_heard_;  // since it waits
  std::vector<Learnt> learnt_;
};

/// MPE zones: the channels with notes of their own, by MIDI Polyphonic Expression (MMA/AMEI
/// RP-053). The manager of the lower zone is channel 0, and its members follow it upwards; that of
/// the upper zone is channel 15, and its members follow it downwards. If two zones would share
/// channels, the one that was configured last has them. Channels are 0...15. Thread: one
class MpeZones {
 public:
  static constexpr int kAllMembers = 15;

  /// \param wanted  by the map, the lower zone with all members unless the player's device has
  ///                said otherwise; nothing: as the device has said, which says it once
  void use(std::optional<bool> wanted) { wanted_ = wanted; }
  /// Takes any controller; registered parameter 6 on a manager's channel sets the number of
  /// members.
  void hear(int channel, int controller, int value);

  bool isOn() const { return lowerMembers() > 0 || upperMembers() > 0; }
  bool isMember(int channel) const;

 private:
  struct Zone {
    std::optional<int> told;                  // members, by the device
    std::array<int, 2> registered{127, 127};  // high and low of what its manager chose last
  };
  int lowerMembers() const;
  int upperMembers() const;

  std::optional<bool> wanted_;
  Zone lower_;
  Zone upper_;
};

}  // namespace ergotic::tgr
