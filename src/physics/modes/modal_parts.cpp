// SPDX-License-Identifier: BSD-3-Clause
#include "physics/modes/modal_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "at.hpp"
#include "physics/disjoint_sets.hpp"
#include "physics/laws/oscillator.hpp"
#include "physics/network/load_matrix.hpp"
#include "physics/note.hpp"
#include "physics/step_units.hpp"
#include "scene/laws/bend_parts.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;
using scene::MatType;

constexpr double kSame = 1e-9;       // of numbers that are meant to be equal
constexpr double kLossShare = 0.38;  // of losses in what decides about modes; nothing special

bool isConstant(const scene::Value& v) {
  return v.parameter < 0 && v.audio < 0;
}

bool isClose(double a, double b) {
  return std::abs(a - b) <= kSame * std::max(std::abs(a), std::abs(b));
}

bool isPositive(const Eigen::SparseMatrix<double>& matrix) {
  for (int column = 0; column < matrix.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, column); it; ++it) {
      if (it.value() > 0.0) {
        return true;
      }
    }
  }
  return false;
}

StepUnits unitsOf(const scene::Scene& scene, const Rates& rates, int section) {
  return {scene, rates, divisorOf(scene.sections[at(section)], rates)};
}

/// Damping of a link whose coefficients are constant.
double dampingOf(const Network::Link& link) {
  return link.slopes.damping.highest;
}

class Finder {
 public:
  Finder(const Network& network, const Rates& rates, int section)
      : network_(network),
        scene_(network.scene),
        rates_(rates),
        section_(section),
        units_(unitsOf(scene_, rates, section)),
        is_heard_(network.nodes.size(), 0) {
    found_.part_of.assign(network.nodes.size(), -1);
    found_.row_of.assign(network.nodes.size(), -1);
    found_.is_in.assign(network.links.size(), 0);
    for (const scene::Output& output : scene_.outputs) {
      if (output.quantity == scene::Quantity::kForce) {
        is_heard_[at(output.point.mat)] = 1;
      }
    }
  }

  LinearParts run() {
    std::vector<int> others;
    for (LinearPart& part : gather(springs())) {
      if (sharesModes(part)) {
        keep(std::move(part));
      } else {
        others.insert(others.end(), part.lias.begin(), part.lias.end());
      }
    }
    // Those may do without the links that are damped in a way of their own.
    const double ratio = commonRatio(others);
    std::vector<int> alike;
    for (const int l : others) {
      if (isClose(ratioOf(l), ratio)) {
        alike.push_back(l);
      } else {
        offend(lia(l).place, "link '" + lia(l).name + "' has damping / stiffness = " +
                                 shortly(ratioOf(l)) + ", most have " + shortly(ratio) +
                                 ": modes need the same everywhere, or an even net");
      }
    }
    for (LinearPart& part : gather(alike)) {
      if (sharesModes(part)) {
        keep(std::move(part));
      } else {
        offendByModule(part, ratio / units_.step);
      }
    }
    return std::move(found_);
  }

 private:
  const scene::Lia& lia(int l) const { return scene_.lias[at(l)]; }
  const scene::Mat& mat(int m) const { return scene_.mats[at(m)]; }
  bool isFree(int m) const { return network_.nodes[at(m)].is_free; }
  double ratioOf(int l) const {
    const Network::Link& link = network_.links[at(l)];
    return dampingOf(link) / link.at_rest;
  }

  void offend(const scene::Place& place, const std::string& what) {
    ++found_.offences;
    if (!found_.offence) {
      found_.offence = Offence{place, what};
    }
  }

  bool hasConstants(int m) const {
    return isConstant(mat(m).mass) && isConstant(mat(m).stiffness) && isConstant(mat(m).damping) &&
           isConstant(scene_.sections[at(section_)].medium);
  }

  /// Free modules, and grounds on which no force is to be heard.
  bool canEnd(int m) {
    if (mat(m).section != section_ || (mat(m).type == MatType::kGround && is_heard_[at(m)] != 0)) {
      return false;
    }
    if (!isFree(m)) {
      return mat(m).type == MatType::kGround;
    }
    if (!hasConstants(m)) {
      offend(mat(m).place, "module '" + mat(m).name +
                               "' or its medium follows a parameter: modes need constants");
      return false;
    }
    if (is_heard_[at(m)] != 0) {
      offend(mat(m).place, "the force on module '" + mat(m).name +
                               "' is an output: modes do not tell the forces between modules");
      return false;
    }
    return true;
  }

