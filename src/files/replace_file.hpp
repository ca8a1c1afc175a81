// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ergotic::files {

/// Writes a file below a folder, which it makes if need be: all of it or nothing, and on the disk
/// when it returns. An old one goes only when the new one is complete.
/// \param name  path from the folder, or one that leads below it
/// \return its path
/// \throws Exception if it is elsewhere, is no regular file or cannot be written
std::string replaceFile(const std::string& folder,
                        const std::string& name,
                        const std::string& text);

}  // namespace ergotic::files
