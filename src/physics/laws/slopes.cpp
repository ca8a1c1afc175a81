// SPDX-License-Identifier: BSD-3-Clause
#include "physics/laws/slopes.hpp"

#include <algorithm>
#include <cmath>

#include "ergotic/scene/table.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;

constexpr double kPluckSlope = 0.9;  // of K, while it holds

double steepest(const scene::Table& table) {
  if (table.empty()) {
    return 0.0;
  }
  const scene::Curve curve = scene::interpolate(table);
  return std::max(std::abs(curve.smallest_slope), std::abs(curve.largest_slope));
}

bool rises(const scene::Table& table) {
  return table.empty() || scene::interpolate(table).smallest_slope >= 0.0;
}

Slopes upTo(double stiffness, double damping) {
  return {{0.0, stiffness}, {0.0, damping}};
}

double clippedStiffness(const scene::Scene& scene, const scene::Lia& lia) {
  const double tip = lia.law->tipping_point;
  return std::max(
      largest(scene, lia.stiffness) + 3.0 * largest(scene, lia.law->nonlinearity) * tip * tip,
      largest(scene, lia.law->stiffness_limit));
}

}  // namespace

Slopes slopesOf(const scene::Scene& scene, const scene::Lia& lia) {
  const Range k = rangeOf(scene, lia.stiffness);
  const Range z = rangeOf(scene, lia.damping);
  const double steepest_k = largest(scene, lia.stiffness);
  const double steepest_z = largest(scene, lia.damping);
  switch (lia.type) {
    case LiaType::kSpringDamper:
      return {k, z};
    case LiaType::kQuadratic:
    case LiaType::kCubic:
      return {k, z, largest(scene, lia.law->nonlinearity) != 0.0};
    case LiaType::kContact:
    case LiaType::kConditional:
      return {{std::min(k.lowest, 0.0), k.highest}, {std::min(z.lowest, 0.0), z.highest}};
    case LiaType::kPowerContact: {
      const bool is_linear = largest(scene, lia.law->exponent) <= 1.0;
      return {
          {0.0, is_linear ? steepest_k : 0.0}, {std::min(z.lowest, 0.0), z.highest}, !is_linear};
    }
    case LiaType::kClippedCubic:
    case LiaType::kCubicContact:
      return upTo(clippedStiffness(scene, lia),
                  steepest_z + largest(scene, lia.law->limit_damping));
    case LiaType::kPluck:
      return upTo(lia.law->table.empty() ? kPluckSlope * steepest_k : steepest(lia.law->table),
                  steepest_z);
    case LiaType::kBow:
    case LiaType::kSmoothBow:
      return upTo(0.0, frictionSlopesOf(scene, lia).rise);
    case LiaType::kTable:
      return upTo(steepest(lia.law->table), steepest(lia.law->viscous_table));
  }
  return {};
}

double stiffnessAt(const scene::Scene& scene, const scene::Lia& lia, double elongation) {
  const double k = largest(scene, lia.stiffness);
  const double q = largest(scene, lia.law->nonlinearity);
  switch (lia.type) {
    case LiaType::kQuadratic:
      return k + 2.0 * q * elongation;
    case LiaType::kCubic:
      return k + 3.0 * q * elongation * elongation;
    case LiaType::kPowerContact: {
      const double a = largest(scene, lia.law->exponent);
      return a * k * std::pow(elongation, a - 1.0);
    }
    default:
      return slopesOf(scene, lia).stiffness.highest;
  }
}

double elongationOf(const scene::Scene& scene, const scene::Lia& lia, double limit) {
  const double k = largest(scene, lia.stiffness);
  const double q = largest(scene, lia.law->nonlinearity);
  switch (lia.type) {
    case LiaType::kQuadratic:
      return std::max(limit - k, 0.0) / (2.0 * q);
    case LiaType::kCubic:
      return std::sqrt(std::max(limit - k, 0.0) / (3.0 * q));
    default: {
      const double a = largest(scene, lia.law->exponent);
      return std::pow(limit / (a * k), 1.0 / (a - 1.0));
    }
  }
}

FrictionSlopes frictionSlopesOf(const scene::Scene& scene, const scene::Lia& lia) {
  const scene::Table& table = lia.type == LiaType::kTable ? lia.law->viscous_table : lia.law->table;
  if (!table.empty()) {
    const scene::Curve curve = scene::interpolate(table);
    return {std::max(curve.largest_slope, 0.0), std::max(-curve.smallest_slope, 0.0)};
  }
  const double z = largest(scene, lia.damping);
  if (lia.type == LiaType::kBow) {
    return {z * 2.0 / 3.0, z / 3.0};
  }
  // 0.63 Z exp(0.5 - 4 r^2) (1 - 8 r^2): steepest at r = 0, falls most where r^2 = 3/8
  return {0.63 * std::exp(0.5) * z, 0.63 * 2.0 * std::exp(-1.0) * z};
}

bool isRising(const scene::Lia& lia) {
  return rises(lia.law->table) && rises(lia.law->viscous_table);
}

}  // namespace ergotic::physics
