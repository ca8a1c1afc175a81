// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/sha256.hpp"

#include <cstddef>

namespace ergotic::tools {
namespace {

constexpr std::size_t kBlock = 64;

constexpr std::uint32_t kRounds[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

std::uint32_t turned(std::uint32_t word, int bits) {
  return (word >> bits) | (word << (32 - bits));
}

/// Most significant byte first.
std::string bytesOf(std::uint64_t number, int count) {
  std::string bytes;
  for (int i = count - 1; i >= 0; --i) {
    bytes += static_cast<char>((number >> (8 * i)) & 0xff);
  }
  return bytes;
}

std::uint32_t wordOf(const std::string& block, std::size_t index) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    word = (word << 8) | static_cast<unsigned char>(block[4 * index + i]);
  }
  return word;
}

}  // namespace

void Sha256::mix(const std::string& block) {
  std::uint32_t w[64];
  for (std::size_t i = 0; i < 64; ++i) {
    w[i] = i < 16 ? wordOf(block, i)
                  : w[i - 16] + w[i - 7] +
                        (turned(w[i - 15], 7) ^ turned(w[i - 15], 18) ^ (w[i - 15] >> 3)) +
                        (turned(w[i - 2], 17) ^ turned(w[i - 2], 19) ^ (w[i - 2] >> 10));
  }
  auto [a, b, c, d, e, f, g, h] = state_;
  for (std::size_t i = 0; i < 64; ++i) {
    const std::uint32_t one = h + (turned(e, 6) ^ turned(e, 11) ^ turned(e, 25)) +
                              ((e & f) ^ (~e & g)) + kRounds[i] + w[i];
    const std::uint32_t two =
        (turned(a, 2) ^ turned(a, 13) ^ turned(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + one;
    d = c;
    c = b;
    b = a;
    a = one + two;
  }
  const std::uint32_t more[8] = {a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < 8; ++i) {
    state_[i] += more[i];
  }
}

void Sha256::add(const std::string& bytes) {
  length_ += bytes.size();
  open_ += bytes;
  std::size_t begin = 0;
  for (; open_.size() - begin >= kBlock; begin += kBlock) {
    mix(open_.substr(begin, kBlock));
  }
  open_.erase(0, begin);
}

std::string Sha256::digest() const {
  Sha256 whole = *this;
  const std::size_t zeros = (2 * kBlock - 9 - open_.size()) % kBlock;
  whole.add('\x80' + std::string(zeros, '\0') + bytesOf(8 * length_, 8));
  std::string digits;
  for (const std::uint32_t word : whole.state_) {
    for (int i = 7; i >= 0; --i) {
      digits += "0123456789abcdef"[(word >> (4 * i)) & 0xf];
    }
  }
  return digits;
}

}  // namespace ergotic::tools
