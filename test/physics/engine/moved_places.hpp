// SPDX-License-Identifier: BSD-3-Clause
// What places that move along modules may bring, for the tests that move them.
#pragma once

namespace ergotic::physics {

constexpr double kCreditSeconds = 0.1;  // of the power that they may bring
constexpr double kBeyond = 2.0;  // what the forces of one step may bring beyond what was foreseen

}  // namespace ergotic::physics
