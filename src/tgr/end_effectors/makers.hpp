// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "ergotic/tgr/end_effector.hpp"

/// Makers of the types, for numbers within their ranges.
/// \throws Exception if the linkage cannot be put together
namespace ergotic::tgr {

std::unique_ptr<Kinematics> makeKey(const EndEffectorConfig& config);
std::unique_ptr<Kinematics> makeBow(const EndEffectorConfig& config);
std::unique_ptr<Kinematics> makeStick(const EndEffectorConfig& config);
std::unique_ptr<Kinematics> makeBall(const EndEffectorConfig& config);
std::unique_ptr<Kinematics> makeHandle(const EndEffectorConfig& config);

}  // namespace ergotic::tgr
