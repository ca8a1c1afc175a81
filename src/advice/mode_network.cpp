// SPDX-License-Identifier: BSD-3-Clause
#include "advice/mode_network.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "at.hpp"
#include "physics/disjoint_sets.hpp"
#include "physics/laws/oscillator.hpp"
#include "physics/network/load_matrix.hpp"
#include "physics/network/section_stiffness.hpp"
#include "physics/step_units.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::Geometry;
using scene::Scene;

/// The end of a link, seen from the section in which the link acts.
struct View {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();   // rows: its axes; columns: those of the end
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  // where the end rests
};

/// Stiffness and damping of a link in one direction.
struct Direction {
  Eigen::Vector3d along;
  double stiffness = 0.0;
  double damping = 0.0;
};

class Assembler {
 public:
  Assembler(const Network& network,
            const Rates& rates,
            int divisor,
            const std::vector<unsigned char>& is_heard)
      : network_(network),
        scene_(network.scene),
        rates_(rates),
        is_heard_(is_heard),
        units_(scene_, rates, divisor) {
    found_.divisor = divisor;
    found_.step_s = units_.step * scene_.time_unit_s;
    found_.row_of.assign(scene_.mats.size(), -1);
  }

  ModeNetwork run() {
    for (int m = 0; m < static_cast<int>(scene_.mats.size()); ++m) {
      addModule(m);
    }
    for (int l = 0; l < static_cast<int>(scene_.lias.size()); ++l) {
      if (scene_.lias[at(l)].bend < 0) {
        addLink(l);
      }
    }
    for (int b = 0; b < static_cast<int>(scene_.bends.size()); ++b) {
      addBend(b);
    }
    return std::move(found_);
  }

 private:
  const scene::Mat& mat(int m) const { return scene_.mats[at(m)]; }
  bool isHere(int m) const { return divisorOf(scene_.sectionOf(mat(m)), rates_) == found_.divisor; }
  int dimensionsAt(int m) const { return scene::dimensionsOf(scene_.sectionOf(mat(m)).geometry); }

  void addModule(int m) {
    if (!network_.nodes[at(m)].is_free || !isHere(m)) {
      return;
    }
    found_.row_of[at(m)] = found_.rows();
    const OscillatorCoefficients own = oscillatorOf(scene_, mat(m), units_);
    for (int axis = 0; axis < dimensionsAt(m); ++axis) {
      if (own.pull != 0.0 || own.lose != 0.0) {
        ModeLoad load;
        load.ends = {{found_.rows(), 1.0}};
        load.pull = own.pull;
        load.loss = own.lose;
        found_.loads.push_back(std::move(load));
      }
      found_.mat_of.push_back(m);
      found_.root_mass.push_back(std::sqrt(network_.nodes[at(m)].mass.now));
    }
  }

  View viewOf(int m, const scene::Section& frame, bool is_own) const {
    const scene::Section& own = scene_.sectionOf(mat(m));
    const int from = scene::dimensionsOf(own.geometry);
    const int to = scene::dimensionsOf(frame.geometry);
    const Eigen::Isometry3d pose =
        is_own ? Eigen::Isometry3d::Identity() : frame.pose.inverse() * own.pose;
    View view;
    view.turn.topLeftCorner(to, from) = pose.linear().topLeftCorner(to, from);
    view.place.head(to) = (pose * movingPart(mat(m).rest, own.geometry)).head(to);
    return view;
  }

  /// Directions of a link: along the line between its ends, and across it as far as it is
  /// stretched.
  static std::vector<Direction> directionsOf(const Eigen::Vector3d& line,
                                             int dimensions,
                                             double rest_length,
                                             const Direction& spring) {
    if (dimensions == 1) {
      return {{Eigen::Vector3d::UnitX(), spring.stiffness, spring.damping}};
    }
    std::vector<Direction> directions;
    const double length = line.norm();
    if (!(length > 0.0)) {
      for (int axis = 0; axis < dimensions && rest_length == 0.0; ++axis) {
        directions.push_back({Eigen::Vector3d::Unit(axis), spring.stiffness, 0.0});
      }
      return directions;
    }
    const Eigen::Vector3d along = line / length;
    const Eigen::Vector3d across =
        dimensions == 2 ? Eigen::Vector3d(-along.y(), along.x(), 0.0) : along.unitOrthogonal();
    const double held = spring.stiffness * (1.0 - rest_length / length);
    directions.push_back({along, spring.stiffness, spring.damping});
    directions.push_back({across, held, 0.0});
    if (dimensions == 3) {
      directions.push_back({along.cross(across), held, 0.0});
    }
    return directions;
  }

  void addEnd(int m, const Eigen::Vector3d& along, double sign, Shares& ends) const {
    for (const auto& [node, weight] : sharesNow(network_, m)) {
      const int row = found_.row_of[at(node)];
      for (int axis = 0; row >= 0 && axis < dimensionsAt(m); ++axis) {
        const double share = sign * weight * along[axis];
        if (share != 0.0) {
          ends.push_back({row + axis, share / found_.root_mass[at(row + axis)]});
        }
      }
    }
  }

  void hear(int m, const Eigen::Vector3d& force) {
    if (is_heard_[at(m)] != 0) {
      found_.forces.push_back({m, static_cast<int>(found_.loads.size()), force});
    }
  }

