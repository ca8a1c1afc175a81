// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "rviz/model_shape.hpp"

namespace ergotic::panel {

/// Form of a module by itself, by the laws of its links.
enum class HandForm : std::uint8_t {
  kNone,      ///< no contact
  kKey,       ///< a hand that moves something else
  kHammer,    ///< strikes with felt, or flies
  kFinger,    ///< presses with a plain contact
  kPlectrum,  ///< plucks
  kBow,       ///< rubs
};

struct HandBody {
  HandForm form = HandForm::kNone;
  /// Direction to the touched module, along x of its section if it moves along x alone; length 1.
  Eigen::Vector3f towards = Eigen::Vector3f::UnitX();
  /// Direction along the touched string, bar or surface, at right angles to `towards`; length 1.
  Eigen::Vector3f along = Eigen::Vector3f::UnitY();
};

/// \return [shape.bodies], frame `model`. \pre shape = shapeOf(structure)
std::vector<HandBody> handsOf(const ModelStructure& structure, const ModelShape& shape);

/// Puts modules by themselves that move along x alone beside what they act on: hands, hammers, and
/// the grounds that hold them. Where they are along y and z matters to the picture alone, and many
/// scenes do not say. One that is there already, or that acts on several places, stays.
/// \return the same with other rest positions; as it is if its lists do not fit each other
ModelStructure withHandsInPlace(ModelStructure structure);

}  // namespace ergotic::panel
