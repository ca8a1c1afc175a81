// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/advice/target.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "advice/target_parts.hpp"
#include "ergotic/advice/accuracy.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/certificate/precision.hpp"
#include "ergotic/physics/settling/chaplet.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "physics/note.hpp"

namespace ergotic::physics {
namespace {

using Unit = Target::Unit;

/// Audio rates that sound cards have; lower ones leave too little of the sound.
constexpr double kRates[] = {22050.0, 44100.0, 48000.0, 88200.0, 96000.0, 176400.0, 192000.0};
constexpr std::size_t kMaxTrials = 24;  // settlings of candidates, cheapest first
constexpr double kCostGrain = 50.0;     // costs within 2 % are alike

struct UnitRule {
  const char* names[2];
  Unit unit;
  double least;
  double most;
};
constexpr UnitRule kUnits[] = {{{"cent", "cents"}, Unit::kCents, 0.01, 100.0},
                               {{"dB", "db"}, Unit::kDecibels, 0.001, 6.0},
                               {{"%", "percent"}, Unit::kPercent, 0.001, 50.0}};

std::string allowedTargets() {
  std::string text;
  for (const UnitRule& rule : kUnits) {
    text += (text.empty() ? "" : ", ") + shortly(rule.least) + "..." + shortly(rule.most) + " " +
            rule.names[0];
  }
  return text;
}

/// Cost of everything that is not a part of its own, by the sections of both ends: steps of modules
/// and links.
class RestCost {
 public:
  /// \param with_strings  strings count here
  RestCost(const scene::Scene& scene, bool with_strings) : scene_(scene) {
    for (const scene::Mat& mat : scene.mats) {
      const bool moves = mat.type == scene::MatType::kMass || mat.type == scene::MatType::kCell;
      elements_[{mat.section, mat.section}] += moves ? 1.0 : 0.0;
    }
    for (const scene::Lia& lia : scene.lias) {
      elements_[{sectionOf(lia.a), sectionOf(lia.b)}] += 1.0;
    }
    if (with_strings) {
      return;
    }
    for (const scene::StringInfo& string : scene.strings) {
      const scene::StringCut cut = scene::cutOf(string);
      const int links = cut.coarse ? 3 * cut.masses + 6 : cut.masses + 1;
      elements_[{sectionOf(string.first), sectionOf(string.first)}] -= cut.masses + links;
    }
  }
  double at(const Rates& rates) const {
    double cost = 0.0;
    for (const auto& [sections, count] : elements_) {
      cost += count * std::max(rateOf(sections.first, rates), rateOf(sections.second, rates));
    }
    return cost;
  }

 private:
  int sectionOf(int mat) const { return scene_.mats[static_cast<std::size_t>(mat)].section; }
  double rateOf(int section, const Rates& rates) const {
    return rates.audio_hz / divisorOf(scene_.sections[static_cast<std::size_t>(section)], rates);
  }

  const scene::Scene& scene_;
  std::map<std::pair<int, int>, double> elements_;
};

/// Options for all parts at some rates.
struct Candidate {
  Rates rates;
  Precision precision = Precision::kFloat;
  std::vector<PartOption> options;
  double worst = 0.0;
  double cost = 0.0;
};

/// Merges advice on parts that are treated alike; the worst counts.
void merge(Advice& to, const Advice& more) {
  to.part = more.present > to.present ? more.part : to.part;
  to.present = std::max(to.present, more.present);
  to.proposed = std::max(to.proposed, more.proposed);
  ++to.parts;
}

double floatError(Unit unit) {
  return unit == Unit::kCents ? kFloatPitchError : kFloatSoundError;
}

class SettingSearch {
 public:
  SettingSearch(const scene::Scene& scene,
                const Rates& rates,
                Precision precision,
                const Target& target,
                const Freedom& freedom)
      : scene_(scene),
        rates_(rates),
        precision_(precision),
        target_(target),
        freedom_(freedom),
        settled_(settle(scene, rates)),
        moves_freely_(!bodiesThatMoveFreely(settled_.scene).empty()),
        certificate_(certify(settled_.scene, rates)),
        rest_(scene, target.unit == Unit::kDecibels) {
    findParts();
  }

