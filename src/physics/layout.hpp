// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Force laws as kernels; tables are laws of their own.
enum class Law {
  kSpringDamper,
  kContact,
  kQuadratic,
  kCubic,
  kClippedCubic,
  kCubicContact,
  kPluck,
  kBow,
  kSmoothBow,
  kPluckTable,
  kBowTable,
};
Law lawOf(const scene::Lia& lia);

/// Slots of a section: cells, masses, then modules that forces do not move.
struct SectionRange {
  int divisor = 1;  ///< audio frames per step
  int cells = 0;    ///< first slot
  int masses = 0;   ///< first slot
  int fixed = 0;    ///< first slot
  int end = 0;
};

struct LinkEnds {
  int a = 0;  ///< slots
  int b = 0;
};

/// A run of links with one law, stepped with one section. Where `slow_section` is set, end a (or
/// b) belongs to that slower section: its position is held between its steps and it receives
/// `share` of the force at every step, so the mean over its own step.
struct LinkRun {
  Law law = Law::kSpringDamper;
  int section = 0;
  int slow_section = -1;
  bool slow_is_a = false;
  double share = 1.0;
  std::vector<int> lias;       ///< [links] index in Scene::lias
  std::vector<LinkEnds> ends;  ///< [links]
};

struct Tap {
  scene::Quantity quantity = scene::Quantity::kPosition;
  int slot = 0;
  int next = -1;
  double fraction = 0.0;
  double rest = 0.0;      ///< added to displacements, m
  double velocity = 1.0;  ///< from step difference to m/time_unit
  int divisor = 1;        ///< of the module's section
  int channel = 0;
};

struct Feed {
  scene::Quantity quantity = scene::Quantity::kForce;
  int slot = 0;
  double rest = 0.0;
  int section = 0;
  double share = 1.0;  ///< 1 / divisor: forces on slow modules are averaged
  int channel = 0;
};

/// A link or a module whose coefficients follow an audio input.
struct Follower {
  int run = 0;    ///< index in Layout::runs; -1: a module
  int index = 0;  ///< of the link in its run, or slot of the module
  int section = 0;
};

/// Where everything of a scene lies in the arrays of an instrument.
struct Layout {
  std::vector<int> slot_of_mat;
  std::vector<int> mat_of_slot;
  std::vector<SectionRange> sections;
  std::vector<LinkRun> runs;
  std::vector<int> port_slots;
  std::vector<Tap> taps;
  std::vector<Feed> feeds;
  std::vector<Follower> followers;
  int slots() const { return static_cast<int>(mat_of_slot.size()); }
};

/// \throws Exception if links join sections whose divisors do not divide one another
Layout makeLayout(const scene::Scene& scene, const Rates& rates);

}  // namespace ergotic::physics
