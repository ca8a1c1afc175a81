// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "at.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/scene/coarse_string.hpp"
#include "ergotic/scene/generate/pitch.hpp"
#include "physics/note.hpp"
#include "physics/settling/coarse_string.hpp"
#include "physics/settling/pitch_pull.hpp"
#include "physics/settling/steps.hpp"
#include "scene/limits.hpp"

namespace ergotic::physics {
namespace {

/// The most masses, `fewest` or more, that are good, less than `masses` that are not; 0: none are.
template <class IsGood>
int mostMasses(int fewest, int masses, const IsGood& is_good) {
  if (masses <= fewest || !is_good(fewest)) {
    return 0;
  }
  int good = fewest;
  for (int bad = masses; bad - good > 1;) {
    const int middle = good + (bad - good) / 2;
    (is_good(middle) ? good : bad) = middle;
  }
  return good;
}

/// Remedies for too many masses.
std::string remedy(int most) {
  const std::string fewer = most > 0 ? "at most " + std::to_string(most) + " masses, " : "";
  return fewer + "a higher rate or a lower frequency";
}

/// Tunes one string that asks for a frequency.
class Tuning {
 public:
  Tuning(scene::Scene& scene, scene::StringInfo& string, const Rates& rates)
      : scene_(scene),
        string_(string),
        masses_(string.count - 2),
        rate_hz_(rates.audio_hz / divisorOf(scene.sectionOf(scene.mats[at(string.first)]), rates)),
        cycles_(string.frequency_hz / rate_hz_),
        loss_(scene::stringLoss(scene, string, rate_hz_)) {}

  void run(std::vector<std::string>& notes) {
    if (!(cycles_ < 0.5)) {
      fail("cannot sound at " + pitch() + ", allowed below half its rate, " +
           scene::numberText(0.5 * rate_hz_) + " Hz. Use " + remedy(0));
    }
    if (!(loss_.ofMode(masses_, string_.coarse ? masses_ : 1) < 1.0)) {
      fail("cannot sound at " + pitch() + ": it loses all of its velocity in a step, " +
           shortly(1.0 / rate_hz_) + " s. Use less damping or loss, or a higher rate");
    }
    if (string_.coarse) {
      fit(notes);
    } else {
      tune();
    }
    string_.frequency_hz = 0.0;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    const scene::Place place = scene_.mats[at(string_.first)].place;
    throw TextError(scene_.file, place.line, place.column, "string '" + string_.name + "' " + what);
  }
  std::string note() const {
    return noteAt(scene_, scene_.mats[at(string_.first)].place) + "string '" + string_.name + "' ";
  }
  std::string pitch() const { return scene::numberText(string_.frequency_hz) + " Hz"; }
  std::string cutTo() const { return pitch() + " with " + std::to_string(masses_) + " masses"; }

  void tune() {
    string_.stiffness = scene::tunedStiffness(scene_, string_, rate_hz_);
    if (scene_.lias[at(string_.first_lia)].scheme != scene::Scheme::kExplicit) {
      requireTension();
    } else if (!isStable(masses_, rate_hz_)) {
      const auto stable = [this](int n) { return isStable(n, rate_hz_); };
      const int most = mostMasses(1, masses_, stable);
      scene_.body_limits.push_back(
          {string_.first, string_.count, string_.first_lia, masses_ + 1,
           scene_.mats[at(string_.first)].place,
           "string '" + string_.name + "' cannot be stepped at " + cutTo() + ". Use " +
               (most > 0 ? "at most " + std::to_string(most) + " masses, " : "") + "a rate of " +
               scene::numberText(std::ceil(stableRate())) + " Hz or more, or a lower frequency"});
    }
    for (int i = 0; i <= masses_; ++i) {
      scene_.lias[at(string_.first_lia + i)].stiffness = string_.stiffness;
    }
  }

  void requireTension() const {
    const auto holds = [this](int n) {
      return scene::holdsPitch(scene_, tunedInto(n, rate_hz_), rate_hz_);
    };
    if (!holds(masses_)) {
      const int most = mostMasses(1, masses_, holds);
      fail("cannot be tuned to " + cutTo() + ": " + flatness(scene_, string_, rate_hz_) +
           (most > 0 ? "; at most " + std::to_string(most) + " masses would do" : ""));
    }
  }

