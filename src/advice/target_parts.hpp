// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ergotic/advice/target.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/generate/cut_string.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

// What one step costs beside that of a module or linear link, measured (docs/speed-accuracy.csv).
constexpr double kNonlinearCost = 20.0;  // explicit
constexpr double kEnergyStableCost = 100.0;
constexpr double kChapletCost = 4.0;
constexpr double kDoubleCost = 2.0;  // half as many fit into a vector

/// One way to play a part.
struct PartOption {
  double error = 0.0;
  double cost = 0.0;  ///< steps per second
  scene::StringCut cut{};
  scene::Scheme scheme = scene::Scheme::kAuto;
  bool filtered = false;
  std::string change;
};

/// A part of a scene that is judged by itself, once the rates are known.
class TargetPart {
 public:
  virtual ~TargetPart() = default;

  virtual std::string name() const = 0;
  virtual std::string figure() const = 0;
  virtual PartOption asItIs(const Rates& rates) const = 0;
  /// The cheapest whose error is allowed, or else the one with the smallest.
  virtual PartOption choose(const Rates& rates, double allowed) const = 0;
  /// Changes the scene that the part was found in, or one whose links have the same indices.
  virtual void apply(scene::Scene& /*scene*/, const PartOption& /*option*/) const {}
  virtual std::string remark(const PartOption& /*option*/) const { return {}; }
};

using Parts = std::vector<std::unique_ptr<TargetPart>>;

/// Contacts, bows, hands and held masses, as far as the unit can be of them.
/// \param chaplets  names of those that the scene has itself, without the numbers of their masses
void addLinkParts(const scene::Scene& scene,
                  const std::vector<std::string>& chaplets,
                  Target::Unit unit,
                  Parts& parts);

/// Sections that move but are no strings: pitches.
void addModeParts(const scene::Scene& scene, Parts& parts);

/// Generated strings that can sound: pitches.
void addStringParts(const scene::Scene& scene, Parts& parts);

}  // namespace ergotic::physics
