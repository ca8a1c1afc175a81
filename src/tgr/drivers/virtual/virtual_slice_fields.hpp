// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "ergotic/tgr/virtual_driver.hpp"
#include "scene/limits.hpp"

namespace ergotic::tgr {

/// One number of a virtual slice, its key in YAML and its range.
struct VirtualSliceField {
  const char* key;
  double VirtualSliceConfig::*member;
  scene::Limits limits;
};

inline constexpr std::array<VirtualSliceField, 12> kVirtualSliceFields{
    {{"mass", &VirtualSliceConfig::mass, {"kg", 1e-3, 100.0}},
     {"damping", &VirtualSliceConfig::damping, {"N s/m", 0.0, 1e4}},
     {"dry_friction", &VirtualSliceConfig::dry_friction, {"N", 0.0, 100.0}},
     {"stop", &VirtualSliceConfig::stop, {"m", 1e-4, 0.1}},
     {"quantum", &VirtualSliceConfig::quantum, {"m", 0.0, 1e-3}},
     {"noise_rms", &VirtualSliceConfig::noise_rms, {"m", 0.0, 1e-3}},
     {"force_limit", &VirtualSliceConfig::force_limit, {"N", 0.0, kAbsoluteForceLimitN}},
     {"bandwidth", &VirtualSliceConfig::bandwidth, {"Hz", 10.0, kInfinity}},
     {"delay", &VirtualSliceConfig::delay, {"s", 0.0, 0.005}},
     {"hand_mass", &VirtualSliceConfig::hand_mass, {"kg", 0.0, 100.0}},
     {"hand_stiffness", &VirtualSliceConfig::hand_stiffness, {"N/m", 0.0, 1e6}},
     {"hand_damping", &VirtualSliceConfig::hand_damping, {"N s/m", 0.0, 1e4}}}};

/// \throws Exception naming number, value and allowed range
void checkSlice(const VirtualSliceConfig& config);

}  // namespace ergotic::tgr
