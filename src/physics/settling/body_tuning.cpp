// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <sstream>

#include "at.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/scene/generate/pitch.hpp"
#include "ergotic/scene/origin.hpp"
#include "physics/note.hpp"
#include "physics/settling/steps.hpp"
#include "physics/step_units.hpp"
#include "scene/generate/bar.hpp"
#include "scene/generate/body.hpp"
#include "scene/limits.hpp"

namespace ergotic::physics {
namespace {

using Mode = scene::Tuning::Mode;

/// Number of the higher partial to tune: high enough to show the dispersion of the springs, low
/// enough to be heard.
constexpr int kSecondPartial = 8;
constexpr double kHighestCycles = 0.4;  // of a partial in a step, to be tuned to

/// The value with five digits, as musicians write it: 1046.5 rather than 1.05e+03.
std::string digits(double value) {
  std::ostringstream text;
  text.precision(5);
  text << value;
  return text.str();
}

double decayRate(double t60_s) {
  return std::log(1000.0) / t60_s;
}

class BodyTuning {
 public:
  BodyTuning(scene::Scene& scene, scene::Tuning& body, const Rates& rates)
      : scene_(scene), body_(body) {
    const scene::Section& section = scene.sectionOf(scene.mats[at(body.first_mat)]);
    const int divisor = divisorOf(section, rates);
    rate_hz_ = rates.audio_hz / divisor;
    step_ = StepUnits(scene, rates, divisor).step;
  }

  void run(std::vector<std::string>& notes) {
    if (!(body_.pitch_hz < 0.5 * rate_hz_)) {
      fail("cannot sound at " + hertz(body_.pitch_hz) + ", allowed below half its rate, " +
           hertz(0.5 * rate_hz_));
    }
    if (!body_.ratios.empty()) {
      shape();
    }
    findLoss();
    scene::BodyScale scale;
    findStiffness(scale);
    scale.dampers = links_;
    scale.loss = -std::log1p(-ground_) / step_;
    scene::scaleBody(scene_, body_, scale);
    links_ = 1.0;  // its modes have it now
    notes.push_back(note() + partials() + madeOf());
    findLimit();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw scene::errorAt(scene_, body_.place, "body '" + body_.name + "' " + what);
  }
  std::string note() const { return noteAt(scene_, body_.place) + "body '" + body_.name + "' "; }
  static std::string hertz(double value) { return scene::numberText(value) + " Hz"; }
  const Mode& mode(int index) const { return body_.modes[at(index)]; }

  /// zeta of a mode.
  double lossOf(const Mode& mode) const { return ground_ + step_ * links_ * mode.dampers; }

  /// Shapes a bar: its thickness gives the ratios of its partials at this rate.
  void shape() {
    if (!(body_.pitch_hz * body_.ratios.back() < kHighestCycles * rate_hz_)) {
      fail("cannot have a partial at " + hertz(body_.pitch_hz * body_.ratios.back()) +
           ", allowed below " + hertz(kHighestCycles * rate_hz_));
    }
    if (!scene::shapeBar(scene_, body_, body_.pitch_hz, 1.0 / rate_hz_)) {
      fail("has no shape that tunes its partials at " + hertz(rate_hz_) + ". Use a higher rate");
    }
    scene::findModes(scene_, body_);
  }

  /// Splits the loss into one to the ground and one in the links.
  void findLoss() {
    if (body_.decays.empty()) {
      return;
    }
    const auto zeta = [this](const scene::Tuning::Decay& decay) {
      return -std::expm1(-2.0 * decayRate(decay.t60_s) / rate_hz_);
    };
    const scene::Tuning::Decay& low = body_.decays.front();
    ground_ = zeta(low);
    if (body_.decays.size() == 1) {
      return;
    }
    const scene::Tuning::Decay& high = body_.decays.back();
    const double least = mode(low.mode).dampers;
    const double most = mode(high.mode).dampers;
    links_ = (zeta(high) - zeta(low)) / (step_ * (most - least));
    ground_ -= step_ * links_ * least;
    if (!(most > least && links_ >= 0.0 && ground_ >= 0.0)) {
      fail("cannot decay in " + scene::numberText(low.t60_s) + " s at partial " +
           std::to_string(low.mode + 1) + " and " + scene::numberText(high.t60_s) +
           " s at partial " + std::to_string(high.mode + 1) + ", allowed there: " +
           shortly(low.t60_s * std::min(1.0, least / most)) + "..." + shortly(low.t60_s) + " s");
    }
  }

  /// h^2 lambda of a mode that sounds at a frequency.
  double kappa(const Mode& mode, double hz) const {
    const double loss = lossOf(mode);
    if (!(loss < 1.0)) {
      fail("cannot sound at " + hertz(hz) + ": it loses all of its velocity in a step, " +
           shortly(1.0 / rate_hz_) + " s. Use a longer t60, or a higher rate");
    }
    return scene::modeKappa(2.0 * M_PI * hz / rate_hz_, loss);
  }

