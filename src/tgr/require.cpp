// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/require.hpp"

#include <sstream>

#include "ergotic/exception.hpp"

namespace ergotic::tgr {

void requireWithin(
    const std::string& what, double value, double minimum, double maximum, const char* unit) {
  if (value >= minimum && value <= maximum) {
    return;
  }
  std::ostringstream text;
  text << what << ": " << value << ' ' << unit << ", allowed " << minimum << "..." << maximum;
  throw Exception(text.str());
}

}  // namespace ergotic::tgr
