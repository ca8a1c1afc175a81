// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ergotic/tgr/virtual_driver.hpp"

namespace ergotic::tgr {

constexpr int kMaxExtraDelayTicks = 16;

/// Settings of the driver `virtual`, see docs/tgr.md; paths are relative to the file.
/// \param node, place  as DriverFactory::make
/// \throws TextError
VirtualDriverConfig readVirtualSettings(const YAML::Node& node, const std::string& place);

}  // namespace ergotic::tgr
