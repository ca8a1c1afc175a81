// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/truths.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/exception.hpp"
#include "tools/lib/feel.hpp"
#include "tools/lib/truth_play.hpp"

namespace ergotic::tools {
namespace {

using scene::Truth;
using What = Truth::What;

constexpr double kSpan = 0.03;  // of a frequency next to which a line is looked for
constexpr double kLineS = 1.0;  // in which lines are told apart
constexpr double kGlideS = 0.1;
constexpr double kLongestS = 60.0;  // that are played unasked

/// Frequency of the j-th partial, Hz.
double partialHz(const Truth& truth, int j) {
  const double b = truth.inharmonicity;
  return truth.near_hz * j * std::sqrt((1.0 + b * j * j) / (1.0 + b));
}

/// Duration to play after the tap or pluck, s.
double secondsOf(const Truth& truth) {
  const auto largest = [](const std::vector<double>& of, double otherwise) {
    return of.empty() ? otherwise : *std::max_element(of.begin(), of.end());
  };
  const double asked = truth.seconds;
  const double expected = largest(truth.expected, std::isfinite(truth.most)    ? truth.most
                                                  : std::isfinite(truth.least) ? truth.least
                                                                               : 1.0);
  switch (truth.what) {
    case What::kT60:
    case What::kDoubleDecay:
      return truth.after_s +
             (asked > 0.0 ? asked : std::clamp(0.9 * expected + 0.5, 0.5, kLongestS));
    case What::kBeats:
      return truth.after_s + (asked > 0.0 ? asked : std::clamp(4.0 / expected, 1.0, kLongestS));
    case What::kCentroid:
      return largest(truth.times_s, 0.0) + 0.1;
    case What::kGlide:
      return largest(truth.times_s, 0.0) + (asked > 0.0 ? asked : kGlideS) + 0.01;
    case What::kPitch:
    case What::kPartials:
    case What::kRatios:
    case What::kHarmonicsLeft:
    case What::kContact:
    case What::kForce:
    case What::kSilence:
    case What::kEnergy:
      break;
  }
  return truth.after_s + (asked > 0.0 ? asked : kLineS) + 0.01;
}

/// Truths that one performance serves.
struct Performance {
  std::vector<std::size_t> truths;
  std::vector<scene::Output> outputs;
  double seconds = 0.0;
};

class Judge {
 public:
  Judge(const scene::ClaimingScene& claims,
        const physics::Rates& rates,
        const physics::CompileOptions& options)
      : claims_(claims), rates_(rates), options_(options), judged_(claims.truths.size()) {}

  std::vector<JudgedTruth> run() {
    for (std::size_t i = 0; i < claims_.truths.size(); ++i) {
      if (claims_.truths[i].what == What::kForce) {
        judge(i, [&](const Truth& truth) { return std::vector<double>{feltFigure(truth)}; });
      } else {
        plan(i);
      }
    }
    for (const Performance& one : performances_) {
      perform(one);
    }
    return std::move(judged_);
  }

 private:
  void plan(std::size_t i) {
    const Truth& truth = claims_.truths[i];
    auto found = std::find_if(performances_.begin(), performances_.end(), [&](const auto& one) {
      return arePlayedAlike(claims_.truths[one.truths.front()], truth);
    });
    if (found == performances_.end()) {
      performances_.emplace_back();
      found = std::prev(performances_.end());
    }
    found->truths.push_back(i);
    found->seconds = std::max(found->seconds, secondsOf(truth));
    for (scene::Output& output : listensTo(truth)) {
      found->outputs.push_back(std::move(output));
    }
  }

  /// Outputs of a truth, in the order in which it takes them.
  std::vector<scene::Output> listensTo(const Truth& truth) const {
    const scene::Scene& scene = claims_.scene;
    if (truth.what == What::kEnergy) {
      return {};
    }
    if (truth.what != What::kContact) {
      return {scene.outputs[static_cast<std::size_t>(truth.output)]};
    }
    const scene::Lia& lia = scene.lias[static_cast<std::size_t>(truth.lia)];
    scene::Output output;
    output.gain.factor = 1.0;
    if (truth.figure == Truth::Figure::kPeak) {
      const auto links = std::count_if(
          scene.lias.begin(), scene.lias.end(),
          [&](const scene::Lia& other) { return other.a == lia.a || other.b == lia.a; });
      output.quantity = scene::Quantity::kForce;
      output.point.mat = links == 1 ? lia.a : lia.b;
      return {output};
    }
    output.quantity = scene::Quantity::kPosition;
    scene::Output other = output;
    output.point.mat = lia.a;
    other.point.mat = lia.b;
    return {output, other};
  }

