// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>

#include "ergotic/exception.hpp"
#include "scene/names.hpp"
#include "tgr/end_effectors/fields.hpp"
#include "tgr/end_effectors/makers.hpp"

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

std::unique_ptr<Kinematics> make(const EndEffectorConfig& config) {
  checkNumbers(config);
  switch (config.type) {
    case EndEffectorType::kKey:
      return makeKey(config);
    case EndEffectorType::kBow:
      return makeBow(config);
    case EndEffectorType::kStick:
      return makeStick(config);
    case EndEffectorType::kBall:
      return makeBall(config);
    case EndEffectorType::kHandle:
      return makeHandle(config);
  }
  throw std::logic_error("unknown type of end-effector");
}

}  // namespace

std::unique_ptr<Kinematics> makeKinematics(const EndEffectorConfig& config,
                                           const std::string& file) {
  try {
    return make(config);
  } catch (const Exception& e) {
    throw TextError(file, config.place.line, config.place.column,
                    "end-effector " + scene::quoted(config.name) + ": " + e.what());
  }
}

}  // namespace ergotic::tgr
