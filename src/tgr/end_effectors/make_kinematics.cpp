// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/exception.hpp"
#include "scene/names.hpp"
#include "tgr/end_effectors/fields.hpp"

namespace ergotic::tgr {
namespace {

void checkNumbers(const EndEffectorConfig& config) {
  const TypeTraits& traits = traitsOf(config.type);
  const int slices = static_cast<int>(config.slices.size());
  if (slices < traits.fewest_slices || slices > traits.most_slices) {
    throw Exception("a " + std::string(traits.name) + " on " + std::to_string(slices) +
                    " slices, allowed: " + sliceCountText(traits));
  }
  for (const Dimension& dimension : traits.dimensions) {
    const double value = config.*dimension.member;
    if (!dimension.limits.hold(value)) {
      throw Exception(scene::outOfRange(dimension.key, value, dimension.limits));
    }
  }
}

}  // namespace

std::unique_ptr<Kinematics> makeKinematics(const EndEffectorConfig& config,
                                           const std::string& file) {
  try {
    checkNumbers(config);
    return traitsOf(config.type).make(config);
  } catch (const Exception& e) {
    throw TextError(file, config.place.line, config.place.column,
                    "end-effector " + scene::quoted(config.name) + ": " + e.what());
  }
}

}  // namespace ergotic::tgr
