// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/functions.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

namespace ergotic::scene {
namespace {

/// A random number made of integers alone, so that it is the same on all machines (splitmix64:
/// Steele, Lea, Flood 2014).
double randomOf(double seed, double index) {
  auto z = static_cast<std::uint64_t>(static_cast<std::int64_t>(seed)) * 0x9E3779B97F4A7C15U +
           static_cast<std::uint64_t>(static_cast<std::int64_t>(index)) * 0xD1B54A32D192ED03U;
  for (const std::uint64_t factor : {0xBF58476D1CE4E5B9U, 0x94D049BB133111EBU}) {
    z = (z ^ (z >> 30U)) * factor;
  }
  return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
}

constexpr Function kFunctions[] = {
    {"sin", 1, Function::Kinds::kBare, [](const double* a) { return std::sin(a[0]); }},
    {"cos", 1, Function::Kinds::kBare, [](const double* a) { return std::cos(a[0]); }},
    {"tan", 1, Function::Kinds::kBare, [](const double* a) { return std::tan(a[0]); }},
    {"exp", 1, Function::Kinds::kBare, [](const double* a) { return std::exp(a[0]); }},
    {"log", 1, Function::Kinds::kBare, [](const double* a) { return std::log(a[0]); }},
    {"sqrt", 1, Function::Kinds::kRoot, [](const double* a) { return std::sqrt(a[0]); }},
    {"abs", 1, Function::Kinds::kSame, [](const double* a) { return std::abs(a[0]); }},
    {"floor", 1, Function::Kinds::kSame, [](const double* a) { return std::floor(a[0]); }},
    {"round", 1, Function::Kinds::kSame, [](const double* a) { return std::round(a[0]); }},
    {"cents", 1, Function::Kinds::kBare, [](const double* a) { return std::exp2(a[0] / 1200.0); }},
    {"min", 2, Function::Kinds::kSame, [](const double* a) { return std::min(a[0], a[1]); }},
    {"max", 2, Function::Kinds::kSame, [](const double* a) { return std::max(a[0], a[1]); }},
    {"pow", 2, Function::Kinds::kPower, [](const double* a) { return std::pow(a[0], a[1]); }},
    {"mod", 2, Function::Kinds::kSame,
     [](const double* a) { return a[0] - a[1] * std::floor(a[0] / a[1]); }},
    {"rand", 2, Function::Kinds::kBare, [](const double* a) { return randomOf(a[0], a[1]); }},
};

}  // namespace

const Function* findFunction(const std::string& name) {
  const auto* const found = std::find_if(std::begin(kFunctions), std::end(kFunctions),
                                         [&](const Function& each) { return name == each.name; });
  return found == std::end(kFunctions) ? nullptr : found;
}

std::vector<std::string> functionNames() {
  std::vector<std::string> names;
  for (const Function& each : kFunctions) {
    names.emplace_back(each.name);
  }
  return names;
}

}  // namespace ergotic::scene
