// SPDX-License-Identifier: BSD-3-Clause
#include "physics/settling/scheme_choice.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "physics/certificate/energy_loss.hpp"
#include "physics/certificate/explicit_limits.hpp"
#include "physics/network/rated_network.hpp"
#include "physics/note.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::Scheme;

/// Why a link is guarded: a figure that is larger than the explicit scheme bears.
struct Reason {
  const char* figure = nullptr;  ///< null: it may stay explicit
  double value = 0.0;
  double allowed = 0.0;
};

class SchemeChooser {
 public:
  SchemeChooser(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes)
      : scene_(scene),
        network_(scene),
        networks_(network_, rates),
        loss_(networks_),
        notes_(notes) {}

  void run() {
    for (scene::Lia& lia : scene_.lias) {
      if (lia.scheme == Scheme::kAuto) {
        lia.scheme = choose(lia);
      }
    }
    for (const auto& [key, alike] : alike_) {
      notes_.push_back(noteOn(alike));
    }
  }

 private:
  /// Links of one place (a generator makes many), of one type, with one reason and one outcome.
  struct AlikeLinks {
    const scene::Lia* first = nullptr;
    int links = 0;
    Reason worst;
    bool guarded = false;
  };

  /// The guard counts on knowing how far both ends go in a step: not so across rates.
  bool isOntoSlowMass(const scene::Lia& lia) const {
    return networks_.crossesRates(lia) && networks_.inverseMass(networks_.slowEnd(lia)) > 0.0;
  }

  Reason reasonFor(const scene::Lia& lia) {
    const double per_stiffness = networks_.inverseMassStep2(lia);
    const double per_damping = networks_.inverseMassStep(lia);
    if (!(per_stiffness > 0.0)) {
      return {};
    }
    const scene::Law& law = scene::lawOf(lia.type);
    if (networks_.turns(lia)) {
      return lia.rest_length > 0.0
                 ? Reason{"length at rest of a line that turns, m", lia.rest_length, 0.0}
                 : Reason{"damping along a line that turns, N s/m", lia.damping.factor, 0.0};
    }
    const Slopes& slopes = networks_.slopes(static_cast<int>(&lia - scene_.lias.data()));
    if (slopes.is_unbounded) {
      const scene::Growth::Figure figure = law.growth->figure(scene_, lia);
      return {figure.name, figure.value, figure.allowed};
    }
    const bool acts =
        slopes.stiffness.highest > 0.0 || (law.friction == nullptr && slopes.damping.highest > 0.0);
    if (law.switches && acts) {
      return {"h^2 K (1/Ma + 1/Mb)", per_stiffness * slopes.stiffness.highest, 0.0};
    }
    return law.friction == nullptr ? Reason{} : sliding(lia, law, per_damping);
  }

  Reason sliding(const scene::Lia& lia, const scene::Law& law, double unit) {
    const scene::FrictionSlopes slopes = law.friction(scene_, lia);
    if (unit * slopes.rise >= kExplicitFriction) {
      return {"h max F' (1/Ma + 1/Mb)", unit * slopes.rise, kExplicitFriction};
    }
    const double allowed =
        networks_.onlyBrakes(lia) || loss_.surrounds(lia) ? kExplicitFalling : 0.0;
    if (unit * slopes.fall >= allowed) {
      return {"h max(-F') (1/Ma + 1/Mb)", unit * slopes.fall, allowed};
    }
    return {};
  }

  Scheme choose(const scene::Lia& lia) {
    if (scene::sticks(lia.type)) {
      return Scheme::kGuarded;
    }
    const Reason reason = reasonFor(lia);
    if (reason.figure == nullptr) {
      return Scheme::kExplicit;
    }
    const bool guarded = !isOntoSlowMass(lia);
    AlikeLinks& alike = alike_[{lia.place.line, lia.place.column, reason.figure, guarded}];
    if (alike.links++ == 0) {
      alike.first = &lia;
      alike.guarded = guarded;
    }
    if (reason.value >= alike.worst.value) {
      alike.worst = reason;
    }
    return guarded ? Scheme::kGuarded : Scheme::kExplicit;
  }

  std::string noteOn(const AlikeLinks& alike) const {
    std::string who = "link '" + alike.first->name + "'";
    if (alike.links > 1) {
      who += " and " + std::to_string(alike.links - 1) + " more";
    }
    const std::string why = std::string(alike.worst.figure) + " = " + shortly(alike.worst.value) +
                            ", explicit bears " + shortly(alike.worst.allowed);
    return noteAt(scene_, alike.first->place) + who +
           (alike.guarded ? ": guarded (" + why + ")"
                          : ": explicit, because one end is a slower mass, although " + why);
  }

  using Key = std::tuple<int, int, std::string, bool>;  // place, figure, guarded

  scene::Scene& scene_;
  Network network_;
  RatedNetwork networks_;
  EnergyLoss loss_;
  std::vector<std::string>& notes_;
  std::map<Key, AlikeLinks> alike_;
};

}  // namespace

void chooseSchemes(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes) {
  SchemeChooser(scene, rates, notes).run();
}

}  // namespace ergotic::physics
