// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/SparseCholesky>

#include "at.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/scene/grid.hpp"
#include "physics/laws/oscillator.hpp"
#include "physics/network/network.hpp"
#include "physics/note.hpp"
#include "physics/settling/steps.hpp"
#include "physics/step_units.hpp"
#include "scene/laws/energy_stable_form.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

constexpr int kMaxSteps = 400;
constexpr double kBalanced = 1e-11;    // of the largest force on a module
constexpr double kNothing = 1e-18;     // of that where it is written
constexpr double kRoundedOff = 1e-15;  // of what differs in a force
constexpr double kHeld = 1e-3;         // of the largest force: more is not held at all
constexpr double kMinPivot = 1e-12;    // of the largest: what is less may move freely
constexpr double kFirstReachM = 0.01;  // of one step; doubled as long as it is too short
constexpr double kMaxReachM = 1000.0;  // from where a module is written: beyond it falls for ever

/// A load of the network as it is at rest: f(p) along the shares of its ends.
struct Pull {
  Shares ends;          // those of end b negative
  double at_0 = 0.0;    // p where all modules are at 0
  double spring = 0.0;  // N/m; or
  std::optional<scene::EnergyStableLaw<double>> law;
};

/// Forces, their slopes, and the energy that they have.
struct Load {
  double force = 0.0;
  double slope = 0.0;
  double energy = 0.0;
};

Load loadOf(const Pull& pull, double p) {
  if (!pull.law) {
    return {pull.spring * p, pull.spring, 0.5 * pull.spring * p * p};
  }
  if (pull.law->isContact() && p <= 0.0) {
    return {};
  }
  const scene::EnergyStableForce<double> at = pull.law->push(p);
  return {at.force, at.slope, pull.law->potential(p)};
}

/// Finds where the masses and cells of some scalar sections are in balance, by Newton's method on
/// their energy, with all else at its beginning.
class Balance {
 public:
  Balance(const scene::Scene& scene, const Rates& rates) : network_(scene), scene_(scene) {
    for (std::size_t m = 0; m < scene.mats.size(); ++m) {
      const scene::Mat& mat = scene.mats[m];
      const bool is_sought = network_.nodes[m].is_free && scene.sectionOf(mat).starts_in_balance;
      row_of_.push_back(is_sought ? static_cast<int>(mats_.size()) : -1);
      if (is_sought) {
        mats_.push_back(static_cast<int>(m));
      }
    }
    for (const int m : mats_) {
      addModule(scene.mats[at(m)], rates);
    }
    addLinks(rates);
    addBends();
  }

  /// \return positions of `mats()`, m \throws TextError if there is none
  Eigen::VectorXd found() {
    Eigen::VectorXd x = start_;
    double reach = kFirstReachM;
    double damping = 0.0;
    assemble(x);
    at_first_ = largest_;
    for (int step = 0; step < kMaxSteps; ++step) {
      if (isBalanced()) {
        return x;
      }
      const double energy = energy_;
      const double off = forces_.norm();
      Eigen::VectorXd way = solved(damping);
      const double longest = way.lpNorm<Eigen::Infinity>();
      const bool is_long = longest > reach;
      way *= is_long ? reach / longest : 1.0;
      assemble(x + way);
      if (energy_ < energy || forces_.norm() < off) {
        x += way;
        reach *= is_long ? 2.0 : 1.0;
        damping *= 0.25;
      } else {
        assemble(x);
        damping = std::max(4.0 * damping, 1e-3 * stiffness_.diagonal().maxCoeff());
        reach *= 0.5;
      }
      if (!((x - start_).lpNorm<Eigen::Infinity>() < kMaxReachM)) {
        break;
      }
    }
    fail();
  }
  const std::vector<int>& mats() const { return mats_; }
  /// Force of all links on a module at a position in balance.
  double linkForce(std::size_t row, double x) const { return ground_[row] * x - constant_[row]; }

 private:
  void addModule(const scene::Mat& mat, const Rates& rates) {
    const scene::Section& section = scene_.sectionOf(mat);
    const StepUnits units(scene_, rates, divisorOf(section, rates));
    const double mass = scene_.valueOf(mat.mass);
    const double inverse = units.inverseMass(mass);
    const OscillatorCoefficients own = oscillatorOf(scene_, mat, units);
    start_.conservativeResize(start_.size() + 1);
    start_[start_.size() - 1] = mat.position.x();
    ground_.push_back(own.pull / inverse);
    constant_.push_back(mass * section.gravity.x() + mat.push->force.x());
  }

