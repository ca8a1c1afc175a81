// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "physics/engine/mechanism.hpp"

namespace ergotic::physics {

/// Audio frames that are stepped as one: a single one where modules run, all of a tick where they
/// are held.
struct Frames {
  std::int64_t first = 0;
  int count = 1;
  const double* inputs = nullptr;  ///< [count][input channels]
  double* outputs = nullptr;       ///< [count][channels of the group], added to
};

/// Copies the motion of held modules into the group's proxies of them. Realtime: yes
template <class Real>
void fillProxies(const Group& group, State<Real>& state) noexcept {
  for (const Proxy& proxy : group.proxies) {
    state.x()[proxy.slot] = state.x()[proxy.of];
    state.d()[proxy.slot] = state.d()[proxy.of];
    state.moved()[proxy.slot] = state.moved()[proxy.of];
  }
}

/// Adds the forces on proxies to the held modules that they stand for. Realtime: yes
template <class Real>
void emptyProxies(const Group& group, State<Real>& state) noexcept {
  Real* f = state.f();
  for (const Proxy& proxy : group.proxies) {
    f[proxy.of] += f[proxy.slot];
    f[proxy.slot] = Real(0);
  }
}

/// Steps one group at a time. Groups share nothing that a step writes, so several threads may each
/// step another. Realtime: yes, all but the constructor
template <class Real>
class GroupStepper {
 public:
  GroupStepper(const Rates& rates, Mechanism<Real>& mechanism)
      : mechanism_(mechanism),
        rates_(rates),
        channels_in_(static_cast<std::size_t>(mechanism.scene->inputChannels())),
        followed_(mechanism.layout.followers.empty() ? scene::Scene{} : *mechanism.scene) {}

  /// Steps the blocks on which nothing else acts meanwhile through a whole tick.
  void advanceLoneBlocks(const Group& group, const Frames& tick) noexcept {
    for (const LoneBlock& lone : group.lone) {
      const int section = mechanism_.layout.blocks[lone.block].section;
      const int divisor = mechanism_.layout.sections[static_cast<std::size_t>(section)].divisor;
      // Divisors of sections that run divide the frames of a tick.
      const double lost = mechanism_.stepper.advance(
          lone.block, tick.count / divisor, *mechanism_.coefficients, mechanism_.state,
          [&](int step, int first, int last) noexcept {
            mechanism_.touches.pressLone(first, last, tick.first + (step + 1) * divisor - 1,
                                         *mechanism_.coefficients, mechanism_.meter,
                                         mechanism_.state);
            for (int r = step * divisor; r < (step + 1) * divisor; ++r) {
              hearLoneBlock(lone, tick.first + r, first, last, outputsOf(group, tick, r));
            }
          });
      mechanism_.meter.addDissipated(section, lost, mechanism_.state);
    }
  }

  /// Modules move, positions are heard, explicit links give their forces.
  void begin(const Group& group, const Frames& frames) noexcept {
    followAudio(group, frames.inputs);
    moveModules(group, frames.first);
    feedPositions(group, frames);
    gatherPoints(group, frames.first);
    for (int k = 0; k < frames.count; ++k) {
      mechanism_.pickups.takePositions(group, *mechanism_.coefficients, mechanism_.state,
                                       outputsOf(group, frames, k));
    }
    for (const std::size_t r : group.runs) {
      const LinkRun& run = mechanism_.layout.runs[r];
      if (mechanism_.layout.isDue(run.section, frames.first) && !isAsleep(run)) {
        mechanism_.stepper.stepLinks(r, mechanism_.coefficients->runs[r], frames.first,
                                     mechanism_.state);
      }
    }
  }

  /// Inputs, hands and energy-stable links give theirs, forces are heard and counted.
  /// \pre those of all other groups on this one are there
  void end(const Group& group, const Frames& frames) noexcept {
    State<Real>& state = mechanism_.state;
    const std::int64_t last = frames.first + frames.count - 1;
    for (int k = 0; k < frames.count; ++k) {
      feedForces(group, inputsOf(frames, k));
    }
    mechanism_.points.scatter(group, state);
    mechanism_.touches.press(group, last, *mechanism_.coefficients, mechanism_.meter, state);
    mechanism_.energy_stable.step(group, frames.first, last, *mechanism_.coefficients,
                                  mechanism_.stepper, state);
    mechanism_.meter.endFrame(group, last, state);
    mechanism_.interpolation.collect(group, last, state);
    mechanism_.interpolation.answer(group, last, state);
    mechanism_.points.endFrame(group, *mechanism_.coefficients, last, state);
    for (int k = 0; k < frames.count; ++k) {
      mechanism_.pickups.takeForces(group, *mechanism_.coefficients, frames.first + k, state,
                                    outputsOf(group, frames, k));
    }
    mechanism_.sleeper.endFrames(
        group, frames.first, *mechanism_.coefficients, mechanism_.meter, state,
        [this](int section) noexcept { return mechanism_.touches.holdsIn(section); });
  }

