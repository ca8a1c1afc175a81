// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/round_plate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "at.hpp"
#include "scene/limits.hpp"

namespace ergotic::scene {
namespace {

constexpr double kScan = 0.05;     // of k, between which there is at most one root
constexpr double kLowest = 0.5;    // of k: below every vibration, above the motions as a whole
constexpr int kRadialParts = 400;  // of Simpson's rule
// Of an outline.
constexpr int kRings = 5;
constexpr int kSpokes = 24;

/// A function of k r and its slope over r, at the rim.
struct AtRim {
  double value;
  double slope;
};

AtRim besselJ(int n, double k) {
  const double j = std::cyl_bessel_j(n, k);
  return {j, n * j - k * std::cyl_bessel_j(n + 1, k)};
}
/// Over its value there.
AtRim besselI(int n, double k) {
  const double i = std::cyl_bessel_i(n, k);
  return {1.0, n + k * std::cyl_bessel_i(n + 1, k) / i};
}

/// What has to vanish at the rim. \param sign  of the Laplacian over k^2: -1 for J, 1 for I
std::array<double, 2> conditions(
    PlateEdges edges, double poisson, int n, double k, double sign, const AtRim& w) {
  const double n2 = static_cast<double>(n) * n;
  const double moment = sign * k * k * w.value - (1.0 - poisson) * (w.slope - n2 * w.value);
  switch (edges) {
    case PlateEdges::kClamped:
      return {w.value, w.slope};
    case PlateEdges::kSupported:
      return {w.value, moment};
    default:  // the shear force, with that of the twisting moment (Kirchhoff)
      return {moment, sign * k * k * w.slope - (1.0 - poisson) * n2 * (w.slope - w.value)};
  }
}

/// The vibrations with n nodal diameters are the roots of a determinant over k.
class Roots {
 public:
  Roots(PlateEdges edges, double poisson, int n) : edges_(edges), poisson_(poisson), n_(n) {}

  /// Those in a range of k, upwards.
  void find(double from, double to, std::vector<RoundMode>& modes) const {
    double before = determinant(from);
    for (double k = from + kScan; k < to + kScan; k += kScan) {
      const double here = determinant(k);
      if ((before < 0.0) != (here < 0.0)) {
        add(bisected(k - kScan, k), modes);
      }
      before = here;
    }
  }

 private:
  double determinant(double k) const {
    const auto j = conditions(edges_, poisson_, n_, k, -1.0, besselJ(n_, k));
    const auto i = conditions(edges_, poisson_, n_, k, 1.0, besselI(n_, k));
    return j[0] * i[1] - j[1] * i[0];
  }

