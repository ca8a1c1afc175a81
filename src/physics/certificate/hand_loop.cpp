// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/certificate/hand_loop.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "constants.hpp"
#include "physics/interpolation.hpp"

namespace ergotic::physics {
namespace {

using Complex = std::complex<double>;
constexpr int kAngles = 64;    // of samples, up to half the rate
constexpr int kFine = 32;      // around the worst of them, to each side
constexpr int kImages = 3;     // to each side of 0
constexpr int kSections = 32;  // of half a circle
constexpr double kGolden = 0.6180339887498949;
constexpr double kSilent = 0.5;  // of the limit

double along(const Complex& direction, const Complex& place) {
  return std::real(std::conj(direction) * place);
}

/// The minimum of a function that falls, then rises, by golden-section search.
template <class Function>
double leastBetween(double low, double high, const Function& function) {
  const auto inner = [&](double from, double to) { return to - kGolden * (to - from); };
  double left = inner(low, high);
  double right = inner(high, low);
  double of_left = function(left);
  double of_right = function(right);
  for (int i = 0; i < kSections; ++i) {
    if (of_left < of_right) {
      high = std::exchange(right, left);
      of_right = of_left;
      of_left = function(left = inner(low, high));
    } else {
      low = std::exchange(left, right);
      of_left = of_right;
      of_right = function(right = inner(high, low));
    }
  }
  return std::min(of_left, of_right);
}

}  // namespace

/// Sum over the images w of the angle of Y(w)/w^2, Y the mobility of slice and hand at w: a convex
/// set, known by how far it reaches in each direction. Y is 1/(r + j x), r at least the damping, x
/// at least what is left of the mass behind the stiffest hand: the part that two circles share.
class HandLoop::Mobilities {
 public:
  Mobilities(const HandLoop& loop, double angle) : radius_(0.5 / loop.damping_) {
    const double tick = loop.tick_s_;
    double rest = tick * tick / (2.0 * (1.0 - std::cos(angle)));  // of 1/w^2, all together
    for (int k = -kImages; k <= kImages; ++k) {
      const double w = (angle + 2.0 * kPi * k) / tick;
      add(loop, w, 1.0 / (w * w));
      rest -= 1.0 / (w * w);
    }
    // Those that are left, half on each side, are where they can be at the nearest of them.
    const double nearest = 2.0 * kPi * (kImages + 0.5) / tick;
    add(loop, nearest, 0.5 * rest);
    add(loop, -nearest, 0.5 * rest);
  }

  double reach(const Complex& direction) const {
    double sum = 0.0;
    for (const Image& image : images_) {
      sum += image.weight * reach(image, image.is_mirrored ? std::conj(direction) : direction);
    }
    return sum;
  }

 private:
  struct Image {
    double weight = 0.0;       // 1/w^2
    bool is_mirrored = false;  // w < 0: the conjugate
    double radius = 0.0;       // of the circle of the mass, around -j radius; 0: there is none
    Complex corner;            // where both circles meet, beside 0
  };

  void add(const HandLoop& loop, double w, double weight) {
    Image image;
    image.weight = weight;
    image.is_mirrored = w < 0.0;
    const double least = std::abs(w) * loop.mass_ - kStiffestHand / std::abs(w);
    if (least > 0.0) {
      image.radius = 0.5 / least;
      image.corner = 1.0 / Complex(loop.damping_, least);
    }
    images_.push_back(image);
  }

  double reach(const Image& image, const Complex& direction) const {
    const Complex of_damping = radius_ * (1.0 + direction);
    if (image.radius == 0.0 || std::abs(of_damping + Complex(0.0, image.radius)) <= image.radius) {
      return along(direction, of_damping);
    }
    const Complex of_mass = image.radius * (direction - Complex(0.0, 1.0));
    if (std::abs(of_mass - radius_) <= radius_) {
      return along(direction, of_mass);
    }
    return std::max(0.0, along(direction, image.corner));
  }

  double radius_;  // of the circle of the damping, around itself
  std::vector<Image> images_;
};

HandLoop::HandLoop(const DeviceTraits& device, double tick_s, int steps)
    : damping_(device.damping),
      delay_(device.delay_ticks),
      mass_(device.mass),
      tick_s_(tick_s),
      steps_(steps) {
  InterpolationResponse answer = interpolationResponse(steps);
  of_spring_ = std::move(answer.spring);
  of_damper_ = std::move(answer.damper);
}

double HandLoop::stiffnessLimit(double interpolated) const {
  return 2.0 * damping_ / ((1.0 + 2.0 * (delay_ + interpolated * kInterpolationDelay)) * tick_s_);
}

double HandLoop::dampingLimit(double interpolated) const {
  return 1.0 / worstShare({0.0, 1.0, 0.0, interpolated});
}

double HandLoop::share(const HandLoad& load) const {
  const double of_spring =
      load.stiffness / stiffnessLimit(partOf(load.interpolated_stiffness, load.stiffness));
  return load.damping > 0.0 ? std::max(of_spring, worstShare(load)) : of_spring;
}

HandLevel HandLoop::judge(const HandLoad& load) const {
  DeviceTraits twice;
  twice.damping = 2.0 * damping_;
  twice.delay_ticks = delay_;
  twice.mass = mass_;
  if (share(load) <= kSilent) {
    return HandLevel::kSilent;
  }
  const bool is_borne = HandLoop(twice, tick_s_, steps_).share(load) <= 1.0;
  return is_borne ? HandLevel::kWarned : HandLevel::kRefused;
}

/// Force per displacement of the slice at this angle of samples, before the delay of the device.
Complex HandLoop::answerAt(double angle, const HandLoad& load) const {
  const Complex change = (1.0 - std::polar(1.0, -angle)) / tick_s_;
  Complex spring;
  Complex damper;
  for (std::size_t i = 0; i < of_spring_.size(); ++i) {
    const Complex late = std::polar(1.0, -angle * static_cast<double>(i));
    spring += of_spring_[i] * late;
    damper += of_damper_[i] * late;
  }
  return load.stiffness - load.interpolated_stiffness + load.interpolated_stiffness * spring +
         (load.damping - load.interpolated_damping) * change +
         load.interpolated_damping / tick_s_ * damper;
}

/// The slice swings by S when the answer pushes it by A, and nothing more happens as long as A S
/// does not reach 1: t/A is the furthest place on its ray that is still an S. Of the lines beyond
/// which there is no S, those that cut the ray off before a place are neighbours.
double HandLoop::shareAt(double angle, const HandLoad& load) const {
  const Complex change = (1.0 - std::polar(1.0, -angle)) / tick_s_;
  const Complex ray = 1.0 / (answerAt(angle, load) * std::polar(1.0, -angle * delay_) * change);
  const Mobilities mobilities(*this, angle);
  const auto cut = [&](double turn) {
    const Complex direction = std::polar(1.0, std::arg(ray) + turn);
    return mobilities.reach(direction) / along(direction, ray);
  };
  return leastBetween(-0.5 * kPi, 0.5 * kPi, cut);
}

double HandLoop::worstShare(const HandLoad& load) const {
  const double step = kPi / kAngles;
  double worst = 0.0;
  double at = step;
  for (int i = 1; i <= kAngles; ++i) {
    const double share = shareAt(i * step, load);
    at = share > worst ? i * step : at;
    worst = std::max(worst, share);
  }
  for (int i = -kFine; i <= kFine; ++i) {
    const double angle = std::min(at + step * i / kFine, kPi);
    worst = std::max(worst, angle > 0.0 ? shareAt(angle, load) : 0.0);
  }
  return worst;
}

}  // namespace ergotic::physics
