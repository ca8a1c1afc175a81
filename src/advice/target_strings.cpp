// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "advice/target_parts.hpp"
#include "at.hpp"
#include "ergotic/advice/accuracy.hpp"
#include "ergotic/scene/coarse_string.hpp"
#include "physics/network/linear_network.hpp"
#include "physics/note.hpp"

namespace ergotic::physics {
namespace {

using scene::StringCut;

constexpr int kMaxMasses = 1000;  // of a string that is proposed
constexpr int kMaxCoarse = 80;
constexpr int kMaxModes = 300;

double rateOf(const scene::Section& section, const Rates& rates) {
  return rates.audio_hz / divisorOf(section, rates);
}

std::string describe(const StringCut& cut) {
  return std::to_string(cut.masses) + (cut.coarse ? " masses, coarse" : " masses");
}

double elementsOf(const StringCut& cut) {
  return cut.masses + (cut.coarse ? scene::coarseLinks(cut.masses) : cut.masses + 1);
}

class StringPart final : public TargetPart {
 public:
  StringPart(const scene::Scene& scene, int index)
      : string_(scene.strings[at(index)]),
        section_(scene.sectionOf(scene.mats[at(string_.first)])),
        index_(index),
        pitch_hz_(scene::idealPitchHz(scene, string_)),
        reason_(scene::reasonAgainstCutting(scene, index)),
        can_be_coarse_(scene::canBeCoarse(scene, index)) {}

  std::string name() const override { return "string '" + string_.name + "'"; }
  std::string figure() const override { return "worst of ten partials"; }

  PartOption asItIs(const Rates& rates) const override {
    return option(scene::cutOf(string_), rates);
  }

  PartOption choose(const Rates& rates, double allowed) const override {
    const auto [known, is_new] = chosen_.try_emplace({rateOf(section_, rates), allowed});
    if (is_new) {
      known->second = search(rates, allowed);
    }
    return known->second;
  }

  void apply(scene::Scene& scene, const PartOption& option) const override {
    const StringCut now = scene::cutOf(string_);
    if (option.cut.masses != now.masses || option.cut.coarse != now.coarse) {
      scene = scene::cutString(scene, index_, option.cut);
    }
  }

  std::string remark(const PartOption& option) const override {
    if (!reason_.empty()) {
      return "stays cut as it is: " + reason_;
    }
    if (option.cut.masses < string_.count - 2) {
      return "it then has " + std::to_string(option.cut.masses) + " partials in all, up to about " +
             shortly(pitch_hz_ * option.cut.masses) + " Hz";
    }
    return {};
  }

 private:
  double errorOf(const StringCut& cut, double rate_hz) const {
    return stringError(cut, pitch_hz_ / rate_hz, string_.frequency_hz > 0.0);
  }

  PartOption search(const Rates& rates, double allowed) const {
    PartOption best = asItIs(rates);
    if (!reason_.empty()) {
      return best;
    }
    const auto consider = [&](const StringCut& cut) {
      const PartOption next = option(cut, rates);
      const bool is_good = next.error <= allowed;
      if (best.error <= allowed ? is_good && next.cost < best.cost : next.error < best.error) {
        best = next;
      }
      return is_good;
    };
    // More masses are better until the step cannot carry them; the first that do are the cheapest.
    for (int masses = kJudgedPartials; masses <= kMaxMasses; ++masses) {
      const StringCut cut{masses, false};
      if (consider(cut) || !std::isfinite(errorOf(cut, rateOf(section_, rates)))) {
        break;
      }
    }
    for (int masses = kJudgedPartials; can_be_coarse_ && masses <= kMaxCoarse; ++masses) {
      if (consider({masses, true})) {
        break;
      }
    }
    return best;
  }

  PartOption option(const StringCut& cut, const Rates& rates) const {
    PartOption result;
    const double rate_hz = rateOf(section_, rates);
    result.cut = cut;
    result.error = errorOf(cut, rate_hz);
    result.cost = elementsOf(cut) * rate_hz;
    const StringCut now = scene::cutOf(string_);
    if (cut.masses != now.masses || cut.coarse != now.coarse) {
      result.change = describe(now) + " -> " + describe(cut);
    }
    return result;
  }

  scene::StringInfo string_;
  scene::Section section_;
  int index_;
  double pitch_hz_;
  std::string reason_;
  bool can_be_coarse_;
  mutable std::map<std::pair<double, double>, PartOption> chosen_;  // by rate and what is allowed
};

/// A section without strings: its ten lowest modes.
class ModesPart final : public TargetPart {
 public:
  ModesPart(const scene::Section& section, double highest) : section_(section), omega_(highest) {}

  std::string name() const override { return "section '" + section_.name + "'"; }
  std::string figure() const override { return "worst of its ten lowest modes"; }
  PartOption asItIs(const Rates& rates) const override {
    PartOption result;
    result.error = modeError(omega_ / rateOf(section_, rates));
    return result;
  }
  PartOption choose(const Rates& rates, double /*allowed*/) const override { return asItIs(rates); }

 private:
  scene::Section section_;
  double omega_;  // rad/s
};

/// The tenth of the modes of a section that move, rad/s; 0: nothing to judge.
double tenthMode(const Network& network, int section) {
  std::vector<double> squares = LinearNetwork(network, section).modes(kMaxModes);
  const double still = squares.empty() ? 0.0 : 1e-12 * squares.back();
  squares.erase(std::remove_if(squares.begin(), squares.end(),
                               [still](double square) { return square <= still; }),
                squares.end());
  const std::size_t last = std::min<std::size_t>(squares.size(), kJudgedPartials);
  return last == 0 ? 0.0 : std::sqrt(squares[last - 1]);
}

/// False of sections that are strings, and of those of matched cells that no spring holds: exact.
bool hasModesToJudge(const scene::Scene& scene, int section) {
  const auto is_here = [&](int mat) { return scene.mats[at(mat)].section == section; };
  const bool has_string =
      std::any_of(scene.strings.begin(), scene.strings.end(),
                  [&](const scene::StringInfo& string) { return is_here(string.first); });
  const bool has_springs =
      std::any_of(scene.lias.begin(), scene.lias.end(), [&](const scene::Lia& lia) {
        return lia.type == scene::LiaType::kSpringDamper && is_here(lia.a) && is_here(lia.b);
      });
  const bool has_plain_cells =
      std::any_of(scene.mats.begin(), scene.mats.end(), [&](const scene::Mat& mat) {
        return mat.section == section && mat.type == scene::MatType::kCell && !mat.matched;
      });
  return !has_string && (has_springs || has_plain_cells);
}

}  // namespace

void addStringParts(const scene::Scene& scene, Parts& parts) {
  for (int s = 0; s < static_cast<int>(scene.strings.size()); ++s) {
    if (scene::idealPitchHz(scene, scene.strings[at(s)]) > 0.0) {
      parts.push_back(std::make_unique<StringPart>(scene, s));
    }
  }
}

void addModeParts(const scene::Scene& scene, Parts& parts) {
  const Network network(scene);
  for (int s = 0; s < static_cast<int>(scene.sections.size()); ++s) {
    const double omega = hasModesToJudge(scene, s) ? tenthMode(network, s) : 0.0;
    if (omega > 0.0) {
      parts.push_back(std::make_unique<ModesPart>(scene.sections[at(s)], omega));
    }
  }
}

}  // namespace ergotic::physics
