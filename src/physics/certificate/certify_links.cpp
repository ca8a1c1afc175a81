// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "at.hpp"
#include "physics/certificate/certify_parts.hpp"
#include "physics/certificate/explicit_limits.hpp"
#include "physics/certificate/switching_loads.hpp"
#include "physics/network/network_analysis.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::Lia;

constexpr double kMostPower = 100.0;    // W, of a hand that moves a point
constexpr double kWarnedSwitch = 0.25;  // h^2 K (1/Ma + 1/Mb): gains a few per cent a hit

class LinkJudge {
 public:
  LinkJudge(const RatedNetwork& networks, Findings& findings)
      : networks_(networks), loads_(networks), findings_(findings) {}

  void judge(int l) {
    const Lia& lia = networks_.scene().lias[at(l)];
    const Slopes& slopes = networks_.slopes(l);
    if (lia.scheme == scene::Scheme::kGuarded) {
      judgeGuarded(lia);
      prove(lia, "guarded");
      return;
    }
    notePlaces(lia);
    judgeSignOfMoving(lia, slopes);
    noteTurning(lia);
    const scene::Law& law = scene::lawOf(lia.type);
    if (law.friction != nullptr) {
      judgeFriction(lia, law.friction(networks_.scene(), lia));
    }
    judgeGift(lia, law);
    judgeGate(lia, law, slopes);
    if (slopes.is_unbounded) {
      judgeGrowing(lia, law);
    } else if (law.switches && slopes.stiffness.highest > 0.0) {
      judgeSwitching(lia, law);
      return;
    }
    prove(lia, "slopes");
  }

