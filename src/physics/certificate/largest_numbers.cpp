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

constexpr double kHand = 1.0;   // m
constexpr double kMin = 1e-30;  // m
constexpr double kFar = 1e6;    // m, where no law is flat that holds anything
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

/// Elongation up to which a link that lets go holds its ends, m; 0 for all other links.
double lengthOfHill(const scene::Scene& scene, const scene::Lia& lia) {
  const bool is_hill = scene::lawOf(lia.type).kind == scene::Law::Kind::kElastic;
  return is_hill ? std::max(scene::largest(scene, lia.law->width), lia.law->release) : 0.0;
}

}  // namespace

LargestNumbers::LargestNumbers(const RatedNetwork& networks)
    : networks_(networks),
      farthest_(farthestMoved(networks.scene())),
      lightest_(std::numeric_limits<double>::infinity()) {
  const scene::Scene& scene = networks.scene();
  for (const scene::Section& section : scene.sections) {
    const bool is_somewhere = section.geometry != scene::Geometry::kScalar;
    const double place = section.pose.translation().cwiseAbs().maxCoeff();
    farthest_ = std::max(farthest_, is_somewhere ? place : 0.0);
  }
  for (std::size_t m = 0; m < scene.mats.size(); ++m) {
    const scene::Mat& mat = scene.mats[m];
    const Network::Node& node = networks.network().nodes[m];
    farthest_ = std::max(farthest_, mat.position.cwiseAbs().maxCoeff());
    fastest_ = std::max(fastest_, mat.push->velocity.norm());
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
    const double apart = apartAtFirst(lia);
    const double hill = lengthOfHill(scene, lia);
    energy_ += 0.5 * stiffnessOf(lia, apart) * apart * apart +
               0.5 * scene::largest(scene, lia.stiffness) * hill * hill;
  }
}

/// How far its law is from where its ends meet, too. The first step is made without it.
double LargestNumbers::apartAtFirst(const scene::Lia& lia) const {
  const bool has_gap = scene::lawOf(lia.type).kind == scene::Law::Kind::kGap;
  const double gap = has_gap ? scene::largest(networks_.scene(), lia.law->width) : 0.0;
  const double give = networks_.inverseMass(lia.a) + networks_.inverseMass(lia.b);
  const double step = give > 0.0 ? std::sqrt(networks_.inverseMassStep2(lia) / give) : 0.0;
  return 2.0 * (farthest_ + fastest_ * step) + std::abs(lia.rest_length) + gap;
}

double LargestNumbers::stiffnessOf(const scene::Lia& lia, double elongation) const {
  const scene::Range k = scene::slopesAt(networks_.scene(), lia, elongation).stiffness;
  return std::max(k.highest, -k.lowest);
}

double LargestNumbers::energy() const {
  const double speed = fall_ * kFall / networks_.scene().time_unit_s;
  return energy_ + 0.5 * mass_ * speed * speed;
}

LargestNumbers::Steepest LargestNumbers::steepestOf(const scene::Lia& lia) const {
  const double energy = this->energy();
  double apart = std::max(apartAtFirst(lia), kMin);
  double stiffness = stiffnessOf(lia, apart);  // of a curve that begins flat it may be 0
  const bool holds = stiffness > 0.0 || stiffnessOf(lia, std::max(apart, kFar)) > 0.0;
  for (int i = 0; holds && i < kDoublings && stiffness * apart * apart < 2.0 * energy; ++i) {
    apart *= 2.0;
    stiffness = stiffnessOf(lia, apart);
  }
  const scene::Range damping = scene::slopesAt(networks_.scene(), lia, apart).damping;
  return {apart, stiffness, std::max(damping.highest, -damping.lowest)};
}

double LargestNumbers::forceOf(const scene::Lia& lia) const {
  const Steepest most = steepestOf(lia);
  const double give = networks_.inverseMass(lia.a) + networks_.inverseMass(lia.b);
  return leverage_ *
         (most.stiffness * most.apart + most.damping * std::sqrt(2.0 * energy() * give) + weight_);
}

double LargestNumbers::reach(double seconds) const {
  const double time = seconds / networks_.scene().time_unit_s;
  const double flown = energy_ > 0.0 ? time * std::sqrt(2.0 * energy_ / lightest_) : 0.0;
  return farthest_ + flown + 0.5 * fall_ * time * time;
}

}  // namespace ergotic::physics
