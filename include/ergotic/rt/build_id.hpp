// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ergotic::rt {

/// The linker's hash (GNU build id) of the library that this function is in, hexadecimal: the same
/// hash means the same code, and so the same bits from the same input. Empty if it was linked
/// without one. Realtime: no. Thread: any
std::string buildId();

}  // namespace ergotic::rt
