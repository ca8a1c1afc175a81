// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::test {

/// Names a file of eight bytes: nanoseconds, int64, by which the preloaded library shifts the wall
/// clock. It can be written at any time.
inline constexpr char kClockShiftFile[] = "CLOCK_SHIFT_FILE";

}  // namespace ergotic::test
