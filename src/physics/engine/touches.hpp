// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "ergotic/physics/engine/instrument.hpp"
#include "physics/engine/energy_meter.hpp"
#include "physics/layout/groups.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// Hands that hold modules (Touch). The force of one is worked out from where its module will be
/// when the force has moved it: by the mean of that and of where it was a step before, and the
/// velocity between the two. So spring and damper give out no energy but what the hand puts in,
/// whatever their values are and however light the module is (docs/physics/schemes.md, "Hands that
/// hold modules"). All is real-time but the constructor.
template <class Real>
class Touches {
 public:
  /// \param written  modules of the scene as it was written, the first of those that are played
  Touches(const scene::Scene& scene,
          std::size_t written,
          const Rates& rates,
          const Layout& layout,
          const CoefficientsOf<Real>& c)
      : scene_(scene), written_(static_cast<int>(written)), rates_(rates), layout_(layout) {
    for (const std::vector<TapPoint>* taps : {&layout.taps, &layout.seen_taps}) {
      for (const TapPoint& tap : *taps) {
        if (!tap.is_place) {
          taps_.emplace_back(tap.mat, &tap);
        }
      }
    }
    std::sort(taps_.begin(), taps_.end());
    std::size_t touchables = written;
    for (const scene::Outline& outline : scene.outlines) {
      touchables += outline.rest.size();
    }
    for (std::size_t mat = 0; mat < touchables; ++mat) {
      can_touch_.push_back(moves(static_cast<int>(mat), c));
    }
  }

  /// \pre 0 <= mat < Instrument::touchables
  bool canTouch(int mat) const noexcept { return can_touch_[static_cast<std::size_t>(mat)]; }

  /// Takes the touches at the start of a tick. \param touches  [kMaxTouches], or null
  void begin(Touch* touches, EnergyMeter<Real>& meter, State<Real>& state) noexcept {
    meter.forgetAhead();
    any_ = false;
    for (std::size_t i = 0; i < kMaxTouches; ++i) {
      const int mat = touches == nullptr ? Touch::kNothing : touches[i].mat;
      Hand& hand = hands_[i];
      if (mat != hand.mat) {
        hand = Hand();
      }
      if (mat != Touch::kNothing) {
        hold(hand, touches[i], state);
        any_ = true;
      }
    }
  }

  /// Whether a hand holds something in a section.
  bool holdsIn(int section) const noexcept {
    return any_ && std::any_of(hands_.begin(), hands_.end(), [section](const Hand& hand) {
             return hand.mat != Touch::kNothing && hand.held.section == section;
           });
  }

  /// The step of what hands hold in a group that ends with frame `last`, blocks that go through a
  /// tick alone left out. \pre all other forces are there, but those of energy-stable links
  void press(const Group& group,
             std::int64_t last,
             const CoefficientsOf<Real>& c,
             const EnergyMeter<Real>& meter,
             State<Real>& state) noexcept {
    pressWhere(last, c, meter, state, [&](const Hand& hand) {
      return !hand.is_in_lone_block && endsStep(hand.held.section, last) &&
             std::find(group.sections.begin(), group.sections.end(), hand.held.section) !=
                 group.sections.end();
    });
  }

  /// Presses the hands whose slots lie in such a block.
  void pressLone(int first,
                 int end,
                 std::int64_t last,
                 const CoefficientsOf<Real>& c,
                 const EnergyMeter<Real>& meter,
                 State<Real>& state) noexcept {
    pressWhere(last, c, meter, state, [&](const Hand& hand) {
      return hand.is_in_lone_block && hand.held.slot >= first && hand.held.slot < end;
    });
  }

