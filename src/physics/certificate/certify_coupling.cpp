// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "at.hpp"
#include "ergotic/physics/certificate/monodromy.hpp"
#include "physics/certificate/certify_parts.hpp"
#include "physics/certificate/island.hpp"
#include "physics/certificate/linear_stepper.hpp"
#include "physics/certificate/lyapunov_form.hpp"
#include "physics/network/couplings.hpp"
#include "physics/network/network_analysis.hpp"

namespace ergotic::physics {
namespace {

constexpr int kMaxMasses = 300;           // whose eigenvalues are worked out
constexpr double kRadiusRounding = 1e-9;  // of a radius of 1
constexpr double kCertainGrowth = 1e-2;   // per period
constexpr double kRoundingOfFloat = 2.5e-7;

/// Spectral radius of the linear model over one period of its slowest section.
struct Trial {
  double radius = 0.0;
  double period_s = 0.0;
  double growthPerSecond() const { return std::log(radius) / period_s; }
};

/// Moves the numbers of an island off by four times what single precision rounds them by, each up
/// in half of the cases and down in the others, any two alike in half of them (the rows of a
/// Hadamard matrix): what several do together is as large in one case as the root of the sum of
/// their squares. Where there are more numbers than cases, the last ones move at random.
class Roundings {
 public:
  explicit Roundings(const scene::Scene& scene) : scene_(scene) {
    scene::Scene counted = scene;
    int numbers = 0;
    forNumbers(counted, [&numbers](double&) { ++numbers; });
    while (cases_ <= numbers && cases_ < (numbers > kMany ? kFewCases : kMaxCases)) {
      cases_ *= 2;
    }
  }

  int cases() const { return cases_; }

  scene::Scene at(int turn) {
    scene::Scene rounded = scene_;
    int code = 0;
    forNumbers(rounded, [&](double& number) {
      ++code;
      const bool is_up = code < cases_ ? isOdd(code & turn) : (random_() & 1U) != 0;
      number *= 1.0 + (is_up ? kRoundingOfFloat : -kRoundingOfFloat);
    });
    return rounded;
  }

 private:
  static constexpr int kMaxCases = 64;
  static constexpr int kFewCases = 16;  // as they take long
  static constexpr int kMany = 200;
  static bool isOdd(int bits) {
    bool odd = false;
    for (; bits != 0; bits &= bits - 1) {
      odd = !odd;
    }
    return odd;
  }

  /// Masses of modules that nothing moves, and what is 0, are rounded to what they are.
  template <class Visit>
  static void forNumbers(scene::Scene& scene, const Visit& visit) {
    const auto seeNumber = [&visit](double& number) {
      if (number != 0.0) {
        visit(number);
      }
    };
    const auto see = [&seeNumber](scene::Value& value) { seeNumber(value.factor); };
    for (scene::Tap& tap : scene.taps) {
      for (scene::Tap::Share& share : tap.shares) {
        seeNumber(share.weight);
      }
    }
    for (scene::Section& section : scene.sections) {
      see(section.medium);
    }
    for (scene::Mat& mat : scene.mats) {
      if (mat.type == scene::MatType::kMass || mat.type == scene::MatType::kCell) {
        see(mat.mass);
        see(mat.stiffness);
        see(mat.damping);
      }
    }
    for (scene::Lia& lia : scene.lias) {
      see(lia.stiffness);
      see(lia.damping);
    }
  }

  const scene::Scene& scene_;
  int cases_ = 2;
  std::mt19937 random_{1};
};

std::vector<Eigen::MatrixXd> rounded(const scene::Scene& scene, const Rates& rates) {
  Roundings roundings(scene);
  std::vector<Eigen::MatrixXd> matrices;
  for (int i = 0; i < roundings.cases(); ++i) {
    matrices.push_back(periodOf(roundings.at(i), rates).matrix);
  }
  return matrices;
}

class CouplingJudge {
 public:
  CouplingJudge(const RatedNetwork& networks, Findings& findings)
      : networks_(networks), scene_(networks.scene()), findings_(findings) {}

  void run() {
    for (const auto& [name, coupling] : findCouplings(networks_)) {
      judge(name, coupling);
    }
  }

