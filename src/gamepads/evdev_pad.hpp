// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <libevdev/libevdev.h>

#include "gamepads/pad_device.hpp"

namespace ergotic::gamepads {

/// Traits of a device, by libevdev.
PadTraits traitsOf(const libevdev* device);

}  // namespace ergotic::gamepads
