// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <fstream>
#include <string>

/// Files, as what others name and write must be met: a pipe would be waited for, a device may never
/// end, and memory is locked.
namespace ergotic::files {

/// Largest size of recordings of positions, which are far longer than texts.
constexpr std::size_t kMaxRecordingBytes = std::size_t{8} << 30U;

/// True if a path leads below a folder, whatever links are on the way; it need not exist.
bool isBelow(const std::string& path, const std::string& folder);

/// \throws Exception if it cannot be read or is no regular file
void requireFile(const std::string& path);

/// A regular file, for reading.
/// \throws Exception if it cannot be read, is no regular file or has more bytes than `most`
std::ifstream openFile(const std::string& path, std::size_t most);

/// Reads a whole regular file. \throws Exception as `openFile`
std::string readFile(const std::string& path, std::size_t most);

}  // namespace ergotic::files
