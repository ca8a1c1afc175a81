// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {

/// Several devices as one: the slices of the first, then those of the second, and so on. What one
/// of them meets all of them meet: a device that is lost takes the force from every hand.
/// \throws Exception if there is no driver, more than one has a clock of its own, some speak volts,
///         or they have more than kMaxSlices slices together
std::unique_ptr<Driver> combine(std::vector<std::unique_ptr<Driver>> drivers);

}  // namespace ergotic::tgr
