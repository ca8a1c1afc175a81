// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/bench_work.hpp"

#include <algorithm>
#include <cstdint>
#include <set>

#include "at.hpp"

namespace ergotic::tools {
namespace {

using scene::LiaType;
using scene::MatType;
using scene::Scene;

constexpr std::size_t kFewNumbers = 64;
constexpr std::size_t kFewReaches = 16;

/// True if the numbers are more than a program could keep at hand.
template <class Items, class Of>
bool areMany(const Items& items, std::size_t few, const Of& of) {
  std::set<double> seen;
  for (const auto& item : items) {
    seen.insert(of(item));
    if (seen.size() > few) {
      return true;
    }
  }
  return false;
}

bool joinsMasses(const Scene& scene, const scene::Lia& lia) {
  return scene.mats[at(lia.a)].type == MatType::kMass &&
         scene.mats[at(lia.b)].type == MatType::kMass;
}

/// Numbers that belong to one mass or one link alone.
struct Own {
  int of_mass = 0;
  int of_link = 0;
  bool index = false;
};

Own ownNumbers(const Scene& scene) {
  Own own;
  const auto isMany = [](const auto& items, const auto& of) {
    return areMany(items, kFewNumbers, of) ? 1 : 0;
  };
  own.of_mass = isMany(scene.mats, [](const scene::Mat& mat) { return mat.mass.factor; });
  own.of_link = isMany(scene.lias, [](const scene::Lia& lia) { return lia.stiffness.factor; }) +
                isMany(scene.lias, [](const scene::Lia& lia) { return lia.damping.factor; });
  own.index = areMany(scene.lias, kFewReaches, [&scene](const scene::Lia& lia) {
    return joinsMasses(scene, lia) ? static_cast<double>(lia.b - lia.a) : 0.0;
  });
  return own;
}

/// Of one link in one step. \param dimensions  0: scalar
double operationsOf(const scene::Lia& lia, int dimensions) {
  const double comparison = lia.type == LiaType::kSpringDamper ? 0.0 : 2.0;  // and the threshold
  if (dimensions == 0) {
    return 7.0 + comparison;  // two differences, two products, their sum, onto two masses
  }
  // Differences, squares and their sum, root, elongation, power along the line, force, components.
  return 9.0 * dimensions + 8.0 + comparison;
}

}  // namespace

double BenchWork::limitNs(const MachineLimits& limits) const {
  return std::max(bytes / limits.levelFor(resident).gb_per_s, operations / limits.gflops);
}

BenchWork workOf(const Scene& scene, const physics::Rates& rates, physics::Precision precision) {
  const double real = precision == physics::Precision::kFloat ? sizeof(float) : sizeof(double);
  const Own own = ownNumbers(scene);
  BenchWork work;
  double resident = 0.0;
  for (const scene::Mat& mat : scene.mats) {
    if (mat.type != MatType::kMass) {
      continue;
    }
    const scene::Section& section = scene.sectionOf(mat);
    const int dimensions = scene::dimensionsOf(section.geometry);
    const double share = 1.0 / physics::divisorOf(section, rates);
    work.bytes += share * real * (4 * dimensions + own.of_mass);
    work.operations += share * 3 * dimensions;
    resident += real * (2 * dimensions + own.of_mass);
  }
  for (const scene::Lia& lia : scene.lias) {
    const scene::Section& a = scene.sectionOf(scene.mats[at(lia.a)]);
    const scene::Section& b = scene.sectionOf(scene.mats[at(lia.b)]);
    const double share = 1.0 / std::min(physics::divisorOf(a, rates), physics::divisorOf(b, rates));
    const bool scalar = a.geometry == scene::Geometry::kScalar;
    const bool reaches = own.index && joinsMasses(scene, lia);
    const double bytes = real * own.of_link + (reaches ? sizeof(std::int32_t) : 0.0);
    work.bytes += share * bytes;
    work.operations += share * operationsOf(lia, scalar ? 0 : scene::dimensionsOf(a.geometry));
    resident += bytes;
  }
  work.resident = static_cast<std::size_t>(resident);
  return work;
}

}  // namespace ergotic::tools