  /// What plucks or snaps in is taken as open; friction has no force at rest.
  void addLinks(const Rates& rates) {
    for (const scene::Lia& lia : scene_.lias) {
      const scene::Law& law = scene::lawOf(lia.type);
      const bool snaps = law.is_held && law.tables != scene::Law::Tables::kParts;
      if (lia.bend >= 0 || law.kind == scene::Law::Kind::kFriction || snaps) {
        continue;
      }
      Pull pull;
      pull.at_0 = addEnd(lia.a, 1.0, pull.ends) + addEnd(lia.b, -1.0, pull.ends);
      if (pull.ends.empty()) {
        continue;
      }
      requireScalar(lia);
      requireNoStretch(lia);
      pull.law = scene::EnergyStableLaw<double>::make(scene_, lia, StepUnits(scene_, rates, 1));
      pull.at_0 += pull.law->isContact() ? pull.law->length : -pull.law->length;
      pulls_.push_back(std::move(pull));
    }
  }
  void requireScalar(const scene::Lia& lia) const {
    for (const int end : {lia.a, lia.b}) {
      const scene::Section& section = scene_.sectionOf(scene_.mats[at(end)]);
      if (section.geometry != scene::Geometry::kScalar) {
        throw scene::errorAt(scene_, lia.place,
                             "link '" + std::string(lia.name) +
                                 "' joins what starts in equilibrium to section '" + section.name +
                                 "', allowed: scalar sections");
      }
    }
  }

  /// Its springs stiffen by the mean of all of them.
  void requireNoStretch(const scene::Lia& lia) const {
    if (lia.tank >= 0 && scene_.tanks[at(lia.tank)].is_mean) {
      const scene::Tank& tank = scene_.tanks[at(lia.tank)];
      throw scene::errorAt(scene_, tank.place,
                           "stretch '" + std::string(tank.name) +
                               "' stiffens what starts in equilibrium, allowed: in sections with "
                               "start: as_written");
    }
  }

  void addBends() {
    for (const scene::Bend& bend : scene_.bends) {
      Pull pull;
      pull.spring = scene_.valueOf(bend.stiffness);
      pull.at_0 = -bend.rest_length;
      for (const scene::Bend::End& end : bend.ends) {
        pull.at_0 += addEnd(end.mat, end.weight, pull.ends);
      }
      if (!pull.ends.empty()) {
        pulls_.push_back(std::move(pull));
      }
    }
  }

  /// Adds what an end moves. \return its position where all that moves is at 0
  double addEnd(int mat, double weight, Shares& ends) const {
    const int point = network_.point_of[at(mat)];
    if (point < 0) {
      return weight * addModuleEnd(mat, weight, ends);
    }
    double sum = 0.0;
    const int connections = static_cast<int>(scene_.connections.size());
    if (point < connections) {
      const scene::GridPlace place = scene::placeOf(scene_, scene_.connections[at(point)]);
      for (std::size_t i = 0; i < at(place.count); ++i) {
        const double share = weight * place.weights[i];
        sum += share * addModuleEnd(place.mats[i], share, ends);
      }
      return sum;
    }
    const scene::Tap& tap = scene_.taps[at(point - connections)];
    sum = weight * (tap.offset + scene_.mats[at(mat)].rest.x());
    for (const scene::Tap::Share& each : tap.shares) {
      const double share = weight * each.weight;
      sum += share * (addModuleEnd(each.mat, share, ends) - scene_.mats[at(each.mat)].rest.x());
    }
    return sum;
  }
  /// \return where it is if it is held, else 0
  double addModuleEnd(int mat, double weight, Shares& ends) const {
    if (row_of_[at(mat)] >= 0) {
      ends.push_back({row_of_[at(mat)], weight});
      return 0.0;
    }
    const scene::Mat& module = scene_.mats[at(mat)];
    if (module.type != scene::MatType::kSlice) {
      return module.position.x();
    }
    double place = module.rest.x();
    for (const scene::Port& port : scene_.ports) {
      const double hand = port.agent >= 0 ? scene_.agents[at(port.agent)].at(0.0) : 0.0;
      place += port.mat == mat && port.axis == 0 ? (hand - port.offset) / port.position_scale : 0.0;
    }
    return place;
  }

