// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <ostream>
#include <string>

namespace ergotic::tools {

/// Draws a table by a script of ours: that beside the program, or in the source tree around it.
/// \param script   its name, as in `plot_modes`
/// \param write    writes the table, which is removed afterwards
/// \throws Exception if there is no such script, or it fails
void plot(const std::string& script,
          const std::string& picture,
          const std::function<void(std::ostream&)>& write);

/// Writes a file in the way of `write`. \throws Exception if it cannot be written
void writeTable(const std::string& path, const std::function<void(std::ostream&)>& write);

}  // namespace ergotic::tools