  /// What concerns many links at once.
  void finish() {
    for (const scene::Connection* place : moving_) {
      judgePlace(*place);
    }
    for (const auto& [place, turning] : turning_) {
      const std::string more =
          turning.links > 1 ? " and " + std::to_string(turning.links - 1) + " more" : "";
      findings_.add(Verdict::kUnproven, turning.first->place,
                    "link '" + turning.first->name + "'" + more +
                        " has a rest length and acts along a line that turns: stable while it "
                        "moves little against its length, but large motion may feed energy in. "
                        "Use rest length 0, scheme: guarded, or a scalar section");
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
    if (place.power <= kMostPower) {
      findings_.worsen(Verdict::kBounded);
      return;
    }
    findings_.add(Verdict::kUnproven, place.place,
                  "point '" + networks_.scene().mats[at(place.mat)].name +
                      "' moves, and may bring " + describe(place.power) +
                      " W to what is linked to it, more than a hand does. Let its power be " +
                      describe(kMostPower) + " W or less");
  }

  void noteTurning(const Lia& lia) {
    if (networks_.turns(lia)) {
      Turning& turning = turning_[{lia.place.line, lia.place.column}];
      turning.first = turning.links++ == 0 ? &lia : turning.first;
    }
  }

  void judgeGuarded(const Lia& lia) {
    if (scene::lawOf(lia.type).canGive(lia)) {
      findings_.worsen(Verdict::kBounded);  // though no more than its tank holds
    }
    if (networks_.crossesRates(lia) && networks_.inverseMass(networks_.slowEnd(lia)) > 0.0) {
      findings_.add(Verdict::kUnproven, lia.place,
                    "guarded link '" + lia.name +
                        "' acts on a slower module, which its guard cannot follow. Move that "
                        "module to the faster section, or put a module of that section between");
    }
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

  /// A damper that only one side meets gives to what swings in time with the steps, at every
  /// amplitude.
  void judgeGate(const Lia& lia, const scene::Law& law, const Slopes& slopes) {
    const bool is_damper = slopes.damping.highest > 0.0 && !(slopes.stiffness.highest > 0.0);
    if (law.kind == scene::Law::Kind::kGap && !slopes.is_unbounded && is_damper &&
        networks_.inverseMassStep(lia) > 0.0) {
      findings_.add(Verdict::kUnproven, lia.place,
                    "link '" + lia.name +
                        "' is a damper that comes and goes: what swings in time with the steps "
                        "may take energy from it. Use scheme: guarded, or a damper that stays");
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

  /// Never a matter of the verdict: whether it is stable, the network has told.
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
                        "): it overshoots. Use scheme: guarded, or raise the rate");
    }
    if (fall >= kExplicitFalling) {
      findings_.add(Verdict::kPassive, lia.place,
                    "friction of link '" + lia.name +
                        "' falls fast for the step, h max(-F') "
                        "(1/Ma + 1/Mb) = " +
                        describe(fall) + " (silent below " + describe(kExplicitFalling) +
                        "): stick and slip will be inaccurate. Use scheme: guarded, or raise the "
                        "rate");
    }
  }

  /// Two-sided springs and power contacts: nothing holds at every amplitude.
  void judgeGrowing(const Lia& lia, const scene::Law& law) {
    const double unit = networks_.inverseMassStep2(lia);
    if (!(unit > 0.0)) {
      return;  // no force moves either end
    }
    const double limit = law.switches ? kWarnedSwitch : NetworkBound::kLimit;
    const double reach = law.growth->elongation(networks_.scene(), lia, limit / unit);
    const std::string how = law.switches ? "; it would count as soft up to an overlap of "
                                         : "; no motion can be stable beyond an elongation of ";
    findings_.add(Verdict::kUnproven, lia.place,
                  "the slope of link '" + lia.name +
                      "' grows with its amplitude: stable only while it moves little" +
                      (std::isfinite(reach) ? how + describe(reach) + " m" : "") +
                      ". Use scheme: guarded");
  }

  /// A stiffness that switches pumps energy: by little if it is soft for the step.
  void judgeSwitching(const Lia& lia, const scene::Law& law) {
    const double kappa = loads_.kappa(lia);
    // What is meant to give energy may give a few per cent more.
    const double silent = law.canGive(lia) ? kWarnedSwitch : kExplicitSwitch;
    if (kappa <= silent && (law.canGive(lia) || loads_.losesMore(lia))) {
      prove(lia, law.canGive(lia) ? "active" : "soft");
      return;
    }
    if (law.is_held && losesEnergy(lia)) {
      findings_.worsen(Verdict::kBounded);
      prove(lia, "lossy");
      return;
    }
    if (kappa <= silent) {
      findings_.add(Verdict::kUnproven, lia.place,
                    "link '" + lia.name +
                        "' switches its stiffness: its step may give a little at every hit, which "
                        "adds up, and its damping takes less than that. Give it " +
                        describe(loads_.leastDamping(lia)) + " N s/m or more, or scheme: guarded");
      return;
    }
    const std::string harm =
        kappa <= kWarnedSwitch
            ? "hard hits come back a few per cent faster, and undamped ones add up"
            : "it may feed energy in at every hit";
    const std::string cure =
        law.is_held ? "Damp every mass that it reaches" : "Use scheme: guarded";
    findings_.add(
        Verdict::kUnproven, lia.place,
        "link '" + lia.name + "' switches its stiffness, h^2 K (1/Ma + 1/Mb) = " + describe(kappa) +
            " with all that switch at its ends, silent below " + describe(silent) + ": " + harm +
            ". " + cure + ", soften it, make its masses heavier, or raise the rate");
  }

  /// A bounded force keeps what it acts on bounded, if all of that loses energy and is stable, and
  /// no guarded link hands it on to something that may keep it.
  bool losesEnergy(const Lia& lia) {
    if (networks_.crossesRates(lia)) {
      return false;
    }
    const int island = networks_.islandOf(lia);
    const auto [known, is_new] = loses_energy_.try_emplace(island);
    if (is_new) {
      const int divisor = networks_.divisorOfMat(lia.a);
      auto proof = proofOfLoss(networks_.atOwnRate(divisor, island, true));
      known->second = !isLeft(island) && proof;
      if (known->second && findings_.proof() != nullptr) {
        findings_.proof()->losses.push_back(std::move(*proof));
      }
    }
    return known->second;
  }

  /// The rule that vouches for a link that is more than a spring and a damper.
  void prove(const Lia& lia, const char* rule) {
    const bool is_linear = lia.type == scene::LiaType::kSpringDamper && networks_.isExplicit(lia);
    if (findings_.proof() != nullptr && !is_linear) {
      const int index = static_cast<int>(&lia - networks_.scene().lias.data());
      findings_.proof()->links.push_back(
          {index, rule, loads_.kappa(lia), loads_.leastDamping(lia)});
    }
  }

  bool isLeft(int island) const {
    const auto& lias = networks_.scene().lias;
    return std::any_of(lias.begin(), lias.end(), [&](const Lia& lia) {
      const int a = networks_.islandAt(lia.a);
      const int b = networks_.islandAt(lia.b);
      return lia.scheme == scene::Scheme::kGuarded && a >= 0 && b >= 0 && a != b &&
             (a == island || b == island);
    });
  }

  const RatedNetwork& networks_;
  SwitchingLoads loads_;
  Findings& findings_;
  std::map<std::pair<int, int>, Turning> turning_;  // by line and column
  std::set<const scene::Connection*> moving_;
  std::map<int, bool> loses_energy_;  // by island
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
