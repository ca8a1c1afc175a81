// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include <sys/mman.h>

#include "fuzz/fuzz.hpp"

namespace ergotic::fuzz {

/// A file without a disk, for what reads files only; gone with the object.
class MemoryFile {
 public:
  explicit MemoryFile(const std::uint8_t* data = nullptr, std::size_t size = 0)
      : file_(::memfd_create("fuzz", 0)) {
    if (file_ < 0 || ::write(file_, data, size) != static_cast<ssize_t>(size)) {
      fail("no memory for a file");
    }
  }
  ~MemoryFile() { ::close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

}  // namespace ergotic::fuzz
