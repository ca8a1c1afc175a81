// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/holders.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <ergotic/HandTargets.h>

#include "ergotic/exception.hpp"
#include "ros/display/markers.hpp"

namespace ergotic::node {
namespace {

constexpr double kGlideS =
    1.0 / 60.0;  // from one target to the next: a mouse tells 60 or more a second
constexpr double kDampingS = 1e-3;  // N s/m per N/m
constexpr double kFarthestM = 100.0;

struct Grip {
  double stiffness;   // N/m
  double most_force;  // N
};

Grip gripOf(std::uint8_t grip) {
  switch (grip) {
    case HandTargets::SOFT:
      return {500.0, 5.0};
    case HandTargets::QUICK:
      return {3000.0, 20.0};
    case HandTargets::KEY:
      return {5000.0, 60.0};
    default:
      return {1500.0, 10.0};
  }
}

template <class Value>
[[noreturn]] void refuse(const std::string& field, const Value& value, const std::string& allowed) {
  std::ostringstream text;
  text << field << " is " << value << ", allowed: " << allowed;
  throw Exception(text.str());
}

}  // namespace

std::vector<std::uint8_t> modulesThatCanBeHeld(const physics::Instrument& instrument) {
  const scene::Scene& scene = instrument.scene();
  std::vector<std::uint8_t> modules;
  for (int mat = 0; mat < instrument.touchables(); ++mat) {
    const bool can = instrument.canTouch(mat) && !isModeOfOutline(scene, mat);
    modules.push_back(can ? 1U : 0U);
  }
  return modules;
}

void Holders::play(const station::Performer* model,
                   std::vector<std::uint8_t> can_be_held,
                   double tick_rate_hz) {
  const std::lock_guard lock(mutex_);
  model_ = model;
  can_be_held_ = std::move(can_be_held);
  tick_rate_hz_ = tick_rate_hz;
  hands_ = {};
}

void Holders::check(const HoldTarget& wanted) const {
  if (wanted.release) {
    return;  // of what is not held nothing has to be let go
  }
  if (can_be_held_.empty()) {
    refuse(
        "module", wanted.module,
        "none, as a person may be at the device: modules are held where all devices are simulated");
  }
  const auto modules = static_cast<int>(can_be_held_.size());
  if (wanted.module < 0 || wanted.module >= modules) {
    refuse("module", wanted.module, "0..." + std::to_string(modules - 1));
  }
  if (can_be_held_[static_cast<std::size_t>(wanted.module)] == 0) {
    refuse("module", wanted.module,
           "what moves by itself: masses, cells, and places of bodies that are played by their "
           "modes (can_be_held of the topic handles)");
  }
  for (const double target : wanted.target) {
    if (!(std::abs(target) <= kFarthestM)) {
      refuse("target", target, "-100...100 m");
    }
  }
  if (wanted.grip > HandTargets::KEY) {
    refuse("grip", static_cast<int>(wanted.grip), "0...4");
  }
  if (!(wanted.timeout >= 0.0)) {
    refuse("timeout", wanted.timeout, "0 or more seconds");
  }
}

/// The one that holds it, else a free one.
std::size_t Holders::handFor(int module, const std::string& sender) const {
  std::size_t free = hands_.size();
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    if (hands_[i].module == module && hands_[i].sender == sender) {
      return i;
    }
    if (free == hands_.size() && hands_[i].module == physics::Touch::kNothing) {
      free = i;
    }
  }
  if (free == hands_.size()) {
    refuse("the number of modules that are held", hands_.size() + 1,
           "at most " + std::to_string(hands_.size()));
  }
  return free;
}

std::vector<Holders::Wish> Holders::read(const HoldTarget& wanted,
                                         const std::string& sender,
                                         double now_s) {
  const std::lock_guard lock(mutex_);
  check(wanted);
  if (wanted.release) {
    return release(wanted, sender);
  }
  const std::size_t index = handFor(wanted.module, sender);
  Hand& hand = hands_[index];
  hand = {wanted.module, sender, now_s, wanted.timeout};
  const Grip grip = gripOf(wanted.grip);
  station::Hold hold;
  hold.mat = wanted.module;
  std::copy(wanted.target.begin(), wanted.target.end(), hold.goal.begin());
  hold.ticks_left = static_cast<int>(std::lround(kGlideS * tick_rate_hz_));
  hold.stiffness = grip.stiffness;
  hold.damping = kDampingS * grip.stiffness;
  hold.most_force = grip.most_force;
  return {{index, hold, model_}};
}

std::vector<Holders::Wish> Holders::release(const HoldTarget& wanted, const std::string& sender) {
  std::vector<Wish> wishes;
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    const bool is_meant =
        wanted.module == physics::Touch::kNothing || wanted.module == hands_[i].module;
    if (is_meant && hands_[i].module != physics::Touch::kNothing && hands_[i].sender == sender) {
      hands_[i] = Hand();
      wishes.push_back({i, {}, model_});
    }
  }
  return wishes;
}

std::vector<Holders::Wish> Holders::expire(double now_s) {
  const std::lock_guard lock(mutex_);
  std::vector<Wish> wishes;
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    Hand& hand = hands_[i];
    if (hand.module != physics::Touch::kNothing && hand.timeout_s > 0.0 &&
        now_s - hand.heard_s > hand.timeout_s) {
      hand = Hand();
      wishes.push_back({i, {}, model_});
    }
  }
  return wishes;
}

}  // namespace ergotic::node
