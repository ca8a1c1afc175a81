// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/gesture.hpp"

namespace ergotic::tgr {

/// Makes a device whose positions are a recorded gesture, one tick per exchange, whatever the
/// forces. At its end the device holds the last position and flags every exchange with
/// kMissingSample. After closing and opening again it goes on at the same tick. Realtime as
/// `source` is.
std::unique_ptr<Driver> makeReplayDriver(std::unique_ptr<GestureSource> source);

}  // namespace ergotic::tgr
