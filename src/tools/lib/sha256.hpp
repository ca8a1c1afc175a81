// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace ergotic::tools {

/// The digest of bytes as 64 hexadecimal digits. Source: FIPS 180-4.
class Sha256 {
 public:
  void add(const std::string& bytes);
  std::string digest() const;

 private:
  void mix(const std::string& block);

  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::string open_;  // less than a block
  std::uint64_t length_ = 0;
};

}  // namespace ergotic::tools