  /// Something outside moves a module.
  void moveTo(int slot, Real position, bool was_there) noexcept {
    State<Real>& state = mechanism_.state;
    state.dLast()[slot] = state.d()[slot];
    state.d()[slot] = was_there ? Real(0) : position - state.x()[slot];
    state.x()[slot] = position;
  }

 private:
  const double* inputsOf(const Frames& frames, int k) const noexcept {
    return frames.inputs + static_cast<std::size_t>(k) * channels_in_;
  }
  static double* outputsOf(const Group& group, const Frames& frames, int k) noexcept {
    return frames.outputs + static_cast<std::size_t>(k) * group.channels.size();
  }

  void hearLoneBlock(
      const LoneBlock& lone, std::int64_t now, int first, int last, double* out) noexcept {
    for (std::size_t i = 0; i < lone.pickups.size(); ++i) {
      const std::size_t k = lone.pickups[i];
      const int slot = mechanism_.pickups.slotOf(k);
      if (slot >= first && slot < last) {
        out[lone.pickup_columns[i]] +=
            mechanism_.pickups.position(k, *mechanism_.coefficients, mechanism_.state) +
            mechanism_.pickups.force(k, *mechanism_.coefficients, now, mechanism_.state);
      }
    }
  }

  bool isAsleep(const LinkRun& run) const noexcept {
    return run.section_a == run.section_b && mechanism_.state.asleep()[run.section_a] != 0;
  }

  /// Updates, for this frame, the coefficients that follow an audio input.
  void followAudio(const Group& group, const double* in) noexcept {
    if (group.followers.empty()) {
      return;
    }
    for (scene::AudioParameter& parameter : followed_.audio_parameters) {
      parameter.value = parameter.at(in[parameter.channel]);
    }
    for (const std::size_t k : group.followers) {
      mechanism_.coefficients->follow(followed_, rates_, mechanism_.layout,
                                      mechanism_.layout.followers[k]);
    }
  }

  void moveModules(const Group& group, std::int64_t now) noexcept {
    State<Real>& state = mechanism_.state;
    for (const int section : group.sections) {
      if (mechanism_.layout.isDue(section, now) && state.asleep()[section] == 0) {
        const double lost = mechanism_.stepper.moveMasses(section, *mechanism_.coefficients, state);
        mechanism_.meter.addDissipated(section, lost, state);
      }
    }
  }

  void feedPositions(const Group& group, const Frames& frames) noexcept {
    for (const std::size_t k : group.feeds) {
      const Feed& feed = mechanism_.layout.feeds[k];
      if (feed.quantity == scene::Quantity::kPosition &&
          mechanism_.layout.isDue(feed.section, frames.first)) {
        const double gain = static_cast<double>(mechanism_.coefficients->feed_gains[k]);
        const double position = gain * frames.inputs[feed.channel] - feed.rest;
        moveTo(feed.slot, static_cast<Real>(position), false);
      }
    }
  }

  void feedForces(const Group& group, const double* in) noexcept {
    for (const std::size_t k : group.feeds) {
      const Feed& feed = mechanism_.layout.feeds[k];
      if (feed.quantity == scene::Quantity::kForce) {
        const Real force = mechanism_.coefficients->feed_gains[k] *
                           static_cast<Real>(in[feed.channel]) * static_cast<Real>(feed.share);
        mechanism_.state.f()[feed.slot] += force;
        mechanism_.meter.addFeed(k, force, mechanism_.state);
      }
    }
  }

  void gatherPoints(const Group& group, std::int64_t now) noexcept {
    State<Real>& state = mechanism_.state;
    if (!mechanism_.layout.places.empty()) {
      for (const int section : group.sections) {
        const SectionRange& range = mechanism_.layout.sections[static_cast<std::size_t>(section)];
        if (mechanism_.layout.isDue(section, now)) {
          std::copy_n(state.d() + range.first, range.dimensions * range.stride,
                      state.moved() + range.first);
        }
      }
    }
    mechanism_.interpolation.gather(group, now, state);
    mechanism_.points.gather(group, *mechanism_.coefficients, now, state);
    mechanism_.points.clearForces(group, state.f());
  }

  Mechanism<Real>& mechanism_;
  const Rates rates_;
  const std::size_t channels_in_;
  scene::Scene followed_;  // where audio parameters have their present samples
};

}  // namespace ergotic::physics
