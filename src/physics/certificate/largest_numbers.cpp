// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/largest_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "at.hpp"
#include "scene/laws/law.hpp"
#include "scene/laws/range.hpp"

namespace ergotic::physics {
namespace {

constexpr double kHand = 1.0;     // m
constexpr double kLeast = 1e-30;  // m
constexpr int kDoublings = 250;
constexpr double kFall = 1.0;  // s, in which weight and inputs give energy

/// How far hands, agents and inputs move modules, m.
double farthestMoved(const scene::Scene& scene) {
  double farthest = 0.0;
  for (const scene::Port& port : scene.ports) {
    double way = kHand;
    if (port.agent >= 0) {
      for (const auto& [time, place] : scene.agents[at(port.agent)].knots) {
        way = std::max(way, std::abs(place));
      }
    }
    farthest = std::max(farthest, (way + std::abs(port.offset)) / std::abs(port.position_scale));
  }
  for (const scene::Input& input : scene.inputs) {
    const bool is_place = input.quantity == scene::Quantity::kPosition;
    farthest = std::max(farthest, is_place ? scene::largest(scene, input.gain) : 0.0);
  }
  return farthest;
}

}  // namespace

LargestNumbers::LargestNumbers(const RatedNetwork& networks)
    : networks_(networks),
      farthest_(farthestMoved(networks.scene())),
      lightest_(std::numeric_limits<double>::infinity()) {
  const scene::Scene& scene = networks.scene();
  for (std::size_t m = 0; m < scene.mats.size(); ++m) {
    const scene::Mat& mat = scene.mats[m];
    const Network::Node& node = networks.network().nodes[m];
    farthest_ = std::max(farthest_, mat.position.cwiseAbs().maxCoeff());
    if (node.is_free) {
      const double mass = node.mass.range.highest;
      energy_ += 0.5 * mass * mat.push->velocity.squaredNorm() +
                 0.5 * node.stiffness.range.highest * mat.position.squaredNorm();
      const double pull = mass * scene.sectionOf(mat).gravity.norm() + mat.push->force.norm();
      mass_ += mass;
      weight_ += pull;
      fall_ = std::max(fall_, pull / node.mass.range.lowest);
    }
    if (const double inverse = networks.inverseMass(static_cast<int>(m)); inverse > 0.0) {
      lightest_ = std::min(lightest_, 1.0 / inverse);
    }
  }
  for (const scene::Input& input : scene.inputs) {
    if (input.quantity == scene::Quantity::kForce) {
      const double push = scene::largest(scene, input.gain);
      weight_ += push;
      fall_ = std::max(fall_, push * networks.inverseMass(input.mat));
    }
  }
  for (const scene::Tap& tap : scene.taps) {
    for (const scene::Tap::Share& share : tap.shares) {
      const double weight = std::abs(share.weight);
      leverage_ = std::max({leverage_, weight, weight > 0.0 ? 1.0 / weight : 1.0});
    }
  }
  for (const scene::Lia& lia : scene.lias) {
    const double apart = 2.0 * farthest_ + std::abs(lia.rest_length);
    energy_ += 0.5 * stiffnessOf(lia, apart) * apart * apart;
  }
}

double LargestNumbers::stiffnessOf(const scene::Lia& lia, double elongation) const {
  const scene::Range k = scene::slopesAt(networks_.scene(), lia, elongation).stiffness;
  return std::max(k.highest, -k.lowest);
}

double LargestNumbers::energy() const {
  const double speed = fall_ * kFall / networks_.scene().time_unit_s;
  return energy_ + 0.5 * mass_ * speed * speed;
}

/// Where the link alone holds all energy.
double LargestNumbers::forceOf(const scene::Lia& lia) const {
  const double energy = this->energy();
  double apart = 2.0 * farthest_ + std::abs(lia.rest_length);
  double stiffness = stiffnessOf(lia, apart);
  apart = apart > 0.0 ? apart : kLeast;
  for (int i = 0; i < kDoublings && stiffness > 0.0 && stiffness * apart * apart < 2.0 * energy;
       ++i) {
    apart *= 2.0;
    stiffness = stiffnessOf(lia, apart);
  }
  const double damping = scene::largest(networks_.scene(), lia.damping);
  const double give = networks_.inverseMass(lia.a) + networks_.inverseMass(lia.b);
  return leverage_ * (stiffness * apart + damping * std::sqrt(2.0 * energy * give) + weight_);
}

double LargestNumbers::reach(double seconds) const {
  const double time = seconds / networks_.scene().time_unit_s;
  const double flown = energy_ > 0.0 ? time * std::sqrt(2.0 * energy_ / lightest_) : 0.0;
  return farthest_ + flown + 0.5 * fall_ * time * time;
}

}  // namespace ergotic::physics