  /// Ends a tick, once all forces are known: counts the other half of the work of hands that move
  /// something with the step to come, so that nothing of it is left to remember.
  /// \param touches  as of `begin`
  void end(Touch* touches,
           const CoefficientsOf<Real>& c,
           EnergyMeter<Real>& meter,
           State<Real>& state) noexcept {
    const double newton = 1.0 / (scene_.time_unit_s * scene_.time_unit_s);
    for (std::size_t i = 0; i < kMaxTouches && any_; ++i) {
      Hand& hand = hands_[i];
      for (std::size_t k = 0; k < hand.force.size(); ++k) {
        touches[i].force[k] = newton * static_cast<double>(hand.force[k]);
      }
      if (hand.mat != Touch::kNothing && endsStep(hand.held.section, state.frame() - 1)) {
        double work = 0.0;
        for (int k = 0; k < hand.held.dimensions; ++k) {
          const Motion motion = motionOf(hand.held, k, c.masses, state);
          const Real step = motion.next - (motion.last + motion.step);
          work += 0.5 * static_cast<double>(step * hand.counted[static_cast<std::size_t>(k)]);
        }
        meter.addAhead(hand.held.section, work, state);
        hand.counted = {};
      }
    }
  }

 private:
  /// A module, a tap, or a place of an outline.
  struct Held {
    bool isModule() const noexcept { return tap == nullptr && outline == nullptr; }

    int slot = -1;  // of the x coordinate of a module
    const TapPoint* tap = nullptr;
    const scene::Outline* outline = nullptr;
    std::size_t place = 0;  // of the outline
    int section = 0;
    int dimensions = 1;
    int stride = 0;
  };
  struct Hand {
    int mat = Touch::kNothing;
    Held held;
    bool is_in_lone_block = false;
    std::array<Real, 3> from{};
    std::array<Real, 3> way{};  // over the tick
    Real stiffness = Real(0);   // in the scene's units
    Real damping = Real(0);     // per step
    Real most_force = Real(0);
    std::array<Real, 3> force{};  // of the last step
    std::array<Real, 3>
        counted{};  // the same, of whose work half is not yet in the energy accounts
  };
  /// A coordinate of what is held: a step ago, as no hand would move it, and how a force does.
  struct Motion {
    Real last = Real(0);
    Real next = Real(0);
    Real per_force = Real(0);
    Real of_others = Real(0);  // what forces of other hands may do here
    Real step = Real(0);       // the last one
  };

  bool moves(int mat, const CoefficientsOf<Real>& c) const {
    const Held held = find(mat);
    bool all_move = held.slot >= 0 || !held.isModule();
    forEachShareOf(held, 0, [&](int slot, Real) {
      all_move = all_move && isModule(held.section, slot) &&
                 c.masses.inverse_mass[static_cast<std::size_t>(slot)] > Real(0) &&
                 (held.isModule() || !isInLoneBlock(slot));
    });
    return all_move;
  }

  Held find(int mat) const noexcept {
    if (mat >= written_) {
      return placeOfOutline(static_cast<std::size_t>(mat - written_));
    }
    Held held;
    held.section = scene_.mats[static_cast<std::size_t>(mat)].section;
    const auto tap = std::lower_bound(taps_.begin(), taps_.end(), mat,
                                      [](const auto& t, int m) { return t.first < m; });
    if (tap != taps_.end() && tap->first == mat) {
      held.tap = tap->second;
      held.stride = tap->second->stride;
      held.dimensions = tap->second->dimensions;
      held.section = tap->second->section;
    } else {
      const SectionRange& range = layout_.sections[static_cast<std::size_t>(held.section)];
      held.slot = layout_.slot_of_mat[static_cast<std::size_t>(mat)];
      held.stride = range.stride;
      held.dimensions = range.dimensions;
    }
    return held;
  }

  /// Finds a place by its index in all outlines, counted one after the other.
  Held placeOfOutline(std::size_t place) const noexcept {
    Held held;
    for (const scene::Outline& outline : scene_.outlines) {
      if (place < outline.rest.size()) {
        held.outline = &outline;
        held.place = place;
        held.section = scene_.mats[static_cast<std::size_t>(outline.first_mat)].section;
        return held;
      }
      place -= outline.rest.size();
    }
    return held;
  }