  /// Forces, stiffness and energy at positions.
  void assemble(const Eigen::VectorXd& x) {
    const auto rows = static_cast<int>(x.size());
    forces_ = Eigen::VectorXd::Zero(rows);
    rounding_ = 0.0;
    largest_ = 0.0;
    energy_ = 0.0;
    std::vector<Eigen::Triplet<double>> entries;
    const auto push = [&](int row, double force) {
      forces_[row] += force;
      largest_ = std::max(largest_, std::abs(force));
    };
    for (int i = 0; i < rows; ++i) {
      push(i, constant_[at(i)]);
      push(i, -ground_[at(i)] * x[i]);
      energy_ += (0.5 * ground_[at(i)] * x[i] - constant_[at(i)]) * x[i];
      entries.emplace_back(i, i, ground_[at(i)]);
    }
    for (const Pull& pull : pulls_) {
      double p = pull.at_0;
      for (const Share& end : pull.ends) {
        p += end.weight * x[end.node];
      }
      const Load load = loadOf(pull, p);
      energy_ += load.energy;
      double reached = std::abs(pull.at_0);
      for (const Share& end : pull.ends) {
        reached += std::abs(end.weight * x[end.node]);
      }
      rounding_ = std::max(rounding_, kRoundedOff * load.slope * reached);
      for (const Share& end : pull.ends) {
        push(end.node, -end.weight * load.force);
        for (const Share& other : pull.ends) {
          entries.emplace_back(end.node, other.node, load.slope * end.weight * other.weight);
        }
      }
    }
    stiffness_.resize(rows, rows);
    stiffness_.setFromTriplets(entries.begin(), entries.end());
  }

  bool isBalanced() const {
    return forces_.lpNorm<Eigen::Infinity>() <=
           std::max({kBalanced * largest_, kNothing * at_first_, rounding_});
  }

  /// Newton's step; where nothing holds, along the forces.
  Eigen::VectorXd solved(double damping) const {
    Eigen::SparseMatrix<double> matrix = stiffness_;
    const double most = std::max(stiffness_.diagonal().cwiseAbs().maxCoeff(), 1e-9 * largest_);
    for (double more = damping;; more = std::max(10.0 * more, 1e-9 * most)) {
      matrix = stiffness_;
      matrix.diagonal().array() += more;
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
      if (factors.info() == Eigen::Success &&
          factors.vectorD().minCoeff() > kMinPivot * factors.vectorD().maxCoeff()) {
        return factors.solve(forces_);
      }
      if (more > 1e3 * most) {
        return forces_ / most;
      }
    }
  }

  [[noreturn]] void fail() const {
    Eigen::Index worst = 0;
    forces_.cwiseAbs().maxCoeff(&worst);
    const scene::Mat& mat = scene_.mats[at(mats_[static_cast<std::size_t>(worst)])];
    const scene::Section& section = scene_.sectionOf(mat);
    if (std::abs(forces_[worst]) < kHeld * largest_) {
      throw scene::errorAt(scene_, section.place,
                           "section '" + section.name +
                               "' has an equilibrium that is not found: module '" +
                               std::string(mat.name) + "' is still pushed with " +
                               shortly(std::abs(forces_[worst])) +
                               " N, allowed: less stiff contacts, or start: as_written");
    }
    throw scene::errorAt(
        scene_, section.place,
        "section '" + section.name + "' has no equilibrium to start in: nothing holds module '" +
            std::string(mat.name) + "' against a force of " + shortly(std::abs(forces_[worst])) +
            " N, allowed: modules on springs, or above what they can lie on");
  }

  Network network_;
  const scene::Scene& scene_;
  std::vector<int> mats_;
  std::vector<int> row_of_;  // [Scene::mats] -1: held
  std::vector<double> ground_;
  std::vector<double> constant_;
  std::vector<Pull> pulls_;
  Eigen::VectorXd start_;

  // At the positions of the last assemble().
  Eigen::VectorXd forces_;
  Eigen::SparseMatrix<double> stiffness_;
  double energy_ = 0.0;
  double rounding_ = 0.0;  // of the forces
  double largest_ = 0.0;   // of all forces one by one
  double at_first_ = 0.0;  // the same where they are written
};

}  // namespace

void startInEquilibrium(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes) {
  if (std::none_of(scene.sections.begin(), scene.sections.end(),
                   [](const scene::Section& section) { return section.starts_in_balance; })) {
    return;
  }
  Balance balance(scene, rates);
  const Eigen::VectorXd x = balance.found();
  std::vector<double> farthest(scene.sections.size(), 0.0);
  for (std::size_t i = 0; i < balance.mats().size(); ++i) {
    scene::Mat& mat = scene.mats[at(balance.mats()[i])];
    double& most = farthest[at(mat.section)];
    most = std::max(most, std::abs(x[static_cast<Eigen::Index>(i)] - mat.position.x()));
    mat.position.x() = x[static_cast<Eigen::Index>(i)];
    // Links act from the second step on.
    mat.push.edit().first_force.x() = balance.linkForce(i, mat.position.x());
  }
  for (std::size_t s = 0; s < scene.sections.size(); ++s) {
    const scene::Section& section = scene.sections[s];
    if (section.starts_in_balance) {
      notes.push_back(noteAt(scene, section.place) + "section '" + section.name +
                      "' starts in equilibrium, up to " + shortly(1e3 * farthest[s]) +
                      " mm from where it is written");
    }
  }
}

}  // namespace ergotic::physics