  /// The string with as many masses of the same weight, damped alike.
  scene::StringInfo tunedInto(int masses, double rate_hz) const {
    scene::StringInfo string = string_;
    string.count = masses + 2;
    string.stiffness = scene::tunedStiffness(scene_, string, rate_hz);
    return string;
  }
  /// True if the string by itself is stable in motion along its links, where it is stiffest.
  bool isStable(int masses, double rate_hz) const {
    const double kappa = scene::stringKappa(scene_, tunedInto(masses, rate_hz), rate_hz);
    const double zeta = scene::stringZeta(scene_, string_, rate_hz);
    const double ground = scene::stringLoss(scene_, string_, rate_hz).ground;
    const double top = scene::stringEigenvalue(masses, masses);
    return top * (kappa + 2.0 * zeta) + 2.0 * ground < 4.0;
  }
  /// The lowest rate at which it is stable, tuned anew: stiffer there than here. \pre here it is
  /// not
  double stableRate() const {
    double stable = 2.0 * rate_hz_;
    while (!isStable(masses_, stable)) {
      stable *= 2.0;
    }
    double unstable = 0.5 * stable;
    for (int halving = 0; halving < 40; ++halving) {
      const double middle = 0.5 * (unstable + stable);
      (isStable(masses_, middle) ? stable : unstable) = middle;
    }
    return stable;
  }

  void fit(std::vector<std::string>& notes) {
    if (masses_ < scene::kFewestCoarseMasses) {
      fail("is coarse with " + std::to_string(masses_) + " masses, allowed " +
           std::to_string(scene::kFewestCoarseMasses) + " or more");
    }
    requireFit();
    const CoarseFit fit = fitted(masses_);
    notes.push_back(noteAbout(fit));
    setSprings(fit);
  }

  CoarseFit fitted(int masses) const {
    return fitCoarseString(masses, cycles_, fittedPartials(masses), loss_);
  }
  bool hasRoom(int masses) const { return fittedPartials(masses) * cycles_ < 0.5; }

  void requireFit() const {
    const auto fits = [this](int n) { return hasRoom(n) && wildMode(fitted(n), n) == 0; };
    // Where mode N would be above half the rate a fit holds by chance only.
    const int too_many = std::min(masses_, static_cast<int>(0.5 / cycles_) + 1);
    const auto help = [&] {
      return ". Use " + remedy(mostMasses(scene::kFewestCoarseMasses, too_many, fits));
    };
    if (!hasRoom(masses_)) {
      fail("has " + std::to_string(fittedPartials(masses_)) + " partials of " + pitch() +
           " to fit, allowed below half its rate, " + scene::numberText(0.5 * rate_hz_) + " Hz" +
           help());
    }
    const CoarseFit fit = fitted(masses_);
    if (const int mode = wildMode(fit, masses_); mode > 0) {
      fail("cannot be tuned to " + cutTo() + ": mode " + std::to_string(mode) +
           " would have the eigenvalue " + shortly(coarseEigenvalue(fit, masses_, mode)) +
           ", allowed 0...4" + help());
    }
  }

  std::string noteAbout(const CoarseFit& fit) const {
    const int partials = static_cast<int>(fit.cents.size());
    const int half = (partials + 1) / 2;
    return note() + "is tuned to the partials of an ideal string of " + pitch() +
           " with springs to three neighbours, error " + shortly(fit.worstCents(half)) +
           " cents on " + std::to_string(half) + ", " + shortly(fit.worstCents(partials)) +
           " cents on " + std::to_string(partials) + " partials";
  }

  void setSprings(const CoarseFit& fit) {
    const double unit = std::pow(rate_hz_ * scene_.time_unit_s, 2);
    for (int i = 0; i < scene::coarseLinks(masses_); ++i) {
      const double kappa = scene::coarseLink(masses_, i).stiffness(fit.kappa);
      scene_.lias[at(string_.first_lia + i)].stiffness = kappa * unit * string_.mass;
    }
    // One spring with the same fundamental: what the string's closed-form pitch is computed from.
    const double plain = coarseEigenvalue(fit, masses_, 1) / scene::stringEigenvalue(masses_, 1);
    string_.stiffness = plain * unit * string_.mass;
  }

  scene::Scene& scene_;
  scene::StringInfo& string_;
  int masses_;
  double rate_hz_;
  double cycles_;  // of the fundamental in a step
  scene::StringLoss loss_;
};

}  // namespace

void tuneStrings(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes) {
  for (scene::StringInfo& string : scene.strings) {
    if (string.frequency_hz > 0.0) {
      Tuning(scene, string, rates).run(notes);
    }
  }
}

}  // namespace ergotic::physics
