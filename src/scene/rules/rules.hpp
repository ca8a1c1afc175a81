// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "ergotic/scene/scene.hpp"
#include "scene/limits.hpp"

/// Rules for the parts of a scene, defined once for the YAML reader and for `validate`, each in the
/// source of its name.
namespace ergotic::scene {

/// A fault of a scene, and its position in the text.
struct Fault {
  Place place;
  std::string text;
};

/// Whether it is a body of the model, and not a tap or another point without mass.
inline bool isModule(const Mat& mat) {
  return mat.type == MatType::kMass || mat.type == MatType::kCell || mat.type == MatType::kGround;
}

constexpr Limits kTargetLimits{"m", -1e6, 1e6};  ///< target of agents: differences stay finite

/// The first part that is moved twice. Allowed: one port for a slice, one port for a coordinate of
/// a module, one position input for a driven module.
std::optional<Fault> movedTwice(const Scene& scene);

/// The first point with a wrong place: every point has one connection, or is one tap. Also checks
/// what a tap lies on.
/// \pre the connections are legal
std::optional<Fault> misplacedPoint(const Scene& scene);

/// Why a tap may not lie on a module, to be said after what it is; empty: it may.
std::string reasonAgainstTap(const Scene& scene, int section, int mat);

/// Rest lengths: signed along x; a distance where both ends are in Euclidean sections.
Limits restLengthLimits(const Scene& scene, const Lia& lia);

/// |e| at which a conditional link lets go: not before it acts, whatever its parameters are.
Limits releaseLimits(const Scene& scene, const Lia& lia);

/// Fault of the scheme or filter of a link; empty if there is none.
/// \pre the ends of the link exist
std::string schemeFault(const Scene& scene, const Lia& lia);
std::string filterFault(const Scene& scene, const Lia& lia);
/// Fault of the numbers or the ends of friction; empty if there is none.
std::string frictionFault(const Scene& scene, const Lia& lia);
/// The first link that is to be pressed by a contact that does not exist.
std::optional<Fault> unpressed(const Scene& scene);

/// Fault of the relaxations of a link, in their count or their numbers; empty if there is none.
std::string relaxationFault(const Scene& scene, const Lia& lia);

/// The first of these faults.
std::string liaFault(const Scene& scene, const Lia& lia);

constexpr std::size_t kFewestBendEnds = 3;
constexpr std::size_t kMaxBendEnds = 5;

/// Empty, or what is wrong: with the modules that it joins, with its weights, or with numbers that
/// mean nothing in the geometry of their section. \pre endsFault: the modules exist
std::string endsFault(const Scene& scene, const Bend& bend);
std::string weightsFault(const Bend& bend);
std::string dampingFault(const Scene& scene, const Bend& bend);
std::string restFault(const Scene& scene, const Bend& bend);

/// The first bend that breaks a rule.
std::optional<Fault> wrongBend(const Scene& scene);

/// The first tank, or link of one, that breaks a rule. \pre all ends of links exist
std::optional<Fault> wrongTank(const Scene& scene);

}  // namespace ergotic::scene
