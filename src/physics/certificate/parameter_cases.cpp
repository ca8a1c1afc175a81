// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/parameter_cases.hpp"

#include <cmath>
#include <cstddef>
#include <set>

#include "at.hpp"
#include "ergotic/physics/rates.hpp"

namespace ergotic::physics {
namespace {

constexpr int kMaxValues = 9;  // of one parameter

/// Indices of those that something among these modules and points, or a link on them, follows.
std::vector<int> followedIn(const scene::Scene& scene, const std::set<int>& among) {
  std::set<int> followed;
  const auto add = [&](std::initializer_list<scene::Value> values) {
    for (const scene::Value& value : values) {
      if (value.parameter >= 0) {
        followed.insert(value.parameter);
      }
    }
  };
  for (const int node : among) {
    const scene::Mat& mat = scene.mats[at(node)];
    add({mat.mass, mat.stiffness, mat.damping, scene.sectionOf(mat).medium});
  }
  for (const scene::Lia& lia : scene.lias) {
    if (among.count(lia.a) != 0 || among.count(lia.b) != 0) {
      add({lia.stiffness, lia.damping, lia.law->nonlinearity, lia.law->stiffness_limit,
           lia.law->limit_damping, lia.law->width, lia.law->exponent});
    }
  }
  for (const scene::Connection& connection : scene.connections) {
    if (among.count(connection.mat) != 0) {
      add({connection.along.at, connection.across.at});
    }
  }
  std::vector<int> ranging;
  for (const int p : followed) {
    if (scene.parameters[at(p)].minimum < scene.parameters[at(p)].maximum) {
      ranging.push_back(p);
    }
  }
  return ranging;
}

/// \param part  0...1 of the range
double valueAt(const scene::Parameter& parameter, double part) {
  return parameter.minimum > 0.0
             ? parameter.minimum * std::pow(parameter.maximum / parameter.minimum, part)
             : parameter.minimum + part * (parameter.maximum - parameter.minimum);
}

/// The most values of each of so many parameters, whose combinations are not too many; 1: both ends
/// already are.
int valuesOfEach(std::size_t parameters, int most) {
  int values = 1;
  while (parameters > 0 && values < kMaxValues &&
         std::pow(values + 1, parameters) <= static_cast<double>(most)) {
    ++values;
  }
  return values;
}

}  // namespace

std::vector<scene::Scene> parameterCases(const scene::Scene& scene,
                                         const std::set<int>& among,
                                         int most) {
  std::vector<scene::Scene> cases{scene};
  for (double scene::Parameter::*end : {&scene::Parameter::minimum, &scene::Parameter::maximum}) {
    scene::Scene other = scene;
    for (scene::Parameter& parameter : other.parameters) {
      parameter.value = parameter.*end;
    }
    if (!scene.parameters.empty()) {
      cases.push_back(std::move(other));
    }
  }
  const std::vector<int> followed = followedIn(scene, among);
  const int values = valuesOfEach(followed.size(), most);
  const auto combinations = static_cast<int>(std::pow(values, followed.size()));
  for (const int p : followed) {
    for (int i = 0; values < kMaxValues && most > kMaxValues && i < kMaxValues; ++i) {
      cases.push_back(scene);
      scene::Parameter& parameter = cases.back().parameters[at(p)];
      parameter.value = valueAt(parameter, static_cast<double>(i) / (kMaxValues - 1));
    }
  }
  for (int i = 0; values > 1 && i < combinations; ++i) {
    scene::Scene other = scene;
    int rest = i;
    for (const int p : followed) {
      scene::Parameter& parameter = other.parameters[at(p)];
      parameter.value = valueAt(parameter, static_cast<double>(rest % values) / (values - 1));
      rest /= values;
    }
    cases.push_back(std::move(other));
  }
  return cases;
}

}  // namespace ergotic::physics
