// SPDX-License-Identifier: BSD-3-Clause
#include "scheme_choice.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "note.hpp"
#include "slopes.hpp"
#include "step_units.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;
using scene::MatType;
using scene::Scheme;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// The largest stiffness that a link switches on and off.
double stiffest(const scene::Scene& scene, const scene::Lia& lia) {
  return lia.type == LiaType::kPowerContact ? largest(scene, lia.stiffness)
                                            : slopesOf(scene, lia).stiffness.highest;
}

/// Why a link is guarded: a figure that is larger than the explicit scheme bears.
struct Reason {
  const char* figure = nullptr;  ///< null: it may stay explicit
  double value = 0.0;
  double allowed = 0.0;
};

class Chooser {
 public:
  Chooser(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes)
      : scene_(scene), rates_(rates), notes_(notes) {}

  void run() {
    for (scene::Lia& lia : scene_.lias) {
      if (lia.scheme == Scheme::kAuto) {
        lia.scheme = choose(lia);
      }
    }
    for (const auto& [key, group] : groups_) {
      notes_.push_back(noteOn(group));
    }
  }

 private:
  /// Links of one place (a generator makes many), of one type, with one reason and one outcome.
  struct Group {
    const scene::Lia* first = nullptr;
    int links = 0;
    Reason worst;
    bool guarded = false;
  };

  const scene::Mat& mat(int m) const { return scene_.mats[at(m)]; }
  int divisor(int m) const { return divisorOf(scene_.sectionOf(mat(m)), rates_); }

  /// A point is as light as the lightest module that it can lie on.
  double lightestUnder(int point) const {
    double inverse = 0.0;
    for (const scene::Connection& connection : scene_.connections) {
      if (connection.mat == point) {
        const scene::Grid& grid = scene_.grids[at(connection.grid)];
        for (int m = 0; m < grid.columns * grid.rows; ++m) {
          inverse = std::max(inverse, inverseMass(grid.first + m));
        }
      }
    }
    return inverse;
  }

  /// 0: forces do not move it.
  double inverseMass(int m) const {
    switch (mat(m).type) {
      case MatType::kMass:
      case MatType::kCell:
        return 1.0 / smallest(scene_, mat(m).mass);
      case MatType::kPoint:
        return lightestUnder(m);
      default:
        return 0.0;
    }
  }

  /// The guard counts on knowing how far both ends go in a step: not so across rates.
  bool isOntoSlowMass(const scene::Lia& lia) const {
    const int da = divisor(lia.a);
    const int db = divisor(lia.b);
    return da != db && (lia.coupling == scene::Coupling::kDecimate ||
                        inverseMass(da > db ? lia.a : lia.b) > 0.0);
  }

  Reason reasonFor(const scene::Lia& lia) const {
    const int steps = std::min(divisor(lia.a), divisor(lia.b));
    const double h = StepUnits(scene_, rates_, steps).step;
    const double inverse = inverseMass(lia.a) + inverseMass(lia.b);
    if (!(inverse > 0.0)) {
      return {};
    }
    switch (lia.type) {
      case LiaType::kPowerContact:
        if (largest(scene_, lia.exponent) > 1.0) {
          return {"exponent", largest(scene_, lia.exponent), 1.0};
        }
        return switching(lia, h * h * inverse);
      case LiaType::kContact:
      case LiaType::kClippedCubic:
      case LiaType::kCubicContact:
        return switching(lia, h * h * inverse);
      case LiaType::kQuadratic:
      case LiaType::kCubic: {
        const double q = largest(scene_, lia.nonlinearity);
        return q > 0.0 ? Reason{"nonlinearity", q, 0.0} : Reason{};
      }
      case LiaType::kTable:
        if (!lia.table.empty()) {
          return switching(lia, h * h * inverse);
        }
        return lia.viscous_table.empty() ? Reason{} : sliding(lia, h * inverse);
      case LiaType::kBow:
      case LiaType::kSmoothBow:
        return sliding(lia, h * inverse);
      default:
        return {};
    }
  }

  Reason switching(const scene::Lia& lia, double unit) const {
    const double kappa = unit * stiffest(scene_, lia);
    return kappa > kExplicitSwitch ? Reason{"h^2 K (1/Ma + 1/Mb)", kappa, kExplicitSwitch}
                                   : Reason{};
  }

  Reason sliding(const scene::Lia& lia, double unit) const {
    const FrictionSlopes slopes = frictionSlopesOf(scene_, lia);
    if (unit * slopes.rise >= kExplicitFriction) {
      return {"h max F' (1/Ma + 1/Mb)", unit * slopes.rise, kExplicitFriction};
    }
    if (unit * slopes.fall >= kExplicitFalling) {
      return {"h max(-F') (1/Ma + 1/Mb)", unit * slopes.fall, kExplicitFalling};
    }
    return {};
  }

  Scheme choose(const scene::Lia& lia) {
    const Reason reason = reasonFor(lia);
    if (reason.figure == nullptr) {
      return Scheme::kExplicit;
    }
    const bool guarded = !isOntoSlowMass(lia);
    Group& group = groups_[{lia.place.line, lia.place.column, reason.figure, guarded}];
    if (group.links++ == 0) {
      group.first = &lia;
      group.guarded = guarded;
    }
    if (reason.value >= group.worst.value) {
      group.worst = reason;
    }
    return guarded ? Scheme::kGuarded : Scheme::kExplicit;
  }

  std::string noteOn(const Group& group) const {
    std::string who = "link '" + group.first->name + "'";
    if (group.links > 1) {
      who += " and " + std::to_string(group.links - 1) + " more";
    }
    const std::string why = std::string(group.worst.figure) + " = " + shortly(group.worst.value) +
                            ", explicit bears " + shortly(group.worst.allowed);
    return noteAt(scene_, group.first->place) + who +
           (group.guarded
                ? ": guarded (" + why + ")"
                : ": explicit, because one end is a slower mass or decimated, although " + why);
  }

  using Key = std::tuple<int, int, std::string, bool>;  // place, figure, guarded

  scene::Scene& scene_;
  Rates rates_;
  std::vector<std::string>& notes_;
  std::map<Key, Group> groups_;
};

}  // namespace

void chooseSchemes(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes) {
  Chooser(scene, rates, notes).run();
}

}  // namespace ergotic::physics
