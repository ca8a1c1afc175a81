// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "at.hpp"
#include "physics/certificate/certify_parts.hpp"
#include "physics/certificate/energy_loss.hpp"
#include "physics/certificate/explicit_limits.hpp"
#include "physics/certificate/largest_numbers.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::Lia;

constexpr double kMaxPower = 100.0;  // kg m^2/time_unit^2 each second, of what moves a point
// With products and some hundred times more, what single precision holds:
constexpr double kMaxLoad = 1e30;
constexpr double kMaxCurved = 1e15;  // whose square is worked out
constexpr double kMaxForce = 1e36;   // kg m/time_unit^2
constexpr double kMaxCubic = 1e30;   // kg/(m^2 time_unit^2)
constexpr double kMaxLength = 1e18;  // m, whose square is worked out
constexpr double kSecond = 1.0;      // s, more than energy-stable links look ahead
constexpr double kDay = 1e5;

class LinkJudge {
 public:
  LinkJudge(const RatedNetwork& networks, Findings& findings)
      : networks_(networks), loss_(networks), largest_(networks), findings_(findings) {}

  void judge(int l) {
    const Lia& lia = networks_.scene().lias[at(l)];
    const Slopes& slopes = networks_.slopes(l);
    judgeSize(lia);
    if (lia.scheme == scene::Scheme::kEnergyStable) {
      judgeEnergyStable(lia, slopes);
      return;
    }
    notePlaces(lia);
    judgeSignOfMoving(lia, slopes);
    if (scene::lawOf(lia.type).kind == scene::Law::Kind::kRelaxing) {
      judgeMemory(lia);
    } else {
      noteTurning(lia);
    }
    const scene::Law& law = scene::lawOf(lia.type);
    if (law.friction != nullptr) {
      judgeFriction(lia, law.friction(networks_.scene(), lia));
    }
    judgeGift(lia, law);
    if (slopes.is_unbounded) {
      judgeGrowing(lia, law);
    }
    const bool acts =
        slopes.stiffness.highest > 0.0 || (law.friction == nullptr && slopes.damping.highest > 0.0);
    const bool switches = law.switches && acts && !slopes.is_unbounded;
    const bool falls = law.friction != nullptr && !networks_.onlyBrakes(lia);
    if (!(switches || falls) || !(networks_.inverseMassStep2(lia) > 0.0)) {
      return;  // its slopes are in the network
    }
    if (switches ? loss_.bears(lia) : loss_.surrounds(lia)) {
      findings_.worsen(Verdict::kBounded);
    } else if (switches) {
      judgeSwitching(lia, law, slopes.stiffness.highest);
    } else {
      judgeFalling(lia);
    }
  }

  /// Adds the findings that concern several links at once.
  void finish() {
    for (const scene::Connection* place : moving_) {
      judgePlace(*place);
    }
    for (const auto& [place, turning] : turning_) {
      const std::string more =
          turning.links > 1 ? " and " + std::to_string(turning.links - 1) + " more" : "";
      findings_.add(
          Verdict::kUnproven, turning.first->place,
          "link '" + turning.first->name + "'" + more +
              " has a rest length, or a damper, in a plane or in space, where its direction turns: "
              "stable while it moves little against its length, but large motion may create "
              "energy. Use scheme: energy_stable, or rest length 0 and a medium or loss, or a "
              "scalar section");
    }
  }

 private:
  /// Links of one place in the text: a generator makes many.
  struct Turning {
    const Lia* first = nullptr;
    int links = 0;
  };

  void notePlaces(const Lia& lia) {
    for (const int end : {lia.a, lia.b}) {
      if (networks_.isMovingPoint(end)) {
        const int point = networks_.network().point_of[at(end)];
        moving_.insert(&networks_.scene().connections[at(point)]);
      }
    }
  }

  /// Moving it works on what explicit links join to it, and nothing feels that; its power is held.
  void judgePlace(const scene::Connection& place) {
    // An energy is in kg m^2/time_unit^2.
    const double unit = networks_.scene().time_unit_s;
    if (place.power <= kMaxPower / (unit * unit)) {
      findings_.worsen(Verdict::kBounded);
      return;
    }
    findings_.add(Verdict::kUnproven, place.place,
                  "point '" + networks_.scene().mats[at(place.mat)].name +
                      "' moves, and may bring " + describe(place.power) +
                      " W to what is linked to it, more than a hand does. Let its power be " +
                      describe(kMaxPower) + " W or less");
  }

  void noteTurning(const Lia& lia) {
    if (networks_.turns(lia)) {
      Turning& turning = turning_[{lia.place.line, lia.place.column}];
      turning.first = turning.links++ == 0 ? &lia : turning.first;
    }
  }

