// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ergotic::tgr {

/// Checks a setting against its range, both ends allowed.
/// \throws Exception naming the setting, its value, its unit and the range; NaN is never within
void requireWithin(
    const std::string& what, double value, double minimum, double maximum, const char* unit);

}  // namespace ergotic::tgr
