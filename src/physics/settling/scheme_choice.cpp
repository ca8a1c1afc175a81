// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <tuple>

#include "at.hpp"
#include "physics/certificate/energy_loss.hpp"
#include "physics/certificate/explicit_limits.hpp"
#include "physics/network/network_analysis.hpp"
#include "physics/network/rated_network.hpp"
#include "physics/note.hpp"
#include "physics/settling/steps.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::Scheme;

/// Why a link is energy-stable: a figure that is larger than the explicit scheme bears.
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
      notes_.push_back(noteAbout(alike));
    }
  }

 private:
  /// Links of one place (a generator makes many), of one type, with one reason and one outcome.
  struct AlikeLinks {
    const scene::Lia* first = nullptr;
    int links = 0;
    Reason worst;
    bool energy_stable = false;
  };

  /// The energy-stable scheme counts on knowing how far both ends go in a step: not so across
  /// rates.
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
      return Scheme::kEnergyStable;
    }
    const Reason reason = reasonFor(lia);
    if (reason.figure == nullptr) {
      return Scheme::kExplicit;
    }
    const bool energy_stable = !isOntoSlowMass(lia);
    AlikeLinks& alike = alike_[{lia.place.line, lia.place.column, reason.figure, energy_stable}];
    if (alike.links++ == 0) {
      alike.first = &lia;
      alike.energy_stable = energy_stable;
    }
    if (reason.value >= alike.worst.value) {
      alike.worst = reason;
    }
    return energy_stable ? Scheme::kEnergyStable : Scheme::kExplicit;
  }

  std::string noteAbout(const AlikeLinks& alike) const {
    std::string who = "link '" + alike.first->name + "'";
    if (alike.links > 1) {
      who += " and " + std::to_string(alike.links - 1) + " more";
    }
    const std::string why = std::string(alike.worst.figure) + " = " + shortly(alike.worst.value) +
                            "; the explicit scheme is stable up to " + shortly(alike.worst.allowed);
    return noteAt(scene_, alike.first->place) + who +
           (alike.energy_stable ? ": energy-stable, so that it cannot gain energy (" + why + ")"
                                : ": explicit, because one end is a slower mass (" + why + ")");
  }

  using Key = std::tuple<int, int, std::string, bool>;  // place, figure, energy-stable

  scene::Scene& scene_;
  Network network_;
  RatedNetwork networks_;
  EnergyLoss loss_;
  std::vector<std::string>& notes_;
  std::map<Key, AlikeLinks> alike_;
};

/// Makes the stiffest of the links energy-stable that are explicit only if that is stable, until it
/// is.
class StableChooser {
 public:
  StableChooser(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes)
      : scene_(scene), rates_(rates), notes_(notes) {}

  void run() {
    for (int l = 0; l < static_cast<int>(scene_.lias.size()); ++l) {
      if (scene_.lias[at(l)].scheme == Scheme::kExplicitIfStable) {
        open_.push_back(l);
      }
    }
    setOpen(Scheme::kEnergyStable);
    const bool is_stable_without = !open_.empty() && !isRefuted();
    setOpen(Scheme::kExplicit);
    if (open_.empty() || !isRefuted()) {
      return;
    }
    sortByLoad();
    while (!open_.empty() &&
           (loads_[open_.back()] >= NetworkBound::kLimit || (is_stable_without && isRefuted()))) {
      makeEnergyStable(open_.back());
      open_.pop_back();
    }
  }

 private:
  void setOpen(Scheme scheme) {
    for (const int l : open_) {
      scene_.lias[at(l)].scheme = scheme;
    }
  }

  /// Sorts the open links by their own load, h^2 K (1/Ma + 1/Mb) + 2 h Z (1/Ma + 1/Mb).
  void sortByLoad() {
    const Network network(scene_);
    const RatedNetwork networks(network, rates_);
    for (const int l : open_) {
      const scene::Lia& lia = scene_.lias[at(l)];
      const Slopes& slopes = networks.slopes(l);
      loads_[l] = networks.inverseMassStep2(lia) * slopes.stiffness.highest +
                  2.0 * networks.inverseMassStep(lia) * slopes.damping.highest;
    }
    std::stable_sort(open_.begin(), open_.end(),
                     [this](int a, int b) { return loads_[a] < loads_[b]; });
  }

  /// Whether the network is beyond its limit with all links at their steepest.
  bool isRefuted() const {
    const Network network(scene_);
    const RatedNetwork networks(network, rates_);
    return std::any_of(scene_.sections.begin(), scene_.sections.end(), [&](const auto& section) {
      const NetworkAnalysis found = analyse(networks.atOwnRate(divisorOf(section, rates_)));
      return found.lambda >= NetworkBound::kLimit && !found.is_bound && !found.is_too_large;
    });
  }

  void makeEnergyStable(int l) {
    scene::Lia& lia = scene_.lias[at(l)];
    if (!(loads_[l] > 0.0)) {
      return;
    }
    lia.scheme = Scheme::kEnergyStable;
    notes_.push_back(
        noteAt(scene_, lia.place) + "link '" + lia.name.str() +
        "': energy-stable (h^2 K (1/Ma + 1/Mb) + 2 h Z (1/Ma + 1/Mb) = " + shortly(loads_[l]) +
        ", and with what is around it the explicit scheme is stable below 4): "
        "it never gives more energy than it took, and does not sound as programs do that play it "
        "explicitly");
  }

  scene::Scene& scene_;
  const Rates& rates_;
  std::vector<std::string>& notes_;
  std::vector<int> open_;
  std::map<int, double> loads_;
};

}  // namespace

void chooseSchemes(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes) {
  SchemeChooser(scene, rates, notes).run();
  StableChooser(scene, rates, notes).run();
}

}  // namespace ergotic::physics
