// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/gesture.hpp"

namespace ergotic::tgr {

/// A device whose positions are a recorded gesture, one tick per exchange, whatever the forces.
/// At the end it holds the last position and flags every exchange with kMissingSample. Closing and
/// opening again goes on where it was. Realtime as `source` is.
std::unique_ptr<Driver> makeReplayDriver(std::unique_ptr<GestureSource> source);

}  // namespace ergotic::tgr