  Proposal run() {
    std::vector<Candidate> candidates = all();
    const double allowed = target_.relative();
    // Where it hardly matters, the gestural rate stays what it is.
    const auto price = [&](const Candidate& c) {
      return std::pair(std::round(kCostGrain * std::log(c.cost)),
                       std::abs(std::log(c.rates.gesturalHz() / rates_.gesturalHz())));
    };
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](const Candidate& a, const Candidate& b) {
                       const bool good[2] = {a.worst <= allowed, b.worst <= allowed};
                       return std::tuple(!good[0], good[0] ? 0.0 : a.worst, price(a)) <
                              std::tuple(!good[1], good[1] ? 0.0 : b.worst, price(b));
                     });
    for (std::size_t i = 0; i < std::min(candidates.size(), kMaxTrials); ++i) {
      std::optional<scene::Scene> scene = applied(candidates[i]);
      if (scene) {
        return proposalOf(candidates[i], std::move(*scene));
      }
    }
    return proposalOf(present(), scene_);
  }

 private:
  void findParts() {
    std::vector<std::string> chaplets;
    for (const FoundChaplet& found : findChaplets(settled_.scene, rates_)) {
      const bool is_own = std::any_of(scene_.mats.begin(), scene_.mats.end(), [&](const auto& mat) {
        return mat.name == found.name + ".0";
      });
      if (is_own) {
        chaplets.push_back(found.name);
      }
    }
    if (!chaplets.empty() && freedom_.gestural_rate) {
      freedom_.gestural_rate = false;
      remarks_.push_back("the gestural rate is kept: chaplet '" + chaplets.front() +
                         "' is tuned to it");
    }
    addLinkParts(scene_, chaplets, target_.unit, parts_);
    if (target_.unit != Unit::kDecibels) {
      addModeParts(scene_, parts_);
      addStringParts(scene_, parts_);
    }
    if (parts_.empty()) {
      throw Exception(scene_.file + ": nothing in this scene can be judged in " +
                      (target_.unit == Unit::kCents ? "cents (strings, bows, modes, contacts)"
                                                    : "dB (contacts, hands at faster sections)") +
                      "; allowed are targets of another kind: " + allowedTargets());
    }
  }

  std::vector<Candidate> all() const {
    std::vector<Candidate> candidates;
    std::vector<double> audio_rates{rates_.audio_hz};
    if (freedom_.audio_rate) {
      audio_rates.assign(std::begin(kRates), std::end(kRates));
    }
    for (const double audio_hz : audio_rates) {
      for (const Rates& rates : ratesAt(audio_hz)) {
        if (bearsTheWalls(rates)) {
          candidates.push_back(evaluate(rates, [&](const TargetPart& part) {
            return part.choose(rates, target_.relative());
          }));
        }
      }
    }
    return candidates;
  }

  /// Legal ratios; the one nearest to the present gestural rate where that may not change.
  std::vector<Rates> ratesAt(double audio_hz) const {
    std::vector<Rates> result;
    const bool is_gestural =
        std::any_of(scene_.sections.begin(), scene_.sections.end(),
                    [](const scene::Section& s) { return s.gestural || s.automatic_rate; });
    const bool fixed = !freedom_.gestural_rate || !is_gestural;
    const int nearest = static_cast<int>(
        std::clamp(std::round(audio_hz / rates_.gesturalHz()), 1.0, double{kMaxRatio}));
    for (int ratio = fixed ? nearest : 1; ratio <= (fixed ? nearest : kMaxRatio); ++ratio) {
      try {
        result.push_back(chooseRates(scene_, audio_hz, audio_hz / ratio));
      } catch (const Exception&) {
        continue;  // a section's divisor does not go with it
      }
    }
    return result;
  }

  bool bearsTheWalls(const Rates& rates) const {
    const HandLoop loop({}, 1.0 / rates.gesturalHz(), std::max(2, rates.ratio));
    return rates.gesturalHz() >= rates_.gesturalHz() * (1.0 - 1e-9) ||
           std::all_of(certificate_.ports.begin(), certificate_.ports.end(),
                       [&](const PortCertificate& port) {
                         return loop.judge(loadOf(port)) == HandLevel::kSilent;
                       });
  }

  template <class Choose>
  Candidate evaluate(const Rates& rates, const Choose& choose) const {
    Candidate candidate{rates, precision_, {}, 0.0, rest_.at(rates)};
    for (const auto& part : parts_) {
      candidate.options.push_back(choose(*part));
      candidate.worst = std::max(candidate.worst, candidate.options.back().error);
      candidate.cost += candidate.options.back().cost;
    }
    if (freedom_.precision) {
      const bool is_enough = !moves_freely_ && floatError(target_.unit) <= target_.relative();
      candidate.precision = is_enough ? Precision::kFloat : Precision::kDouble;
    }
    if (candidate.precision == Precision::kFloat) {
      candidate.worst = std::max(candidate.worst, floatError(target_.unit));
    }
    candidate.cost *= candidate.precision == Precision::kDouble ? kDoubleCost : 1.0;
    return candidate;
  }