  bool isModule(int section, int slot) const noexcept {
    const SectionRange& range = layout_.sections[static_cast<std::size_t>(section)];
    return slot >= range.first && slot < range.fixed;
  }
  bool isInLoneBlock(int slot) const noexcept {
    const int block = layout_.blockOf(slot);
    return block >= 0 && layout_.blocks[static_cast<std::size_t>(block)].is_alone;
  }

  void hold(Hand& hand, Touch& touch, State<Real>& state) noexcept {
    if (hand.mat != touch.mat) {
      hand.mat = touch.mat;
      hand.held = find(touch.mat);
      hand.is_in_lone_block = hand.held.isModule() && isInLoneBlock(hand.held.slot);
    }
    const int dimensions = hand.held.dimensions;
    if (touch.takes_hold) {
      for (int k = 0; k < dimensions; ++k) {
        const auto i = static_cast<std::size_t>(k);
        touch.from[i] = static_cast<double>(placeOf(hand.held, k, state));
        touch.to[i] = touch.from[i];
      }
      touch.takes_hold = false;
    }
    const double unit = scene_.time_unit_s * scene_.time_unit_s;
    const SectionRange& range = layout_.sections[static_cast<std::size_t>(hand.held.section)];
    hand.stiffness = static_cast<Real>(touch.stiffness * unit);
    hand.damping = static_cast<Real>(touch.damping * unit * rates_.audio_hz / range.divisor);
    hand.most_force = static_cast<Real>(touch.most_force * unit);
    for (std::size_t i = 0; i < hand.from.size(); ++i) {
      hand.from[i] = static_cast<Real>(touch.from[i]);
      hand.way[i] = static_cast<Real>(touch.to[i] - touch.from[i]);
    }
    state.asleep()[hand.held.section] = 0;
  }

  template <class Visit>
  void forEachShareOf(const Held& held, int coordinate, const Visit& visit) const noexcept {
    const int by = coordinate * held.stride;
    if (held.tap != nullptr) {
      forEachShare(*held.tap,
                   [&](int slot, double weight) { visit(slot + by, static_cast<Real>(weight)); });
    } else if (held.outline != nullptr) {
      const auto modes = static_cast<std::size_t>(held.outline->modes);
      const auto first = static_cast<std::size_t>(held.outline->first_mat);
      for (std::size_t j = 0; j < modes; ++j) {
        visit(layout_.slot_of_mat[first + j],
              static_cast<Real>(held.outline->weights[held.place * modes + j]));
      }
    } else {
      visit(held.slot + by, Real(1));
    }
  }

  Real placeOf(const Held& held, int coordinate, const State<Real>& state) const noexcept {
    Real place = offsetOf(held, coordinate);
    forEachShareOf(held, coordinate,
                   [&](int slot, Real weight) { place += weight * state.x()[slot]; });
    return place;
  }
  static Real offsetOf(const Held& held, int coordinate) noexcept {
    return held.tap != nullptr && coordinate == 0 ? static_cast<Real>(held.tap->offset) : Real(0);
  }

  Motion motionOf(const Held& held,
                  int coordinate,
                  const MassCoefficients<Real>& c,
                  const State<Real>& state) const noexcept {
    Motion motion;
    Real place = offsetOf(held, coordinate);
    Real step(0);
    forEachShareOf(held, coordinate, [&](int slot, Real weight) {
      const auto s = static_cast<std::size_t>(slot);
      const Real x = state.x()[slot];
      const Real d = state.d()[slot];
      const Real ahead =
          d - (c.lose[s] * d + c.pull[s] * x) + c.inverse_mass[s] * state.f()[slot] + c.drift[s];
      place += weight * x;
      motion.step += weight * d;
      step += weight * ahead;
      motion.per_force += weight * weight * c.inverse_mass[s];
    });
    motion.last = place - motion.step;
    motion.next = place + step;
    return motion;
  }