  /// Springs with constant coefficients between modules of the section.
  std::vector<int> springs() {
    std::vector<int> found;
    for (int l = 0; l < static_cast<int>(scene_.lias.size()); ++l) {
      const bool is_spring = lia(l).type == LiaType::kSpringDamper &&
                             (lia(l).stiffness.factor != 0.0 || !isConstant(lia(l).stiffness));
      if (!is_spring || !canEnd(lia(l).a) || !canEnd(lia(l).b) ||
          (!isFree(lia(l).a) && !isFree(lia(l).b))) {
        continue;
      }
      if (isConstant(lia(l).stiffness) && isConstant(lia(l).damping)) {
        found.push_back(l);
      } else {
        offend(lia(l).place, "link '" + lia(l).name +
                                 "' follows a parameter, and modes need constants. Give it a "
                                 "number, or leave out 'modes'");
      }
    }
    return found;
  }

  /// Damping over stiffness of most links, time units.
  double commonRatio(const std::vector<int>& candidates) const {
    std::vector<double> ratios;
    for (const int l : candidates) {
      ratios.push_back(ratioOf(l));
    }
    std::sort(ratios.begin(), ratios.end());
    double best = 0.0;
    std::size_t most = 0;
    for (std::size_t first = 0; first < ratios.size();) {
      std::size_t last = first;
      while (last < ratios.size() && isClose(ratios[last], ratios[first])) {
        ++last;
      }
      if (last - first > most) {
        most = last - first;
        best = ratios[first];
      }
      first = last;
    }
    return best;
  }

  /// Modules that these springs join, part by part.
  std::vector<LinearPart> gather(const std::vector<int>& lias) {
    DisjointSets sets(scene_.mats.size());
    std::vector<unsigned char> is_joined(scene_.mats.size(), 0);
    for (const int l : lias) {
      for (const int end : {lia(l).a, lia(l).b}) {
        is_joined[at(end)] = isFree(end) ? 1 : 0;
      }
      if (isFree(lia(l).a) && isFree(lia(l).b)) {
        sets.join(lia(l).a, lia(l).b);
      }
    }
    std::map<int, LinearPart> by_set;
    for (int m = 0; m < static_cast<int>(scene_.mats.size()); ++m) {
      if (is_joined[at(m)] != 0) {
        LinearPart& part = by_set[sets.setOf(m)];
        found_.row_of[at(m)] = static_cast<int>(part.mats.size());
        part.mats.push_back(m);
      }
    }
    for (const int l : lias) {
      const int free_end = isFree(lia(l).a) ? lia(l).a : lia(l).b;
      by_set[sets.setOf(free_end)].lias.push_back(l);
    }
    std::vector<LinearPart> parts;
    for (auto& [name, part] : by_set) {
      parts.push_back(std::move(part));
    }
    return parts;
  }

  /// Both matrices have the same eigenvectors if their order does not matter: entry by entry, as
  /// what is soft has small ones.
  bool sharesModes(const LinearPart& part) const {
    const PartMatrices matrices = matricesOf(network_, rates_, found_.row_of, part);
    using Sparse = Eigen::SparseMatrix<double>;
    const Sparse pull = matrices.pull.cwiseAbs();
    const Sparse loss = matrices.loss.cwiseAbs();
    const Sparse one = matrices.pull * matrices.loss;
    const Sparse other = matrices.loss * matrices.pull;
    const Sparse apart = (one - other).cwiseAbs();
    const Sparse parts = Sparse(pull * loss) + Sparse(loss * pull);
    return !isPositive(apart - kSame * parts);
  }

  void offendByModule(const LinearPart& part, double alpha) {
    const double first = ownDecay(part.mats.front(), alpha);
    for (const int m : part.mats) {
      const double own = ownDecay(m, alpha);
      if (!isClose(own, first)) {
        offend(mat(m).place, "module '" + mat(m).name + "' loses " + shortly(own) +
                                 " of its speed per step by itself, '" +
                                 mat(part.mats.front()).name + "' " + shortly(first) +
                                 ": modes need the same everywhere");
        return;
      }
    }
  }

  /// Loss of a module by itself per step, beyond alpha times its own spring.
  double ownDecay(int m, double alpha) const {
    const OscillatorCoefficients own = oscillatorOf(scene_, mat(m), units_);
    return own.lose - alpha * own.pull;
  }

  void keep(LinearPart part) {
    for (const int m : part.mats) {
      found_.part_of[at(m)] = static_cast<int>(found_.parts.size());
    }
    for (const int l : part.lias) {
      found_.is_in[at(l)] = 1;
    }
    found_.parts.push_back(std::move(part));
  }

  const Network& network_;
  const scene::Scene& scene_;
  Rates rates_;
  int section_;
  StepUnits units_;
  std::vector<unsigned char> is_heard_;  // [mats] the force on it is an output
  LinearParts found_;
};

int sectionOf(const scene::Scene& scene, const LinearPart& part) {
  return scene.mats[at(part.mats.front())].section;
}