  /// f_j/f_1 of a stiff string, hinged at its ends.
  double stretch(int partial) const {
    const double b = body_.inharmonicity;
    return partial * std::sqrt((1.0 + b * partial * partial) / (1.0 + b));
  }

  void findStiffness(scene::BodyScale& scale) const {
    const Mode& first = mode(body_.pitch_mode);
    const double unit = step_ * step_;
    const double wanted = kappa(first, body_.pitch_hz) / unit;
    scale.springs = scale.bends = wanted / (first.springs + first.bends);
    const double one = body_.pitch_hz / stretch(body_.pitch_mode + 1);
    int second = std::min(kSecondPartial, static_cast<int>(body_.modes.size()));
    while (second > 1 && one * stretch(second) > kHighestCycles * rate_hz_) {
      --second;
    }
    if (first.bends == 0.0 || body_.inharmonicity < 0.0 || second <= body_.pitch_mode + 1) {
      return;
    }
    const Mode& other = mode(second - 1);
    const double needed = kappa(other, one * stretch(second)) / unit;
    const double determinant = first.springs * other.bends - other.springs * first.bends;
    scale.springs = (wanted * other.bends - needed * first.bends) / determinant;
    scale.bends = (first.springs * needed - other.springs * wanted) / determinant;
    if (scale.bends < 0.0) {  // the dispersion of the springs is more than what is asked for
      scale.bends = 0.0;
      scale.springs = wanted / first.springs;
    }
    if (scale.springs < 0.0) {
      fail("cannot have an inharmonicity of " + scene::numberText(body_.inharmonicity) +
           ": its springs would push. Take a bar");
    }
  }

  /// Frequency at which a mode sounds, Hz; NaN if it does not.
  double frequency(const Mode& mode) const {
    const double kappa = step_ * step_ * (mode.springs + mode.bends);
    return scene::modeAngle(kappa, lossOf(mode)) / (2.0 * M_PI) * rate_hz_;
  }

  std::string partials() const {
    std::string hz;
    std::string ratios;
    const double one = frequency(mode(body_.pitch_mode));
    for (const Mode& mode : body_.modes) {
      const double sounding = frequency(mode);
      if (!std::isfinite(sounding)) {
        break;
      }
      hz += (hz.empty() ? "" : ", ") + digits(sounding);
      ratios += (ratios.empty() ? "" : " : ") + digits(sounding / one);
    }
    return "has its partials at " + hz + " Hz, " + ratios;
  }

  /// The masses and springs that it came to.
  std::string madeOf() const {
    double mass = 0.0;
    int moving = 0;
    for (int m = body_.first_mat; m < body_.first_mat + body_.mats; ++m) {
      const scene::Mat& mat = scene_.mats[at(m)];
      const bool moves = mat.type != scene::MatType::kGround;
      mass += moves ? mat.mass.factor : 0.0;
      moving += moves ? 1 : 0;
    }
    return "; " + std::to_string(moving) + " masses, " + shortly(mass) + " kg together";
  }

  /// Adds an error text if there are too many masses for the rate, with remedies.
  void findLimit() const {
    const Mode& top = body_.top;
    const double bound =
        step_ * step_ * (top.springs + top.bends) + 2.0 * (step_ * top.dampers + ground_);
    if (bound < 4.0) {
      return;
    }
    const double fewer = std::pow(4.0 / bound, top.bends > top.springs ? 0.25 : 0.5);
    scene_.body_limits.push_back(
        {body_.first_mat, body_.mats, body_.first_lia, body_.lias, body_.place,
         "body '" + body_.name + "' cannot be stepped at " + hertz(rate_hz_) +
             ": its highest mode is at " + shortly(bound) + ", allowed below 4. Use " +
             shortly(0.99 * fewer) + " times as many masses in a row, a rate of " +
             shortly(rate_hz_ * std::sqrt(bound / 4.0)) +
             " Hz or more, a lower pitch, or as: modes"});
  }

  scene::Scene& scene_;
  scene::Tuning& body_;
  double rate_hz_ = 0.0;
  double step_ = 0.0;    // time units
  double ground_ = 0.0;  // zeta of all modes
  double links_ = 0.0;   // by how much the dampers of its links are multiplied
};

}  // namespace

void tuneBodies(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes) {
  const auto is_body = [](const scene::Tuning& tuning) { return !tuning.modes.empty(); };
  for (scene::Tuning& body : scene.tunings) {
    if (is_body(body)) {
      BodyTuning(scene, body, rates).run(notes);
    }
  }
  scene.tunings.erase(std::remove_if(scene.tunings.begin(), scene.tunings.end(), is_body),
                      scene.tunings.end());
}

}  // namespace ergotic::physics