  bool endsStep(int section, std::int64_t last) const noexcept {
    return (last + 1) % layout_.sections[static_cast<std::size_t>(section)].divisor == 0;
  }

  /// True if a force of one hand may move the place of the other: both are on one body or module.
  /// By the Cauchy-Schwarz inequality, the motion is at most sqrt(q_a q_b), q the motions per
  /// force.
  static bool mayMeet(const Held& a, const Held& b) noexcept {
    return a.section == b.section && (!a.isModule() || !b.isModule() || a.slot == b.slot);
  }

  template <class IsMeant>
  void pressWhere(std::int64_t last,
                  const CoefficientsOf<Real>& c,
                  const EnergyMeter<Real>& meter,
                  State<Real>& state,
                  const IsMeant& is_meant) noexcept {
    std::array<Hand*, kMaxTouches> pressed{};
    std::array<std::array<Motion, 3>, kMaxTouches> motions{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < kMaxTouches && any_; ++i) {
      Hand& hand = hands_[i];
      if (hand.mat != Touch::kNothing && is_meant(hand)) {
        for (int k = 0; k < hand.held.dimensions; ++k) {
          motions[count][static_cast<std::size_t>(k)] = motionOf(hand.held, k, c.masses, state);
        }
        pressed[count++] = &hand;
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        if (i != j && mayMeet(pressed[i]->held, pressed[j]->held)) {
          for (std::size_t k = 0; k < 3; ++k) {
            motions[i][k].of_others += std::sqrt(motions[i][k].per_force * motions[j][k].per_force);
          }
        }
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      press(*pressed[i], motions[i], last, meter, state);
    }
  }

  void press(Hand& hand,
             const std::array<Motion, 3>& motions,
             std::int64_t last,
             const EnergyMeter<Real>& meter,
             State<Real>& state) const noexcept {
    const Held& held = hand.held;
    const int divisor = layout_.sections[static_cast<std::size_t>(held.section)].divisor;
    const Real of_tick = static_cast<Real>(divisor) / static_cast<Real>(rates_.ratio);
    const auto frames = static_cast<Real>(last + 1 - state.frame());
    const Real done = frames / static_cast<Real>(rates_.ratio);
    std::array<Real, 3> force{};
    Real square(0);
    for (int k = 0; k < held.dimensions; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const Motion& motion = motions[i];
      const Real target = hand.from[i] + done * hand.way[i];
      const Real stretch = Real(0.5) * (motion.next + motion.last) - target;
      const Real slip = Real(0.5) * (motion.next - motion.last) - of_tick * hand.way[i];
      const Real softened = Real(1) + Real(0.5) * (motion.per_force + motion.of_others) *
                                          (hand.stiffness + hand.damping);
      force[i] = -(hand.stiffness * stretch + hand.damping * slip) / softened;
      square += force[i] * force[i];
    }
    const Real all = std::sqrt(square);
    const Real share = all > hand.most_force ? hand.most_force / all : Real(1);
    double work = 0.0;
    for (int k = 0; k < held.dimensions; ++k) {
      const auto i = static_cast<std::size_t>(k);
      force[i] *= share;
      work += 0.5 * static_cast<double>(motions[i].step * (force[i] + hand.counted[i]));
      forEachShareOf(held, k, [&](int slot, Real weight) { state.f()[slot] += weight * force[i]; });
    }
    hand.force = force;
    hand.counted = force;
    meter.addTouch(held.section, work, state);
  }

  const scene::Scene& scene_;
  const int written_;
  const Rates rates_;
  const Layout& layout_;
  std::vector<std::pair<int, const TapPoint*>> taps_;  // by module
  std::vector<bool> can_touch_;                        // [Instrument::touchables]
  std::array<Hand, kMaxTouches> hands_{};
  bool any_ = false;
};

}  // namespace ergotic::physics