 private:
  /// No bound says whether two rates get on: only the eigenvalues of a period do.
  void judge(int name, const Coupling& coupling) {
    if (!coupling.nonlinear.empty()) {
      say(coupling, Verdict::kUnproven,
          "is coupled to a faster one, and link '" +
              scene_.lias[at(coupling.nonlinear.front())].name +
              "' acts beside it, which is not linear: hold and mean make no energy on the average "
              "only, and it may keep what they lend. Put all of that in one section, or let a hand "
              "hold the slower end");
    }
    double bound = 0.0;
    for (const int divisor : coupling.slow_divisors) {
      const NetworkBound network = networks_.atSlowRate(divisor, name);
      judgeSigns(networks_, network, findings_);
      bound = std::max(bound, analyse(network).lambda);
    }
    const std::string what = bound < NetworkBound::kLimit
                                 ? "is coupled to a faster one"
                                 : "is coupled to a faster one, stiffly for its rate, bound " +
                                       describe(bound) + " of 4";
    const Island members(networks_, name);
    if (members.masses() > kMaxMasses) {
      watch(members, coupling, what);
    } else {
      tryEigenvalues(members, coupling, what);
    }
  }

  void say(const Coupling& coupling, Verdict verdict, const std::string& text) {
    const scene::Section& section = scene_.sections[at(coupling.slow_section)];
    findings_.add(verdict, section.place, "section '" + section.name + "' " + text);
  }

  void tryEigenvalues(const Island& members, const Coupling& coupling, const std::string& what) {
    Trial worst;
    bool is_proven = true;
    for (const scene::Scene& scene : members.cases()) {
      const LinearStepper stepper(linearPart(scene), networks_.rates());
      const Period period = periodOf(scene, networks_.rates());
      const Trial trial{spectralRadius(period.matrix), stepper.periodSeconds()};
      if (std::isnan(trial.radius)) {
        say(coupling, Verdict::kUnproven,
            what + ", and its eigenvalues cannot be worked out: its numbers lie too far apart");
        return;
      }
      worst = trial.radius >= worst.radius ? trial : worst;
      is_proven = hasForm(scene, period) && is_proven;
    }
    if (worst.radius > 1.0 + kRadiusRounding) {
      const bool is_certain = worst.radius > 1.0 + kCertainGrowth;
      say(coupling, is_certain ? Verdict::kUnstable : Verdict::kUnproven,
          what + ", and grows by a factor of exp(" + describe(worst.growthPerSecond()) +
              ") per second: the largest eigenvalue over one of its steps is 1 + " +
              describe(worst.radius - 1.0) + ". " + advice(coupling));
    } else if (const std::string doubt = members.doubt(); !doubt.empty()) {
      say(coupling, Verdict::kUnproven,
          what + ". No eigenvalue over one of its steps is above 1, but " + doubt);
    } else if (!is_proven) {
      say(coupling, Verdict::kUnproven,
          what +
              ". No eigenvalue over one of its steps is above 1, but two are so near to one "
              "another that rounding its numbers may let them grow. Change a stiffness or a "
              "mass by a percent, or give its modes a little damping");
    }
  }

  /// False if no form is found that does not grow, or only one that rounding may change.
  bool hasForm(const scene::Scene& scene, const Period& period) {
    return lyapunovFormOf(period, rounded(scene, networks_.rates())).has_value();
  }

  void watch(const Island& members, const Coupling& coupling, const std::string& what) {
    GrowthSeen worst;
    for (const scene::Scene& scene : members.cases()) {
      const GrowthSeen seen = watchGrowth(linearPart(scene), networks_.rates());
      worst = worst.periods == 0 || seen.per_second > worst.per_second ? seen : worst;
    }
    std::string how = "neither grew nor shrank";
    if (worst.is_visible) {
      how = (worst.per_second > 0.0 ? "grew" : "shrank") + std::string(" by a factor of exp(") +
            describe(worst.per_second) + ") per second";
    }
    say(coupling, Verdict::kUnproven,
        what + ". With " + std::to_string(members.masses()) +
            " masses it is too large for its eigenvalues; in " + std::to_string(worst.periods) +
            " of its steps from a random state it " + how + ", which proves nothing. " +
            advice(coupling));
  }

  std::string advice(const Coupling& coupling) const {
    std::string text =
        "Put a chaplet between, run the slow section at a higher rate, move its "
        "masses to the faster section";
    const double lambda = analyse(networks_.atOwnRate(coupling.slowest)).lambda;
    const double damping = coupling.coupling_damping * std::min(lambda, NetworkBound::kLimit) / 8.0;
    return text + (damping > 0.0 ? ", or damp the coupled slow masses to the ground, by " +
                                       describe(damping) + " N s/m or more"
                                 : ", or give its modes a little damping");
  }

  const RatedNetwork& networks_;
  const scene::Scene& scene_;
  Findings& findings_;
};

}  // namespace

void judgeCouplings(const RatedNetwork& networks, Findings& findings) {
  CouplingJudge(networks, findings).run();
}

}  // namespace ergotic::physics
