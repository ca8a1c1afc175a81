// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support/physics.hpp"

namespace ergotic::physics {

/// An orchestra: strings in sections of their own, with what two hands, slow masses, inputs and
/// each other do to them.
class Orchestra {
 public:
  explicit Orchestra(int strings) {
    const int hands[2] = {b_.slice(0), b_.slice(1)};
    const int bridge = addBridge();
    for (int s = 0; s < strings; ++s) {
      const int first = addString(12 + 3 * (s % 4));
      hit(hands[s % 2], first + 5);
      b_.spring(bridge, first + 2, 40.0, 0.01);
      const int finger = addPoint(s, hands[(s + 1) % 2]);
      b_.link(scene::LiaType::kSpringDamper, finger, hands[0], 300.0, 0.01);
      b_.hear(first + 4, s % 3);
      b_.hear(first + 3, (s + 1) % 3, scene::Quantity::kVelocity);
      b_.hear(first + 1, s % 2, scene::Quantity::kForce);
      push(first + 6, 0);
      strings_.push_back(first);
    }
    b_.hear(bridge, 0, scene::Quantity::kForce);
    b_.hear(bridge, 1);
    push(bridge, 1);
    addSleeper(hands[0]);
    bow(strings_[0], strings_[1]);
  }

  /// The first spring of the last string follows a channel.
  void addFollower() {
    b_.scene.audio_parameters.push_back({"k", 1, 0.0, {}});
    for (scene::Lia& lia : b_.scene.lias) {
      if (lia.a == strings_.back() && lia.b == strings_.back() + 1) {
        lia.stiffness = {1e4, -1, 0};
      }
    }
  }

  scene::Scene scene() const { return b_.scene; }

 private:
  int addSection(const std::string& name) {
    scene::Section section = b_.scene.sections[0];
    section.name = name;
    b_.scene.sections.push_back(section);
    return static_cast<int>(b_.scene.sections.size()) - 1;
  }

  void moveTo(int section, int first) {
    for (std::size_t m = at(first); m < b_.scene.mats.size(); ++m) {
      b_.scene.mats[m].section = section;
    }
  }

  int addBridge() {
    const int mass = b_.mass(0.05, 0.0, 0.1, SceneBuilder::kGestural);
    b_.spring(mass, b_.ground(0.0, SceneBuilder::kGestural), 1000.0, 0.1);
    return mass;
  }

  int addString(int masses) {
    const int section = addSection("string" + std::to_string(b_.scene.sections.size()));
    const int first = b_.chain(masses, 1e-3, 2e4, 1e-3);
    moveTo(section, first);
    b_.scene.mats[at(first + 3)].push.edit().velocity.x() = 1.0;
    b_.scene.grids.push_back({"g" + std::to_string(section), first, masses + 2, 1});
    return first;
  }

  /// A finger on the last string, led along it by a hand.
  int addPoint(int grid, int guide) {
    const int m = b_.point(grid, 0.5);
    b_.scene.connections.back().along.guide = guide;
    b_.scene.connections.back().along.scale = 100.0;
    return m;
  }

  void hit(int hand, int mass) {
    const int contact = b_.link(scene::LiaType::kContact, mass, hand, 5e3, 0.01);
    b_.scene.lias[at(contact)].law.edit().width = {1e-3};
    b_.scene.lias[at(contact)].scheme = scene::Scheme::kEnergyStable;
  }

  void push(int mat, int channel) { b_.scene.inputs[at(b_.push(mat, channel))].gain = {0.1}; }

  void addSleeper(int hand) {
    const int section = addSection("sleeper");
    const int first = b_.cell(1e-3, 100.0, 0.05);
    moveTo(section, first);
    b_.scene.mats[at(first)].push.edit().velocity.x() = 0.01;
    b_.scene.sections[at(section)].sleep_energy = 1e-9;
    const int contact = b_.link(scene::LiaType::kContact, first, hand, 100.0);
    b_.scene.lias[at(contact)].law.edit().width = {-5e-4};
    b_.hear(first, 2);
  }

  /// Makes one group of two strings.
  void bow(int one, int other) {
    const int friction = b_.link(scene::LiaType::kSmoothBow, one + 7, other + 7, 0.0, 0.2);
    b_.scene.lias[at(friction)].law.edit().width = {0.1};
    b_.scene.lias[at(friction)].scheme = scene::Scheme::kEnergyStable;
  }

  SceneBuilder b_;
  std::vector<int> strings_;
};

}  // namespace ergotic::physics