  void perform(const Performance& one) {
    PlayedTruth played;
    std::string trouble;
    physics::CompileOptions options = options_;
    options.metered = std::any_of(one.truths.begin(), one.truths.end(), [this](std::size_t i) {
      return claims_.truths[i].what == What::kEnergy;
    });
    try {
      played = playTruth(claims_.scene, claims_.truths[one.truths.front()], one.outputs,
                         one.seconds, rates_, options);
    } catch (const Exception& error) {
      trouble = error.what();
    }
    std::size_t sound = 0;
    for (const std::size_t i : one.truths) {
      const std::size_t first = sound;
      sound += listensTo(claims_.truths[i]).size();
      judge(i, [&](const Truth& truth) {
        if (!trouble.empty()) {
          throw Exception(trouble);
        }
        return measure(truth, played, first);
      });
    }
  }

  template <class Measure>
  void judge(std::size_t i, const Measure& measured) {
    const Truth& truth = claims_.truths[i];
    JudgedTruth& result = judged_[i];
    try {
      result.measured = measured(truth);
      compare(truth, result);
    } catch (const Exception& error) {
      result.trouble = error.what();
    }
  }

  static void compare(const Truth& truth, JudgedTruth& result) {
    const std::vector<double> expected = expectedOf(truth);
    if (expected.empty()) {
      const double value = result.measured.front();
      result.holds = value >= truth.least && value <= truth.most;
      return;
    }
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const double ratio = result.measured[k] / expected[k];
      double off = std::abs(result.measured[k] - expected[k]);
      switch (truth.tolerance) {
        case Truth::Tolerance::kCents:
          off = std::abs(1200.0 * std::log2(ratio));
          break;
        case Truth::Tolerance::kDecibels:
          off = std::abs(20.0 * std::log10(ratio));
          break;
        case Truth::Tolerance::kRelative:
          off = std::abs(ratio - 1.0);
          break;
        case Truth::Tolerance::kAbsolute:
          break;
      }
      // What is no number is off.
      result.off = off <= result.off ? result.off : off;
    }
    result.holds = result.off <= truth.within;
  }

  double feltFigure(const Truth& truth) const {
    station::PerformerPolicy policy;
    policy.allow_unproven = true;
    const auto performer = station::makePerformer(claims_.scene, rates_, options_, policy);
    const scene::Port& port = claims_.scene.ports[static_cast<std::size_t>(truth.port)];
    const StrokeFigures felt = figuresOf(feel(*performer, port.slice, truth.travel, truth.speed));
    switch (truth.figure) {
      case Truth::Figure::kRelease:
        if (felt.release_n == 0.0) {
          throw Exception("nothing lets go within " + std::to_string(truth.travel) + " m");
        }
        return felt.release_n;
      case Truth::Figure::kStiffness:
        return felt.stiffest;
      case Truth::Figure::kWork:
        return felt.press_j;
      case Truth::Figure::kPeak:
      case Truth::Figure::kDuration:
        break;
    }
    return felt.peak_n;
  }

  std::vector<double> measure(const Truth& truth,
                              const PlayedTruth& played,
                              std::size_t sound) const {
    if (truth.what == What::kEnergy) {
      return {played.imbalance};
    }
    const Sound& heard = played.sounds[sound];
    const double begin_s = played.begin_s + truth.after_s;
    const double line_s = truth.seconds > 0.0 ? truth.seconds : kLineS;
    const auto line = [&](double hz) { return lineNear(heard, begin_s, line_s, hz, kSpan); };
    switch (truth.what) {
      case What::kPitch:
        return {line(truth.near_hz).hz};
      case What::kPartials:
        return partials(truth, line);
      case What::kRatios:
        return ratios(truth, line);
      case What::kHarmonicsLeft:
        return {harmonicsLeft(truth, line)};
      case What::kT60:
        return {decayOf(cut(heard, begin_s + secondsOf(truth) - truth.after_s), begin_s,
                        truth.near_hz)};
      case What::kBeats: {
        const std::vector<Pole> poles = polesNear(
            cut(heard, begin_s + secondsOf(truth) - truth.after_s), begin_s, truth.near_hz, 2);
        return {poles[1].hz - poles[0].hz};
      }
      case What::kDoubleDecay: {
        const std::vector<Pole> poles = polesNear(
            cut(heard, begin_s + secondsOf(truth) - truth.after_s), begin_s, truth.near_hz, 2);
        return {std::min(poles[0].t60_s, poles[1].t60_s), std::max(poles[0].t60_s, poles[1].t60_s)};
      }
      case What::kCentroid:
        return {centroid(truth, heard, played.begin_s)};
      case What::kGlide: {
        const double length = truth.seconds > 0.0 ? truth.seconds : kGlideS;
        const auto at = [&](double time_s) {
          return lineNear(heard, played.begin_s + time_s, length, truth.near_hz, kBroadSpan).hz;
        };
        return {at(truth.times_s[1]) / at(truth.times_s[0])};
      }
      case What::kSilence:
        return {levelAfter(heard, begin_s)};
      case What::kContact:
        return {contact(truth, played, sound)};
      case What::kForce:
      case What::kEnergy:
        break;
    }
    return {};
  }