  Candidate present() const {
    Candidate candidate =
        evaluate(rates_, [&](const TargetPart& part) { return part.asItIs(rates_); });
    const double weight = precision_ == Precision::kDouble ? kDoubleCost : 1.0;
    candidate.cost *= weight / (candidate.precision == Precision::kDouble ? kDoubleCost : 1.0);
    candidate.precision = precision_;
    return candidate;
  }

  /// The scene with a candidate applied; nullopt if it cannot be settled at these rates or is less
  /// safe than before.
  std::optional<scene::Scene> applied(const Candidate& candidate) const {
    try {
      scene::Scene scene = scene_;
      for (std::size_t p = 0; p < parts_.size(); ++p) {
        parts_[p]->apply(scene, candidate.options[p]);
      }
      const Settled settled = settle(scene, candidate.rates);
      const Verdict verdict = certify(settled.scene, candidate.rates).verdict;
      return verdict <= std::max(certificate_.verdict, Verdict::kBounded) ? std::optional(scene)
                                                                          : std::nullopt;
    } catch (const TextError&) {
      return std::nullopt;
    }
  }

  Proposal proposalOf(const Candidate& candidate, scene::Scene scene) {
    const Candidate now = present();
    Proposal proposal{std::move(scene), candidate.rates, candidate.precision, {},
                      remarks_,         now.cost,        candidate.cost,      false};
    std::map<std::tuple<std::string, std::string, std::string, std::string>, std::size_t> known;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      const PartOption& option = candidate.options[p];
      const Advice advice{parts_[p]->name(),        parts_[p]->figure(), 1,
                          now.options[p].error,     option.error,        option.change,
                          parts_[p]->remark(option)};
      const std::string kind = advice.part.substr(0, advice.part.find('\''));
      const auto [like, is_new] = known.try_emplace(
          {kind, advice.figure, advice.change, advice.remark}, proposal.advice.size());
      if (is_new) {
        proposal.advice.push_back(advice);
      } else {
        merge(proposal.advice[like->second], advice);
      }
    }
    proposal.is_reached = candidate.worst <= target_.relative();
    return proposal;
  }

  const scene::Scene& scene_;
  Rates rates_;
  Precision precision_;
  Target target_;
  Freedom freedom_;
  Settled settled_;
  bool moves_freely_;  // then only double is enough
  Certificate certificate_;
  RestCost rest_;
  Parts parts_;
  std::vector<std::string> remarks_;
};

}  // namespace

double Target::relative() const {
  switch (unit) {
    case Unit::kCents:
      return std::exp2(value / 1200.0) - 1.0;
    case Unit::kDecibels:
      return std::pow(10.0, value / 20.0) - 1.0;
    case Unit::kPercent:
      return value / 100.0;
  }
  return 0.0;
}

Target targetOf(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  std::string unit(end);
  unit.erase(0, std::min(unit.find_first_not_of(' '), unit.size()));
  for (const UnitRule& rule : kUnits) {
    const bool is_it =
        std::find(std::begin(rule.names), std::end(rule.names), unit) != std::end(rule.names);
    if (is_it && end != text.c_str() && value >= rule.least && value <= rule.most) {
      return {value, rule.unit};
    }
  }
  throw Exception("target '" + text + "' is not an accuracy, allowed: " + allowedTargets());
}

std::string inUnit(double error, Unit unit) {
  const auto named = [](const std::string& cents) {
    return cents + (cents == "1" ? " cent" : " cents");
  };
  if (!(error < 1.0)) {
    return "out of reach";
  }
  switch (unit) {
    case Unit::kCents:
      return named(shortly(1200.0 * std::log2(1.0 + error)));
    case Unit::kDecibels:
      return shortly(20.0 * std::log10(1.0 + error)) + " dB";
    case Unit::kPercent:
      return shortly(100.0 * error) + " %";
  }
  return {};
}

Proposal propose(const scene::Scene& scene,
                 const Rates& rates,
                 Precision precision,
                 const Target& target,
                 const Freedom& freedom) {
  return SettingSearch(scene, rates, precision, target, freedom).run();
}

}  // namespace ergotic::physics
