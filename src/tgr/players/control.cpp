// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/players/control.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ergotic/tgr/players/gamepad.hpp"

namespace ergotic::tgr {
namespace {

constexpr double kDecades = 100.0;  // a range over more of them is gone through by its logarithm
enum RegisteredController : std::uint8_t {
  kDataHigh = 6,
  kOtherLow = 98,  // of parameters that are not registered
  kOtherHigh = 99,
  kRegisteredLow = 100,
  kRegisteredHigh = 101
};
constexpr int kLowerManager = 0;
constexpr int kUpperManager = 15;

/// Members of a zone besides another one that has so many: both managers have channels, too.
int membersBeside(int others, int members) {
  constexpr int kMaxOfBoth = 14;
  return others > 0 ? std::clamp(kMaxOfBoth - others, 0, members) : members;
}

}  // namespace

std::string nameOf(const Control& control) {
  switch (control.kind) {
    case Control::Kind::kBend:
      return "the pitch bend";
    case Control::Kind::kPressure:
      return "the pressure";
    case Control::Kind::kAxis:
      return gamepadAxisNames()[static_cast<std::size_t>(control.number)] + " of the gamepad";
    default:
      return "controller " + std::to_string(control.number);
  }
}

bool Control::hasMiddle() const {
  constexpr int kFirstTrigger = static_cast<int>(GamepadAxis::kLeftTrigger);
  return kind == Kind::kBend || (kind == Kind::kAxis && number < kFirstTrigger);
}

double bendOf(int low, int high) {
  constexpr int kCentre = 8192;
  constexpr int kOfHigh = 128;
  const int from_centre = kOfHigh * high + low - kCentre;
  return static_cast<double>(from_centre) / (from_centre < 0 ? kCentre : kCentre - 1);
}

double valueOf(const ParameterChange& change, const ParameterRange& range) {
  double from = range.low;
  double to = range.high;
  double share = change.share;
  if (change.is_bent) {
    from = range.usual;
    to = share < 0.0 ? range.low : range.high;
    share = std::abs(share);
  }
  if (share == 0.0 || share == 1.0) {
    return share == 0.0 ? from : to;
  }
  const bool is_by_logarithm = range.low > 0.0 && range.high > kDecades * range.low;
  return is_by_logarithm ? from * std::pow(to / from, share) : from + share * (to - from);
}

void Learner::wait(std::string parameter) {
  parameter_ = std::move(parameter);
  first_heard_.clear();
}

void Learner::forget() {
  wait("");
  learnt_.clear();
}

std::optional<Learner::Learnt> Learner::hear(const Control& control, double share) {
  if (parameter_.empty()) {
    return std::nullopt;
  }
  const auto first = std::find_if(first_heard_.begin(), first_heard_.end(),
                                  [&](const auto& heard) { return heard.first == control; });
  if (first == first_heard_.end()) {
    first_heard_.emplace_back(control, share);
    return std::nullopt;
  }
  if (!(std::abs(share - first->second) > kLittle)) {
    return std::nullopt;
  }
  const auto is_replaced = [&](const Learnt& old) {
    return old.control == control || old.parameter == parameter_;
  };
  learnt_.erase(std::remove_if(learnt_.begin(), learnt_.end(), is_replaced), learnt_.end());
  learnt_.push_back({control, parameter_});
  wait("");
  return learnt_.back();
}

const std::string* Learner::parameterOf(const Control& control) const {
  const auto found = std::find_if(learnt_.begin(), learnt_.end(),
                                  [&](const Learnt& learnt) { return learnt.control == control; });
  return found == learnt_.end() ? nullptr : &found->parameter;
}

void MpeZones::hear(int channel, int controller, int value) {
  constexpr std::array<int, 2> kConfiguration{0, 6};
  constexpr int kNone = 127;
  if (channel != kLowerManager && channel != kUpperManager) {
    return;
  }
  Zone& zone = channel == kLowerManager ? lower_ : upper_;
  Zone& other = channel == kLowerManager ? upper_ : lower_;
  if (controller == kRegisteredHigh || controller == kRegisteredLow) {
    zone.registered[controller == kRegisteredHigh ? 0 : 1] = value;
  } else if (controller == kOtherHigh || controller == kOtherLow) {
    zone.registered = {kNone, kNone};
  } else if (controller == kDataHigh && zone.registered == kConfiguration) {
    zone.told = std::min(value, kAllMembers);
    if (other.told) {
      other.told = membersBeside(*zone.told, *other.told);
    }
  }
}

bool MpeZones::isMember(int channel) const {
  const bool is_of_lower = channel > kLowerManager && channel <= kLowerManager + lowerMembers();
  const bool is_of_upper = channel < kUpperManager && channel >= kUpperManager - upperMembers();
  return is_of_lower || is_of_upper;
}

/// Number of members; a message of the device overrides a map that asks for MPE.
int MpeZones::lowerMembers() const {
  if (!wanted_.value_or(true)) {
    return 0;
  }
  return lower_.told.value_or(membersBeside(upperMembers(), wanted_ ? kAllMembers : 0));
}

int MpeZones::upperMembers() const {
  return wanted_.value_or(true) ? upper_.told.value_or(0) : 0;
}

}  // namespace ergotic::tgr
