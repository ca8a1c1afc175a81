// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "integration/fault_cases.hpp"
#include "integration/safety_world.hpp"

namespace ergotic::test {

/// Makes a fault begin. \return just before it was asked for, CLOCK_MONOTONIC ns
/// \throws std::runtime_error if the station does not obey
std::int64_t begin(SafetyWorld& world, const FaultCase& fault);

}  // namespace ergotic::test
