// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <utility>

#include "at.hpp"
#include "ergotic/exception.hpp"
#include "physics/certificate/certify_parts.hpp"
#include "physics/interpolation.hpp"
#include "physics/note.hpp"
#include "physics/settling/steps.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::Coupling;
using scene::Scene;

constexpr double kHandHz = 20.0;

/// Predicted properties of one coupling of a slice.
struct Option {
  Coupling coupling = Coupling::kHold;
  HandLevel level = HandLevel::kSilent;
  double stiffness = 0.0;  // at the device, N/m
  double limit = 0.0;
  double steps = 0.0;  // that are heard, rms of the movement of a hand
  bool damps = false;  // what is attached there for good
  double error = 0.0;  // steps, what is softer than the links say, and what is lost

  /// Order of preference: couplings that are silent in the hand first, by their error; then the
  /// others, by how close they come to the limit.
  std::pair<HandLevel, double> rank() const {
    return {level, level == HandLevel::kSilent ? error : partOf(stiffness, limit)};
  }
};

bool isFaster(const Scene& scene, const Rates& rates, int section, int slice) {
  return divisorOf(scene.sections[at(section)], rates) <
         divisorOf(scene.sectionOf(scene.mats[at(slice)]), rates);
}

/// The other end of a link of a slice, if that is faster; else -1.
int fasterEnd(const Scene& scene, const Rates& rates, const scene::Lia& lia, int slice) {
  const int other = lia.a == slice ? lia.b : lia.b == slice ? lia.a : -1;
  return other >= 0 && isFaster(scene, rates, scene.mats[at(other)].section, slice) ? other : -1;
}

bool isSeen(const Scene& scene, const Rates& rates, int slice) {
  const auto guides = [&](const scene::Connection& point) {
    return (point.along.guide == slice || point.across.guide == slice) &&
           isFaster(scene, rates, scene.mats[at(point.mat)].section, slice);
  };
  return std::any_of(
             scene.lias.begin(), scene.lias.end(),
             [&](const scene::Lia& lia) { return fasterEnd(scene, rates, lia, slice) >= 0; }) ||
         std::any_of(scene.connections.begin(), scene.connections.end(), guides);
}

class CouplingChooser {
 public:
  CouplingChooser(const Scene& scene, const Rates& rates, const Complete& complete)
      : scene_(scene), rates_(rates), complete_(complete) {}

  /// All couplings that can be played, hold first.
  std::vector<Option> optionsOf(int slice) const {
    std::vector<Option> options{optionOf(slice, Coupling::kHold),
                                optionOf(slice, Coupling::kSmooth)};
    try {
      options.push_back(optionOf(slice, Coupling::kChaplet));
    } catch (const TextError&) {
      // None can stand there: there is nothing to choose.
    }
    const double stiffness = options.front().stiffness;
    for (Option& option : options) {
      const double softer = stiffness > 0.0 ? 1.0 - option.stiffness / stiffness : 0.0;
      option.damps = option.coupling == Coupling::kChaplet && isHeld(slice);
      option.error = option.steps + std::max(0.0, softer) + (option.damps ? 1.0 : 0.0);
    }
    return options;
  }

 private:
  bool isHeld(int slice) const {
    return std::any_of(scene_.lias.begin(), scene_.lias.end(), [&](const scene::Lia& lia) {
      // What rings on a link that never lets go rings into the chaplet, too, which swallows it: a
      // string by some ten dB in a second.
      return scene::lawOf(lia.type).has_linear_part && fasterEnd(scene_, rates_, lia, slice) >= 0;
    });
  }

  Option optionOf(int slice, Coupling coupling) const {
    Scene candidate = scene_;
    candidate.mats[at(slice)].coupling = coupling;
    const Scene whole = complete_(std::move(candidate));
    const Network network(whole);
    const RatedNetwork networks(network, rates_);
    Findings findings(whole.file);
    Option option{coupling};
    option.steps = heardSteps(coupling, kHandHz / rates_.gesturalHz());
    for (const PortCertificate& met : judgePorts(networks, {}, findings)) {
      if (whole.ports[at(met.port)].mat == slice) {
        option.level = std::max(option.level, met.level);
        if (met.stiffness >= option.stiffness) {
          option.stiffness = met.stiffness;
          option.limit = met.stiffness_limit;
        }
      }
    }
    return option;
  }

  const Scene& scene_;
  const Rates& rates_;
  const Complete& complete_;
};

std::string describe(const Option& option, double stiffness) {
  static constexpr const char* kWords[] = {"hold", "smooth", "chaplet"};
  std::string text = std::string(kWords[at(static_cast<int>(option.coupling))]) + ": steps of " +
                     shortly(100.0 * option.steps) + " %";
  if (option.error > option.steps + (option.damps ? 1.0 : 0.0)) {
    text += ", " + shortly(option.stiffness) + " of " + shortly(stiffness) + " N/m";
  } else if (stiffness > 0.0) {
    text += ", " + shortly(option.stiffness) + " N/m";
  }
  text += option.limit > 0.0 ? ", passive up to " + shortly(option.limit) + " N/m" : "";
  text += option.damps ? ", it damps what is attached there" : "";
  return text + (option.level == HandLevel::kRefused  ? ", it will buzz"
                 : option.level == HandLevel::kWarned ? ", it may buzz"
                                                      : "");
}

std::string noteOnCoupling(const Scene& scene,
                           int slice,
                           const Option& best,
                           const std::vector<Option>& all) {
  const scene::Mat& mat = scene.mats[at(slice)];
  std::string text = noteAt(scene, mat.place) + "slice '" + mat.name + "' gets coupling " +
                     describe(best, all.front().stiffness) +
                     " (steps: what faster sections hear of a hand at 20 Hz beside its movement)";
  for (const Option& option : all) {
    text += option.coupling == best.coupling ? "" : "; " + describe(option, all.front().stiffness);
  }
  return text;
}

}  // namespace

void chooseCouplings(Scene& scene,
                     const Rates& rates,
                     const Complete& complete,
                     std::vector<std::string>& notes) {
  for (int m = 0; m < static_cast<int>(scene.mats.size()); ++m) {
    scene::Mat& mat = scene.mats[at(m)];
    if (mat.coupling != Coupling::kAuto) {
      continue;
    }
    mat.coupling = Coupling::kHold;
    if (!isSeen(scene, rates, m)) {
      continue;
    }
    const std::vector<Option> options = CouplingChooser(scene, rates, complete).optionsOf(m);
    const Option& best =
        *std::min_element(options.begin(), options.end(),
                          [](const Option& a, const Option& b) { return a.rank() < b.rank(); });
    notes.push_back(noteOnCoupling(scene, m, best, options));
    mat.coupling = best.coupling;
  }
}

void askForChaplets(Scene& scene, const Rates& rates) {
  for (int m = 0; m < static_cast<int>(scene.mats.size()); ++m) {
    Coupling& coupling = scene.mats[at(m)].coupling;
    if (coupling == Coupling::kChaplet) {
      for (scene::Lia& lia : scene.lias) {
        lia.filtered = lia.filtered || fasterEnd(scene, rates, lia, m) >= 0;
      }
    }
    if (coupling != Coupling::kSmooth) {
      coupling = Coupling::kHold;
    }
  }
}

}  // namespace ergotic::physics