  /// Cuts a sound at a time: the rest of a performance, for other truths, must not change the
  /// result.
  static Sound cut(const Sound& sound, double end_s) {
    Sound part = sound;
    part.samples.resize(std::min(part.samples.size(),
                                 static_cast<std::size_t>(std::llround(end_s * sound.rate_hz))));
    return part;
  }

  template <class LineAt>
  static std::vector<double> partials(const Truth& truth, const LineAt& line) {
    std::vector<double> hz;
    for (int j = 1; j <= truth.partials; ++j) {
      hz.push_back(line(partialHz(truth, j)).hz);
    }
    return hz;
  }

  template <class LineAt>
  static std::vector<double> ratios(const Truth& truth, const LineAt& line) {
    std::vector<double> hz;
    for (const double ratio : truth.expected) {
      hz.push_back(line(truth.near_hz * ratio / truth.expected.front()).hz);
    }
    std::vector<double> measured;
    for (const double one : hz) {
      measured.push_back(one / hz.front() * truth.expected.front());
    }
    return measured;
  }

  template <class LineAt>
  static double harmonicsLeft(const Truth& truth, const LineAt& line) {
    double left = 0.0;
    double others = 0.0;
    for (int j = 1; j <= truth.partials; ++j) {
      double& loudest = j % truth.divisor == 0 ? left : others;
      loudest = std::max(loudest, line(partialHz(truth, j)).amplitude);
    }
    return left / others;
  }

  static double centroid(const Truth& truth, const Sound& heard, double begin_s) {
    const double first = centroidAt(heard, begin_s + truth.times_s[0]);
    return truth.times_s.size() == 1 ? first
                                     : centroidAt(heard, begin_s + truth.times_s[1]) / first;
  }

  double contact(const Truth& truth, const PlayedTruth& played, std::size_t sound) const {
    const std::vector<double>& first = played.sounds[sound].samples;
    if (truth.figure == Truth::Figure::kPeak) {
      double peak = 0.0;
      for (const double force : first) {
        peak = std::max(peak, std::abs(force));
      }
      return peak;
    }
    const std::vector<double>& second = played.sounds[sound + 1].samples;
    const scene::Lia& lia = claims_.scene.lias[static_cast<std::size_t>(truth.lia)];
    const double threshold = claims_.scene.valueOf(lia.law->width);
    std::vector<double> distance;
    for (std::size_t i = 0; i < first.size(); ++i) {
      distance.push_back(second[i] - first[i] - threshold);
    }
    return longestBelow(distance, played.sounds[sound].rate_hz);
  }

  static constexpr double kBroadSpan = 0.12;  // of what glides

  const scene::ClaimingScene& claims_;
  physics::Rates rates_;
  physics::CompileOptions options_;
  std::vector<Performance> performances_;
  std::vector<JudgedTruth> judged_;
};

}  // namespace

std::vector<double> expectedOf(const Truth& truth) {
  std::vector<double> expected = truth.expected;
  for (int j = 1; truth.what == What::kPartials && j <= truth.partials; ++j) {
    expected.push_back(partialHz(truth, j));
  }
  return expected;
}

std::vector<JudgedTruth> judgeTruths(const scene::ClaimingScene& claims,
                                     const physics::Rates& rates,
                                     const physics::CompileOptions& options) {
  return Judge(claims, rates, options).run();
}

}  // namespace ergotic::tools