  void addLink(int l) {
    const scene::Lia& lia = scene_.lias[at(l)];
    const scene::Law& law = scene::lawOf(lia.type);
    const Direction spring{Eigen::Vector3d::Zero(), network_.links[at(l)].at_rest,
                           law.has_linear_part ? scene_.valueOf(lia.damping) : 0.0};
    if ((spring.stiffness == 0.0 && spring.damping == 0.0) || (!isHere(lia.a) && !isHere(lia.b))) {
      return;
    }
    const bool is_plain = mat(lia.a).section == mat(lia.b).section;
    const bool in_a = dimensionsAt(lia.a) <= dimensionsAt(lia.b);
    const scene::Section& frame = scene_.sectionOf(mat(in_a ? lia.a : lia.b));
    const bool is_scalar = scene_.sectionOf(mat(lia.a)).geometry == Geometry::kScalar &&
                           scene_.sectionOf(mat(lia.b)).geometry == Geometry::kScalar;
    const View a = viewOf(lia.a, frame, is_plain || is_scalar || in_a);
    const View b = viewOf(lia.b, frame, is_plain || is_scalar || !in_a);
    bool is_there = false;
    for (const Direction& one : directionsOf(a.place - b.place, scene::dimensionsOf(frame.geometry),
                                             lia.rest_length, spring)) {
      ModeLoad load;
      addEnd(lia.a, a.turn.transpose() * one.along, 1.0, load.ends);
      addEnd(lia.b, b.turn.transpose() * one.along, -1.0, load.ends);
      if (load.ends.empty()) {
        continue;
      }
      is_there = true;
      load.pull = one.stiffness * units_.step * units_.step;
      load.loss = one.damping * units_.step;
      load.lia = l;
      hear(lia.a, -one.stiffness * (a.turn.transpose() * one.along));
      hear(lia.b, one.stiffness * (b.turn.transpose() * one.along));
      found_.loads.push_back(std::move(load));
    }
    if (is_there) {
      const bool across = isHere(lia.a) != isHere(lia.b);
      const int other = isHere(lia.a) ? lia.b : lia.a;
      found_.held += across && !sharesNow(network_, other).empty() ? 1 : 0;
      found_.energy_stable += lia.scheme == scene::Scheme::kEnergyStable ? 1 : 0;
      found_.relaxing += law.kind == scene::Law::Kind::kRelaxing ? 1 : 0;
    }
  }

  void addBend(int b) {
    const scene::Bend& bend = scene_.bends[at(b)];
    const int first = bend.ends.front().mat;
    for (int axis = 0; isHere(first) && axis < dimensionsAt(first); ++axis) {
      ModeLoad load;
      const double stiffness = scene_.valueOf(bend.stiffness);
      for (const scene::Bend::End& end : bend.ends) {
        addEnd(end.mat, Eigen::Vector3d::Unit(axis), end.weight, load.ends);
      }
      if (load.ends.empty()) {
        return;
      }
      for (const scene::Bend::End& end : bend.ends) {
        hear(end.mat, -stiffness * end.weight * Eigen::Vector3d::Unit(axis));
      }
      load.pull = stiffness * units_.step * units_.step;
      load.loss = scene_.valueOf(bend.damping) * units_.step;
      load.bend = b;
      found_.loads.push_back(std::move(load));
    }
  }

  const Network& network_;
  const Scene& scene_;
  Rates rates_;
  const std::vector<unsigned char>& is_heard_;
  StepUnits units_;
  ModeNetwork found_;
};

}  // namespace

ModeNetwork modeNetworkOf(const Network& network,
                          const Rates& rates,
                          int divisor,
                          const std::vector<unsigned char>& is_heard) {
  return Assembler(network, rates, divisor, is_heard).run();
}

std::vector<ModePart> partsOf(const ModeNetwork& network) {
  DisjointSets sets(network.mat_of.size());
  for (const ModeLoad& load : network.loads) {
    for (const Share& end : load.ends) {
      sets.join(end.node, load.ends.front().node);
    }
  }
  std::map<int, int> part_of_set;
  std::vector<ModePart> parts;
  std::vector<int> place(network.mat_of.size());
  const auto partOf = [&](int row) -> ModePart& {
    const auto [known, is_new] =
        part_of_set.try_emplace(sets.setOf(row), static_cast<int>(parts.size()));
    if (is_new) {
      parts.emplace_back();
    }
    return parts[at(known->second)];
  };
  for (int row = 0; row < network.rows(); ++row) {
    ModePart& part = partOf(row);
    place[at(row)] = static_cast<int>(part.rows.size());
    part.rows.push_back(row);
  }
  for (const ModeLoad& load : network.loads) {
    ModePart& part = partOf(load.ends.front().node);
    part.loads.push_back(load);
    for (Share& end : part.loads.back().ends) {
      end.node = place[at(end.node)];
    }
  }
  for (ModePart& part : parts) {
    LoadMatrix pull(static_cast<int>(part.rows.size()));
    LoadMatrix loss(static_cast<int>(part.rows.size()));
    for (const ModeLoad& load : part.loads) {
      pull.addLoad(load.ends, [&](const Share& a, const Share& b) {
        return load.pull * (a.weight * b.weight);
      });
      if (load.loss != 0.0) {
        loss.addLoad(load.ends, [&](const Share& a, const Share& b) {
          return load.loss * (a.weight * b.weight);
        });
      }
    }
    part.pull = pull.sum();
    part.loss = loss.sum();
  }
  return parts;
}

}  // namespace ergotic::physics
