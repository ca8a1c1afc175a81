// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/rounding_noise.hpp"

#include <algorithm>
#include <cmath>

#include "at.hpp"
#include "physics/disjoint_sets.hpp"
#include "physics/network/network.hpp"
#include "physics/network/section_stiffness.hpp"
#include "physics/note.hpp"
#include "scene/laws/bend_parts.hpp"

namespace ergotic::physics {
namespace {

constexpr double kRounding =
    1.0 / (1 << 24);              // rms, of a distance, with what is worked out from it
constexpr double kMinute = 60.0;  // s
constexpr double kTold = 0.05;    // m/s
constexpr double kApart = 1e-9;   // of weights

/// Modules that are joined.
struct Part {
  double mass = 0.0;   // kg
  double power = 0.0;  // W that rounding gives
  double loss = 0.0;   // kg/s, of motion that is alike everywhere
  double farthest = 0.0;
  int first = -1;                                      // module
  bool is_held = false;                                // by what does not move
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();  // kg m/s
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();    // N
  double displaced = 0.0;                              // at the start, m

  /// How far it flies and falls in a minute, rms, m.
  double way() const {
    return is_held ? 0.0
                   : displaced + (momentum / mass).norm() * kMinute / std::sqrt(3.0) +
                         0.5 * (weight / mass).norm() * kMinute * kMinute / std::sqrt(5.0);
  }

  /// Speed after a minute, rms, m/s.
  double speed() const {
    const double rate = loss / mass;  // of energy, of which half is motion
    const double time = rate * kMinute > 1e-9 ? -std::expm1(-rate * kMinute) / rate : kMinute;
    return std::sqrt(power * time / mass);
  }
};

/// Length that a spring computes before it takes a difference, at rest, m: in Euclidean sections
/// the distance of its ends, in scalar ones only its elongation there.
double distanceOf(const scene::Scene& scene, const scene::Lia& lia) {
  const Eigen::Vector3d apart = scene::restApart(scene, lia);
  const scene::Geometry geometry = scene.sectionOf(scene.mats[at(lia.a)]).geometry;
  return geometry == scene::Geometry::kScalar ? std::abs(apart.x() - lia.rest_length)
                                              : movingPart(apart, geometry).norm();
}

class RoundingNoise {
 public:
  RoundingNoise(const scene::Scene& scene, const Rates& rates)
      : network_(scene),
        rates_(rates),
        joined_(network_.nodes.size()),
        parts_(network_.nodes.size()) {
    for (const Network::Link& link : network_.links) {
      for (const Share& share : endsOf(link)) {
        joined_.join(share.node, endsOf(link).front().node);
      }
    }
    for (std::size_t m = 0; m < network_.nodes.size(); ++m) {
      addModule(static_cast<int>(m));
    }
    for (const Network::Link& link : network_.links) {
      hold(link);
    }
    for (std::size_t l = 0; l < network_.links.size(); ++l) {
      addLink(network_.links[l], scene.lias[l]);
    }
  }

  const std::vector<Part>& parts() const { return parts_; }

 private:
  Shares endsOf(const Network::Link& link) const {
    Shares ends = sharesNow(network_, link.a);
    for (const Share& share : sharesNow(network_, link.b)) {
      ends.push_back({share.node, -share.weight});
    }
    return ends;
  }

  Part& partOf(int node) { return parts_[at(joined_.setOf(node))]; }

  void addModule(int m) {
    const Network::Node& node = network_.nodes[at(m)];
    if (node.is_free) {
      const double unit = network_.scene.time_unit_s;
      const scene::Mat& mat = network_.scene.mats[at(m)];
      const scene::Section& section = network_.scene.sectionOf(mat);
      Part& part = partOf(m);
      part.first = part.first < 0 ? m : part.first;
      part.mass += node.mass.now;
      part.loss += node.damping.now / unit;
      part.is_held = part.is_held || node.stiffness.now > 0.0;
      part.momentum += node.mass.now / unit * movingPart(mat.push->velocity, section.geometry);
      part.weight += (node.mass.now * section.gravity + mat.push->force) / (unit * unit);
      part.displaced =
          std::max(part.displaced, movingPart(mat.position - mat.rest, section.geometry).norm());
    }
  }

  /// Marks a part as held if a link joins it to something that no force moves.
  void hold(const Network::Link& link) {
    const Shares ends = endsOf(link);
    double sum = 0.0;
    for (const Share& share : ends) {
      sum += share.weight;
    }
    if (!ends.empty() && std::abs(sum) > kApart) {
      partOf(ends[0].node).is_held = true;
    }
  }

  /// A force of noise f gives f^2 h / 2M a second.
  void addLink(const Network::Link& link, const scene::Lia& lia) {
    const Shares ends = endsOf(link);
    if (ends.empty()) {
      return;
    }
    const double unit = network_.scene.time_unit_s;
    const scene::Section& section =
        network_.scene.sections[at(network_.nodes[at(ends[0].node)].section)];
    const double step_hz = rates_.audio_hz / divisorOf(section, rates_);
    Part& part = partOf(ends[0].node);
    const double distance = distanceOf(network_.scene, lia) + part.way();
    const double force = link.at_rest / (unit * unit) * kRounding * distance;
    double whole = 0.0;  // of what moves all of it alike
    for (const Share& share : ends) {
      const double mass = network_.nodes[at(share.node)].mass.now;
      part.power += 0.5 * share.weight * share.weight * force * force / (mass * step_hz);
      whole += share.weight;
    }
    part.loss += whole * whole * network_.scene.valueOf(lia.damping) / unit;
    part.farthest = link.at_rest > 0.0 ? std::max(part.farthest, distance) : part.farthest;
  }

  Network network_;
  const Rates& rates_;
  DisjointSets joined_;
  std::vector<Part> parts_;  // [nodes] by the module that names them
};

}  // namespace

std::vector<std::string> notesOnRounding(const scene::Scene& scene, const Rates& rates) {
  std::vector<std::string> notes;
  const RoundingNoise noise(scene, rates);
  for (const Part& part : noise.parts()) {
    if (part.power > 0.0 && part.speed() > kTold) {
      const scene::Mat& mat = scene.mats[at(part.first)];
      notes.push_back(noteAt(scene, mat.place) + "single precision rounds distances of up to " +
                      shortly(part.farthest) + " m, which moves all that is joined with '" +
                      mat.name.str() + "' by up to about " + shortly(part.speed()) +
                      " m/s after a minute; double precision or more loss keeps it quiet");
    }
  }
  return notes;
}

}  // namespace ergotic::physics
