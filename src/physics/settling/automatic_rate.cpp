// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "at.hpp"
#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/physics/certificate/certify.hpp"
#include "physics/network/network_analysis.hpp"
#include "physics/network/rated_network.hpp"
#include "physics/note.hpp"
#include "physics/settling/steps.hpp"

namespace ergotic::physics {
namespace {

using scene::MatType;

bool hasSlice(const scene::Scene& scene, int section) {
  return std::any_of(scene.mats.begin(), scene.mats.end(), [&](const scene::Mat& mat) {
    return mat.section == section && mat.type == MatType::kSlice;
  });
}

/// The section with everything around it held. Cells count as plain ones: matched, each would be
/// exact at any rate, but not heard above half of it.
Network isolated(Network network, int section) {
  for (std::size_t m = 0; m < network.nodes.size(); ++m) {
    Network::Node& node = network.nodes[m];
    if (network.scene.mats[m].type == MatType::kCell) {
      node.is_matched = false;
    }
    if (node.section != section) {
      node.section = section;
      node.is_free = false;
      network.point_of[m] = -1;
    }
  }
  return network;
}

/// Upper bound of its largest eigenvalue.
double lambdaOf(const scene::Scene& scene, const Rates& rates, int section) {
  const Network network = isolated(Network(scene), section);
  const RatedNetwork alone(network, rates);
  return analyse(alone.atOwnRate(divisorOf(scene.sections[at(section)], rates))).lambda;
}

class RateChooser {
 public:
  RateChooser(scene::Scene& scene, const Rates& rates, const Complete& complete)
      : scene_(scene), rates_(rates), complete_(complete) {}

  std::string choose(int s) {
    scene::Section& section = scene_.sections[at(s)];
    section.automatic_rate = false;
    if (hasSlice(scene_, s)) {
      section.gestural = true;
      return say(s, "is gestural: slices of the device are in it");
    }
    const std::optional<scene::Scene> fastest = atDivisor(s, 1);
    std::optional<Verdict> least;  // worked out where it is asked for, which takes long
    for (int d = rates_.ratio; d > 1; --d) {
      if (rates_.ratio % d != 0 || !suitsNeighbours(s, d)) {
        continue;
      }
      const std::optional<scene::Scene> candidate = atDivisor(s, d);
      const double lambda = lambdaAt(candidate, s);
      if (!(lambda < kSlowEnough)) {
        continue;
      }
      least = least ? least : verdictOf(fastest);
      if (verdictOf(candidate) <= least) {
        section.divisor = d;
        return say(s, describe(d, lambda));
      }
    }
    section.divisor = 1;
    return say(s, describe(1, lambdaAt(fastest, s)));
  }

 private:
  /// The settled scene with a section at this rate; nullopt if a part of it cannot be at this rate.
  std::optional<scene::Scene> atDivisor(int s, int d) const {
    scene::Scene candidate = scene_;
    candidate.sections[at(s)].divisor = d;
    for (scene::Section& section : candidate.sections) {
      section.automatic_rate = false;
    }
    try {
      return complete_(std::move(candidate));
    } catch (const Exception&) {
      return std::nullopt;
    }
  }
  double lambdaAt(const std::optional<scene::Scene>& candidate, int s) const {
    return candidate ? lambdaOf(*candidate, rates_, s) : std::numeric_limits<double>::infinity();
  }
  Verdict verdictOf(const std::optional<scene::Scene>& candidate) const {
    return candidate ? certify(*candidate, rates_).verdict : Verdict::kUnstable;
  }

  bool suitsNeighbours(int s, int d) const {
    return std::all_of(scene_.lias.begin(), scene_.lias.end(), [&](const scene::Lia& lia) {
      const int a = scene_.mats[at(lia.a)].section;
      const int b = scene_.mats[at(lia.b)].section;
      if ((a == s) == (b == s)) {
        return true;
      }
      const scene::Section& other = scene_.sections[at(a == s ? b : a)];
      const int theirs = divisorOf(other, rates_);
      return other.automatic_rate || d % theirs == 0 || theirs % d == 0;
    });
  }

  std::string describe(int d, double lambda) const {
    const double rate_hz = rates_.audio_hz / d;
    std::string text = "runs at " + shortly(rate_hz) + " Hz";
    if (!(lambda < 4.0)) {
      return text + ", the fastest there is: its modes are not known to be below half of it";
    }
    const double half = std::sqrt(lambda) / 2.0;
    return text + ": its modes reach up to " + shortly(std::asin(half) / kPi * rate_hz) +
           " Hz at most, where the step makes them " + shortly(raisedCents(lambda)) +
           " cents too high";
  }

  std::string say(int s, const std::string& what) const {
    const scene::Section& section = scene_.sections[at(s)];
    return noteAt(scene_, section.place) + "section '" + section.name + "' " + what;
  }

  scene::Scene& scene_;
  Rates rates_;
  const Complete& complete_;
};

}  // namespace

double raisedCents(double lambda) {
  const double half = std::sqrt(lambda) / 2.0;
  return half > 0.0 ? 1200.0 * std::log2(std::asin(half) / half) : 0.0;
}

void chooseAutomaticRates(scene::Scene& scene,
                          const Rates& rates,
                          const Complete& complete,
                          std::vector<std::string>& notes) {
  RateChooser chooser(scene, rates, complete);
  for (std::size_t s = 0; s < scene.sections.size(); ++s) {
    if (scene.sections[s].automatic_rate) {
      notes.push_back(chooser.choose(static_cast<int>(s)));
    }
  }
}

}  // namespace ergotic::physics