  double bisected(double low, double high) const {
    const bool is_negative = determinant(low) < 0.0;
    for (int pass = 0; pass < 60; ++pass) {
      const double middle = 0.5 * (low + high);
      ((determinant(middle) < 0.0) == is_negative ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  void add(double k, std::vector<RoundMode>& modes) const {
    const auto j = conditions(edges_, poisson_, n_, k, -1.0, besselJ(n_, k));
    const auto i = conditions(edges_, poisson_, n_, k, 1.0, besselI(n_, k));
    const std::size_t larger = std::abs(i[0]) > std::abs(i[1]) ? 0 : 1;
    RoundMode mode{n_, false, k, -j[larger] / i[larger], 1.0};
    double mean = 0.0;  // of the square over the plate, by Simpson's rule over 2 r dr
    for (int part = 0; part <= kRadialParts; ++part) {
      const double r = static_cast<double>(part) / kRadialParts;
      const double weight = part == 0 || part == kRadialParts ? 1.0 : part % 2 == 1 ? 4.0 : 2.0;
      const double w = mode.shapeAt(r, 0.0);
      mean += weight / (3.0 * kRadialParts) * 2.0 * r * w * w;
    }
    mode.scale = 1.0 / std::sqrt(n_ == 0 ? mean : 0.5 * mean);
    modes.push_back(mode);
    if (n_ > 0) {
      mode.is_sine = true;
      modes.push_back(mode);
    }
  }

  PlateEdges edges_;
  double poisson_;
  int n_;
};

class RoundVibrations : public Vibrations {
 public:
  explicit RoundVibrations(const RoundPlateSpec& spec)
      : spec_(spec), modes_(roundModes(spec.edges, spec.poisson, wantedOf(spec))) {}

  int count() const override { return static_cast<int>(modes_.size()); }
  double stiffness(int mode) const override { return std::pow(modes_[at(mode)].k, 4); }
  double mass() const override { return spec_.mass; }
  Eigen::Vector3d begin() const override { return spec_.at; }
  double shape(int mode, double along, double across) const override {
    const Eigen::Vector2d from_middle(2.0 * along - 1.0, 2.0 * across - 1.0);
    return modes_[at(mode)].shapeAt(std::min(1.0, from_middle.norm()),
                                    std::atan2(from_middle.y(), from_middle.x()));
  }
  Eigen::Vector3d rest(double along, double across) const override {
    return spec_.at + spec_.radius * Eigen::Vector3d(0.0, 2.0 * along - 1.0, 2.0 * across - 1.0);
  }

  /// Rings and spokes.
  Drawn drawn(int /*modes*/) const override {
    Drawn drawn;
    drawn.places.emplace_back(0.5, 0.5);
    for (int ring = 0; ring < kRings; ++ring) {
      for (int spoke = 0; spoke < kSpokes; ++spoke) {
        const double phi = 2.0 * M_PI * spoke / kSpokes;
        const double r = 0.5 * (ring + 1) / kRings;
        drawn.places.emplace_back(0.5 + r * std::cos(phi), 0.5 + r * std::sin(phi));
        const int number = 1 + ring * kSpokes + spoke;
        drawn.lines.emplace_back(ring > 0 ? number - kSpokes : 0, number);
        drawn.lines.emplace_back(number, 1 + ring * kSpokes + (spoke + 1) % kSpokes);
      }
    }
    return drawn;
  }

 private:
  static int wantedOf(const RoundPlateSpec& spec) {
    return std::max(partialsOf(spec.wish, spec.form), spec.wish.pitch_of);
  }

  const RoundPlateSpec& spec_;
  std::vector<RoundMode> modes_;
};

}  // namespace

double RoundMode::shapeAt(double r, double phi) const {
  const double i = std::cyl_bessel_i(diameters, k * r) / std::cyl_bessel_i(diameters, k);
  const double around = is_sine ? std::sin(diameters * phi) : std::cos(diameters * phi);
  return scale * (std::cyl_bessel_j(diameters, k * r) + of_i * i) * around;
}

std::vector<RoundMode> roundModes(PlateEdges edges, double poisson, int count) {
  std::vector<RoundMode> modes;
  // Up to k there are about k^2/4 of them, and none with more than k/0.8 diameters.
  for (double most = 8.0; static_cast<int>(modes.size()) < count; most += 4.0) {
    modes.clear();
    for (int n = 0; n <= most / 0.8; ++n) {
      Roots(edges, poisson, n).find(std::max(kLowest, 0.8 * n), most, modes);
    }
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const RoundMode& a, const RoundMode& b) { return a.k < b.k; });
  modes.resize(at(count));
  return modes;
}

void addRoundPlate(SceneBuilder& builder, const RoundPlateSpec& spec) {
  for (const BodyPlace& each : spec.form.places) {
    const double r = 2.0 * std::hypot(each.along - 0.5, each.across - 0.5);
    if (r > 1.0) {
      builder.fail(each.place, "place " + quoted(each.name) + " of round plate " +
                                   quoted(spec.name) + " is " + numberText(r) +
                                   " radii from its middle [0.5, 0.5], allowed: at most 1");
    }
  }
  addVibratingBody(builder, spec.name, spec.section, spec.wish, spec.form, spec.place,
                   RoundVibrations(spec));
}

}  // namespace ergotic::scene
