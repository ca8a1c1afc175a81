// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "scene/rules/mover_rules.hpp"

namespace ergotic::scene {

constexpr std::size_t kFewestBendEnds = 3;
constexpr std::size_t kMostBendEnds = 5;

/// Empty, or what is wrong: with the modules that it joins, with its weights, or with numbers that
/// mean nothing in the geometry of their section. \pre endsFault: the modules exist
std::string endsFault(const Scene& scene, const Bend& bend);
std::string weightsFault(const Bend& bend);
std::string dampingFault(const Scene& scene, const Bend& bend);
std::string restFault(const Scene& scene, const Bend& bend);

/// The first bend that breaks a rule.
std::optional<Fault> wrongBend(const Scene& scene);

}  // namespace ergotic::scene