  void judgeEnergyStable(const Lia& lia, const Slopes& slopes) {
    const scene::Law& law = scene::lawOf(lia.type);
    const double give = networks_.inverseMassStep2(lia);
    if (const double load = give * std::max(slopes.stiffness.highest, 1.0); !(load < kMaxLoad)) {
      findings_.add(Verdict::kUnproven, lia.place,
                    "energy-stable link '" + lia.name +
                        "': h^2 K (1/Ma + 1/Mb) = " + describe(load) +
                        " is more than single precision can count with, up to 1e30");
    } else if (const double curved = slopes.is_unbounded ? largestLoad(lia) : 0.0;
               !(curved < kMaxCurved)) {
      findings_.add(
          Verdict::kUnproven, lia.place,
          "energy-stable link '" + lia.name +
              "' may come to h^2 K (1/Ma + 1/Mb) or h Z (1/Ma + "
              "1/Mb) of " +
              describe(curved) +
              ", more than single precision can count with where a law is curved, up to " +
              describe(kMaxCurved));
    }
    if (!(give > 0.0)) {
      judgeGift(lia, law);  // a tank holds back what forces move
    } else if (law.canGive(lia)) {
      findings_.worsen(Verdict::kBounded);  // though no more than its tank holds
    }
    if (networks_.crossesRates(lia) && networks_.inverseMass(networks_.slowEnd(lia)) > 0.0) {
      findings_.add(
          Verdict::kUnproven, lia.place,
          "energy-stable link '" + lia.name +
              "' acts on a slower module, whose next step the scheme cannot know. Move that "
              "module to the faster section, or put a module of that section between");
    }
  }

  /// The load h max(h K, Z) (1/Ma + 1/Mb) of a link that holds all the energy alone.
  double largestLoad(const Lia& lia) const {
    const LargestNumbers::Steepest most = largest_.steepestOf(lia);
    const double give = networks_.inverseMass(lia.a) + networks_.inverseMass(lia.b);
    const double step = give > 0.0 ? std::sqrt(networks_.inverseMassStep2(lia) / give) : 0.0;
    return step * give * std::max(step * most.stiffness, most.damping);
  }

  void judgeGift(const Lia& lia, const scene::Law& law) {
    if (law.givesForEver(lia)) {
      findings_.add(Verdict::kUnproven, lia.place,
                    "link '" + lia.name +
                        "' gives energy however far or fast its ends move: its table pushes "
                        "outwards beyond its ends, or drives more than it brakes. Let its first "
                        "value be 0 or less and its last 0 or more");
    } else if (law.canGive(lia)) {
      findings_.worsen(Verdict::kBounded);
    }
  }

  /// True if a link acts along the line between its ends, whose distance is a root of squares.
  bool isAlongALine(const Lia& lia) const {
    const auto isScalar = [this](int mat) {
      const scene::Scene& scene = networks_.scene();
      return scene.sectionOf(scene.mats[at(mat)]).geometry == scene::Geometry::kScalar;
    };
    return !isScalar(lia.a) && !isScalar(lia.b);
  }

  /// e^exponent where it alone holds all energy.
  double powerOf(const Lia& lia) const {
    const double exponent = scene::largest(networks_.scene(), lia.law->exponent);
    return exponent > 1.0 ? std::pow(largest_.steepestOf(lia).apart, exponent) : 0.0;
  }

  /// Coefficients of curves between the points of tables.
  static double steepestCubic(const Lia& lia) {
    double most = 0.0;
    for (const scene::Table* const table : {&lia.law->table, &lia.law->viscous_table}) {
      for (std::size_t i = 1; i < table->points.size(); ++i) {
        const auto& [x0, f0] = table->points[i - 1];
        const auto& [x1, f1] = table->points[i];
        most = std::max(most, std::abs(f1 - f0) / std::pow(x1 - x0, table->smooth ? 3.0 : 1.0));
      }
    }
    return most;
  }

  /// Whether single precision can count with what the link does.
  void judgeSize(const Lia& lia) {
    const auto tell = [&](const char* of, double what, double most) {
      findings_.add(Verdict::kUnproven, lia.place,
                    "link '" + lia.name + "' may reach " + of + " of " + describe(what) +
                        ", beyond the range of single precision, " + describe(most) +
                        ". Use precision: double, or smaller values");
    };
    const bool is_energy_stable = lia.scheme == scene::Scheme::kEnergyStable;
    const double length = largest_.reach(isAlongALine(lia)  ? kDay
                                         : is_energy_stable ? kSecond
                                                            : 0.0);
    if (const double force = largest_.forceOf(lia); !(force < kMaxForce)) {
      tell("a force", force, kMaxForce);
    } else if (const double power = powerOf(lia); !(power < kMaxForce)) {
      tell("a power of its elongation", power, kMaxForce);
    } else if (const double bend = steepestCubic(lia); !(bend < kMaxCubic)) {
      tell("a change of force over the cube of a distance in its table", bend, kMaxCubic);
    } else if (is_energy_stable && !(largest_.energy() < kMaxForce)) {
      tell("an energy", largest_.energy(), kMaxForce);
    } else if (!(length < kMaxLength)) {
      tell("a length", length, kMaxLength);
    }
  }

