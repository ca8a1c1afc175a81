// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ergotic::files {

/// The folder of the instruments and definitions that come with this library, found from where the
/// library lies: `share/ergotic/models` of an install space, or `models` of the sources.
/// \return "" if there is none
std::string shippedModels();

}  // namespace ergotic::files
