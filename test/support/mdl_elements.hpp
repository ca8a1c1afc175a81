// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "support/mdl_simulator.hpp"

/// The elements of a `.mdl` model, an object each, as written in the published conventions.
namespace ergotic::test {

/// A material point: position of this sample and of the last, force gathered in this sample.
struct Material {
  Material(double position, double last) : x(position), x_last(last) {}
  virtual ~Material() = default;
  Material(const Material&) = delete;
  Material& operator=(const Material&) = delete;
  /// Moves to the next sample by the force of the last one, which is then forgotten.
  virtual void move() = 0;

  double x;
  double x_last;
  double force = 0.0;
};

/// mass and osc: x' = a x + b x_last + (force - gravity) / m
struct Inertia : Material {
  Inertia(double mass, double k, double z, double gravity, double position, double velocity)
      : Material(position, position - velocity / kMdlSampleRate),
        m(mass),
        g(gravity / kMdlSampleRate) {
    set(k, z);
  }
  void set(double k, double z) {
    a = 2.0 - (k + z) / m;
    b = z / m - 1.0;
  }
  void move() override {
    const double next = a * x + b * x_last + (force - g) / m;
    x_last = x;
    x = next;
    force = 0.0;
  }
  double m, g;
  double a = 0.0;
  double b = 0.0;
};

struct FixedPoint : Material {
  explicit FixedPoint(double position) : Material(position, position) {}
  void move() override { force = 0.0; }
};

/// posInput: is where it is told to be, at once.
struct DrivenPoint : Material {
  explicit DrivenPoint(double position) : Material(position, position), target(position) {}
  void move() override {
    x_last = x;
    x = target;
    force = 0.0;
  }
  double target;
};

inline double sign(double value) {
  return value > 0.0 ? 1.0 : (value < 0.0 ? -1.0 : 0.0);
}

/// An interaction: -f on the first material, +f on the second.
struct Link {
  Link(Material& first, Material& second) : one(first), two(second) {}
  virtual ~Link() = default;
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;
  /// \param dx  x1 - x2
  /// \param dv  v1 - v2, per sample
  virtual double law(double dx, double dv) const = 0;
  void apply() const {
    const double dx = one.x - two.x;
    const double dv = (one.x - one.x_last) - (two.x - two.x_last);
    const double f = law(dx, dv);
    one.force -= f;
    two.force += f;
  }
  Material& one;
  Material& two;
};

/// spring, damper, springDamper, nlSpring2 (p), nlSpring3 (q)
struct PolynomialLink : Link {
  PolynomialLink(Material& m1, Material& m2, double k_, double p_, double q_, double z_)
      : Link(m1, m2), k(k_), p(p_), q(q_), z(z_) {}
  double law(double dx, double dv) const override {
    return k * dx + p * sign(dx) * dx * dx + q * dx * dx * dx + z * dv;
  }
  double k, p, q, z;
};

struct ContactLink : Link {
  ContactLink(Material& m1, Material& m2, double k_, double z_, double threshold_)
      : Link(m1, m2), k(k_), z(z_), threshold(threshold_) {}
  double law(double dx, double dv) const override {
    return -dx < threshold ? k * (dx + threshold) + z * dv : 0.0;
  }
  double k, z, threshold;
};

/// nlSpringDamper: cubic up to the tipping point, then straight and more damped.
struct ClippedLink : Link {
  ClippedLink(Material& m1, Material& m2, double s_, double c_, double limit_, double z_)
      : Link(m1, m2), s(s_), c(c_), limit(limit_), z(z_) {}
  double law(double dx, double dv) const override {
    if (c == 0.0) {
      return s * dx + z * dv;
    }
    if (s >= limit) {
      return limit * dx + z * dv;
    }
    const double tipping_point = std::sqrt(limit - s) / c;
    if (std::abs(dx) <= tipping_point) {
      return s * dx + c * dx * dx * dx + z * dv;
    }
    return limit * dx + (z + 0.3 * limit) * dv;
  }
  double s, c, limit, z;
};

/// nlContact: the clipped law while the two overlap.
struct ClippedContactLink : ClippedLink {
  ClippedContactLink(
      Material& m1, Material& m2, double s_, double c_, double limit_, double z_, double threshold_)
      : ClippedLink(m1, m2, s_, c_, limit_, z_), threshold(threshold_) {}
  double law(double dx, double dv) const override {
    return -dx < threshold ? ClippedLink::law(dx + threshold, dv) : 0.0;
  }
  double threshold;
};

struct PluckLink : Link {
  PluckLink(Material& m1, Material& m2, double k_, double scale_, double z_)
      : Link(m1, m2), k(k_), scale(scale_), z(z_) {}
  double law(double dx, double dv) const override {
    const double t = scale / 10.0;
    const double e = k / 10.0;
    if (std::abs(dx) < t) {
      return -(k - e) * dx + z * dv;
    }
    return std::abs(dx) < scale ? -sign(dx) * t * k + e * dx + z * dv : 0.0;
  }
  double k, scale, z;
};

struct BowLink : Link {
  BowLink(Material& m1, Material& m2, double z_, double scale_, bool smooth_)
      : Link(m1, m2), z(z_), scale(scale_), smooth(smooth_) {}
  double law(double /*dx*/, double dv) const override {
    if (smooth) {
      const double ratio = dv / scale;
      return 0.63 * z * dv * std::exp(-4.0 * ratio * ratio + 0.5);
    }
    const double t = scale / 3.0;
    const double e = z / 3.0;
    if (std::abs(dv) < t) {
      return (z - e) * dv;
    }
    return std::abs(dv) < scale ? sign(dv) * t * z - e * dv : 0.0;
  }
  double z, scale;
  bool smooth;
};

}  // namespace ergotic::test
