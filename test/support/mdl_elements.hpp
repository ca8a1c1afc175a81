// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
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
      : Material(position, position - velocity / kMdlSampleRate), g(gravity / kMdlSampleRate) {
    set(mass, k, z);
  }
  void set(double mass, double k, double z) {
    m = mass;
    a = 2.0 - (k + z) / m;
    b = z / m - 1.0;
  }
  void move() override {
    const double next = a * x + b * x_last + (force - g) / m;
    x_last = x;
    x = next;
    force = 0.0;
  }
  double g;
  double m = 1.0;
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

/// A point of a macro: where its modules take it, and its force goes to them. Its velocity is that
/// of the modules, wherever it has been before.
struct MacroPoint : Material {
  using Shares = std::vector<std::pair<Material*, double>>;
  explicit MacroPoint(const Shares& of) : Material(0.0, 0.0), shares(of) { move(); }
  void move() override {
    x = 0.0;
    x_last = 0.0;
    for (const auto& [material, share] : shares) {
      x += share * material->x;
      x_last += share * material->x_last;
    }
    force = 0.0;
  }
  void give() const {
    for (const auto& [material, share] : shares) {
      material->force += share * force;
    }
  }
  Shares shares;
};

inline double sign(double value) {
  return value > 0.0 ? 1.0 : (value < 0.0 ? -1.0 : 0.0);
}

/// The numbers behind the ends of a link; what is left out is 0.
using Numbers = std::array<double, 5>;

/// Force of the numbers, of x1 - x2, and of v1 - v2 per sample.
using Law = double (*)(const Numbers& v, double dx, double dv);

/// An interaction: -f on the first material, +f on the second.
struct Link {
  void apply() const {
    const double f = law(numbers, one->x - two->x, (one->x - one->x_last) - (two->x - two->x_last));
    one->force -= f;
    two->force += f;
  }
  Material* one;
  Material* two;
  Law law;
  Numbers numbers;
};

/// nlSpringDamper of mi-gen: cubic up to the tipping point, then straight and more damped.
inline double clippedLaw(const Numbers& v, double dx, double dv) {
  const auto& [s, c, limit, z, threshold] = v;
  if (c == 0.0) {
    return s * dx + z * dv;
  }
  if (s >= limit) {
    return limit * dx + z * dv;
  }
  return std::abs(dx) <= std::sqrt((limit - s) / c) ? s * dx + c * dx * dx * dx + z * dv
                                                    : limit * dx + (z + 0.3 * limit) * dv;
}

/// nlContact of mi-gen: the same without more damping, and never softer than at first.
inline double clippedContactLaw(const Numbers& v, double dx, double dv) {
  const auto& [s, c, limit, z, threshold] = v;
  const double p = dx + threshold;
  if (p <= 0.0) {
    return 0.0;
  }
  const bool is_cubic = c != 0.0 && s < limit;
  if (is_cubic && std::abs(p) > std::sqrt((limit - s) / c)) {
    return limit * p + z * dv;
  }
  return s * p + (is_cubic ? c * p * p * p : 0.0) + z * dv;
}

/// nlSpringDamper of Faust's library; with a gate also its nlContact.
inline double faustClippedLaw(const Numbers& v, double dx, double dv) {
  const auto& [s, c, limit, z, threshold] = v;
  const bool is_cubic = c != 0.0 && s < limit;
  return is_cubic && std::abs(dx) <= std::sqrt(limit - s) / c
             ? s * dx + c * dx * dx * dx + z * dv
             : (c == 0.0 ? s : limit) * dx + (is_cubic ? z + 0.3 * limit : z) * dv;
}

inline double pluckLaw(const Numbers& v, double dx, double dv) {
  const double scale = v[1];
  const double e = v[0] / 10.0;
  if (std::abs(dx) < scale / 10.0) {
    return -(v[0] - e) * dx + v[2] * dv;
  }
  return std::abs(dx) < scale ? -sign(dx) * scale / 10.0 * v[0] + e * dx + v[2] * dv : 0.0;
}

inline double bowLaw(const Numbers& v, double /*dx*/, double dv) {
  const auto& [z, scale, is_smooth, none, nothing] = v;
  const double ratio = dv / scale;
  if (is_smooth > 0.0) {
    return 0.63 * z * dv * std::exp(-4.0 * ratio * ratio + 0.5);
  }
  if (std::abs(ratio) < 1.0 / 3.0) {
    return (z - z / 3.0) * dv;
  }
  return std::abs(ratio) < 1.0 ? sign(dv) * scale / 3.0 * z - z / 3.0 * dv : 0.0;
}

inline const std::map<std::string, Law>& laws() {
  static const std::map<std::string, Law> kLaws = {
      {"spring", [](const Numbers& v, double dx, double) { return v[0] * dx; }},
      {"damper", [](const Numbers& v, double, double dv) { return v[0] * dv; }},
      {"springDamper",
       [](const Numbers& v, double dx, double dv) { return v[0] * dx + v[1] * dv; }},
      {"nlSpring2", [](const Numbers& v, double dx,
                       double dv) { return v[0] * dx + v[1] * sign(dx) * dx * dx + v[2] * dv; }},
      {"nlSpring3", [](const Numbers& v, double dx,
                       double dv) { return v[0] * dx + v[1] * dx * dx * dx + v[2] * dv; }},
      {"contact", [](const Numbers& v, double dx,
                     double dv) { return -dx < v[2] ? v[0] * (dx + v[2]) + v[1] * dv : 0.0; }},
      {"nlSpringDamper", clippedLaw},
      {"nlContact", clippedContactLaw},
      {"nlSpringDamper of Faust", faustClippedLaw},
      {"nlContact of Faust",
       [](const Numbers& v, double dx, double dv) {
         return -dx < v[4] ? faustClippedLaw(v, dx + v[4], dv) : 0.0;
       }},
      {"nlPluck", pluckLaw},
      {"nlBow", bowLaw},
  };
  return kLaws;
}

}  // namespace ergotic::test