/// Displacement from rest at the start, m.
double displacementOf(const scene::Mat& mat) {
  return mat.position.x() - mat.rest.x();
}

}  // namespace

LinearParts linearPartsOf(const Network& network, const Rates& rates, int section) {
  return Finder(network, rates, section).run();
}

PartMatrices matricesOf(const Network& network,
                        const Rates& rates,
                        const std::vector<int>& row_of,
                        const LinearPart& part) {
  const scene::Scene& scene = network.scene;
  const StepUnits units = unitsOf(scene, rates, sectionOf(scene, part));
  const auto massOf = [&](int row) { return network.nodes[at(part.mats[at(row)])].mass.now; };
  LoadMatrix pull(static_cast<int>(part.mats.size()));
  LoadMatrix loss(static_cast<int>(part.mats.size()));
  for (const int m : part.mats) {
    const OscillatorCoefficients own = oscillatorOf(scene, scene.mats[at(m)], units);
    pull.add(row_of[at(m)], row_of[at(m)], own.pull);
    loss.add(row_of[at(m)], row_of[at(m)], own.lose);
  }
  for (const int l : part.lias) {
    const Network::Link& link = network.links[at(l)];
    const Shares ends = endsAmong(network, row_of, link);
    const auto unit = [&](const Share& a, const Share& b) {
      return a.weight * b.weight * units.step / std::sqrt(massOf(a.node) * massOf(b.node));
    };
    pull.addLoad(ends, [&](const Share& a, const Share& b) {
      return unit(a, b) * units.step * link.at_rest;
    });
    loss.addLoad(ends,
                 [&](const Share& a, const Share& b) { return unit(a, b) * dampingOf(link); });
  }
  return {pull.sum(), loss.sum()};
}

ModalMatrix mixtureOf(const PartMatrices& matrices) {
  const double pull = matrices.pull.diagonal().sum();
  const double loss = matrices.loss.diagonal().sum();
  const Eigen::SparseMatrix<double> both =
      matrices.pull + (loss > 0.0 ? kLossShare * pull / loss : 0.0) * matrices.loss;
  ModalMatrix mixture;
  mixture.size = static_cast<int>(both.rows());
  for (int column = 0; column < both.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(both, column); it; ++it) {
      if (it.row() >= column) {
        mixture.entries.push_back({static_cast<int>(it.row()), column, it.value()});
      }
    }
  }
  return mixture;
}

PartStart startOf(const Network& network,
                  const Rates& rates,
                  const std::vector<int>& row_of,
                  const LinearPart& part) {
  const scene::Scene& scene = network.scene;
  const int section = sectionOf(scene, part);
  const StepUnits units = unitsOf(scene, rates, section);
  const auto size = static_cast<Eigen::Index>(part.mats.size());
  PartStart start;
  for (Eigen::VectorXd* v : {&start.mass, &start.x, &start.velocity, &start.constant,
                             &start.first_force, &start.of_springs}) {
    v->setZero(size);
  }
  for (const int m : part.mats) {
    const scene::Mat& mat = scene.mats[at(m)];
    const int i = row_of[at(m)];
    start.mass[i] = network.nodes[at(m)].mass.now;
    start.x[i] = displacementOf(mat);
    start.velocity[i] = mat.push->velocity.x();
    start.first_force[i] = mat.push->first_force.x();
    const double pull = oscillatorOf(scene, mat, units).pull / (units.step * units.step);
    // The spring of a cell ends at 0, wherever the cell rests.
    start.constant[i] =
        mat.push->force.x() +
        start.mass[i] * (scene.sections[at(section)].gravity.x() - pull * mat.rest.x());
  }
  for (const int l : part.lias) {
    const Network::Link& link = network.links[at(l)];
    const scene::Lia& lia = scene.lias[at(l)];
    // Grounds stay where they are: what their displacement does is constant.
    const auto held = [&](int m) {
      return row_of[at(m)] >= 0 ? 0.0 : displacementOf(scene.mats[at(m)]);
    };
    const auto speed = [&](int m) {
      return row_of[at(m)] >= 0 ? scene.mats[at(m)].push->velocity.x() : 0.0;
    };
    const double k = link.at_rest;
    const double rest = scene::restApart(scene, lia).x() - lia.rest_length;
    const double constant = k * (held(lia.a) - held(lia.b) + rest);
    const double now =
        k * (displacementOf(scene.mats[at(lia.a)]) - displacementOf(scene.mats[at(lia.b)]) + rest) +
        dampingOf(link) * (speed(lia.a) - speed(lia.b));
    for (const auto& [row, sign] : endsAmong(network, row_of, link)) {
      start.constant[row] -= sign * constant;
      start.of_springs[row] -= sign * now;
    }
  }
  return start;
}

}  // namespace ergotic::physics