  /// Signs of links at rest are judged as a network.
  void judgeSignOfMoving(const Lia& lia, const Slopes& slopes) {
    if ((slopes.stiffness.lowest < 0.0 || slopes.damping.lowest < 0.0) && networks_.isMoving(lia)) {
      findings_.add(Verdict::kUnproven, lia.place,
                    "link '" + lia.name +
                        "' has a negative stiffness or damping and an end that moves: it gives "
                        "energy, no bound holds");
    }
  }

  /// A link with memory is only proven along one fixed axis, with ends that do not move on a grid.
  void judgeMemory(const Lia& lia) {
    if (networks_.turns(lia) || networks_.isMoving(lia)) {
      findings_.add(Verdict::kUnproven, lia.place,
                    "link '" + lia.name +
                        "' remembers a distance, which may turn round, or is at a point that "
                        "moves: nothing is proven of that. Use a scalar section, and a point that "
                        "stays");
    }
  }

  const char* cureOf(const Lia& lia) const {
    return scene::canBeEnergyStable(networks_.scene(), lia)
               ? "Use scheme: energy_stable, or raise the rate"
               : "Raise the rate";
  }

  /// Warns of friction that is steep for the step. The verdict does not depend on it: the network
  /// decides whether the link is stable.
  void judgeFriction(const Lia& lia, const scene::FrictionSlopes& slopes) {
    const double unit = networks_.inverseMassStep(lia);
    const double rise = unit * slopes.rise;
    const double fall = unit * slopes.fall;
    if (rise >= kExplicitFriction) {
      findings_.add(Verdict::kPassive, lia.place,
                    "friction of link '" + lia.name +
                        "' is steep for the step, h max F' (1/Ma + "
                        "1/Mb) = " +
                        describe(rise) + " (silent below " + describe(kExplicitFriction) +
                        "): it overshoots. " + cureOf(lia));
    }
    if (fall >= kExplicitFalling) {
      findings_.add(Verdict::kPassive, lia.place,
                    "friction of link '" + lia.name +
                        "' falls fast for the step, h max(-F') "
                        "(1/Ma + 1/Mb) = " +
                        describe(fall) + " (silent below " + describe(kExplicitFalling) +
                        "): stick and slip will be inaccurate. " + cureOf(lia));
    }
  }

  /// Two-sided springs and power contacts: nothing holds at every amplitude.
  void judgeGrowing(const Lia& lia, const scene::Law& law) {
    const double unit = networks_.inverseMassStep2(lia);
    if (!(unit > 0.0)) {
      return;  // no force moves either end
    }
    const double reach =
        law.growth->elongation(networks_.scene(), lia, NetworkBound::kLimit / unit);
    findings_.add(Verdict::kUnproven, lia.place,
                  "the slope of link '" + lia.name +
                      "' grows with its amplitude: stable only while it moves little" +
                      (std::isfinite(reach) ? "; no motion can be stable beyond an elongation of " +
                                                  describe(reach) + " m"
                                            : "") +
                      ". Use scheme: energy_stable");
  }

  /// A step gives a little at some hits and takes a little at others. What swings with the step,
  /// three or four of them a period, meets the same ones again and again.
  void judgeSwitching(const Lia& lia, const scene::Law& law, double stiffness) {
    const std::string cure =
        law.is_held ? "Damp every mass that it reaches" : "Use scheme: energy_stable";
    findings_.add(Verdict::kUnproven, lia.place,
                  "link '" + lia.name + "' comes and goes, h^2 K (1/Ma + 1/Mb) = " +
                      describe(networks_.inverseMassStep2(lia) * stiffness) +
                      ": some of its hits come back faster, and what swings in time with the steps "
                      "adds them up. " +
                      cure);
  }

  /// Friction that nowhere falls always brakes; one that falls may drive what swings with the step.
  void judgeFalling(const Lia& lia) {
    findings_.add(
        Verdict::kUnproven, lia.place,
        "friction of link '" + lia.name +
            "' falls where it slips faster, and something that it reaches loses no "
            "energy: what swings in time with the steps may be driven. Damp every mass "
            "that it reaches" +
            (scene::canBeEnergyStable(networks_.scene(), lia) ? ", or use scheme: energy_stable"
                                                              : ""));
  }

  const RatedNetwork& networks_;
  EnergyLoss loss_;
  LargestNumbers largest_;
  Findings& findings_;
  std::map<std::pair<int, int>, Turning> turning_;  // by line and column
  std::set<const scene::Connection*> moving_;
};

}  // namespace

void judgeLinks(const RatedNetwork& networks, Findings& findings) {
  LinkJudge judge(networks, findings);
  for (int l = 0; l < static_cast<int>(networks.scene().lias.size()); ++l) {
    judge.judge(l);
  }
  judge.finish();
}

}  // namespace ergotic::physics
