// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "ergotic/physics/state/state_entry.hpp"

namespace ergotic::physics {

/// Doubles and floats in an element of the state: structures begin with `kDoubles` doubles, floats
/// follow.
template <class T>
constexpr StateNumbers numbersOf() {
  if constexpr (std::is_floating_point_v<T>) {
    return std::is_same_v<T, double> ? StateNumbers{1, 0} : StateNumbers{0, 1};
  } else if constexpr (std::is_integral_v<T>) {
    return {};
  } else {
    return {T::kDoubles, (sizeof(T) - T::kDoubles * sizeof(double)) / sizeof(float)};
  }
}

/// One block of memory for all mutable state, with a table of its entries. Entries are cache-line
/// aligned; the gaps are zero, so that equal states are equal bytes.
class Arena {
 public:
  /// Adds an entry of `count` values of T. \return its offset. \pre before allocate()
  template <class T>
  std::size_t add(const std::string& name, std::size_t count) {
    const std::size_t offset = size_;
    entries_.push_back({name, offset, count * sizeof(T), numbersOf<T>()});
    size_ += (count * sizeof(T) + kLine - 1) / kLine * kLine;
    return offset;
  }

  void allocate() { lines_.assign(size_ / kLine, Line{}); }

  template <class T>
  T* at(std::size_t offset) noexcept {
    return reinterpret_cast<T*>(reinterpret_cast<std::byte*>(lines_.data()) + offset);
  }

  template <class T>
  const T* at(std::size_t offset) const noexcept {
    return reinterpret_cast<const T*>(reinterpret_cast<const std::byte*>(lines_.data()) + offset);
  }

  std::size_t size() const noexcept { return size_; }
  const std::vector<StateEntry>& entries() const noexcept { return entries_; }
  void save(void* to) const noexcept { std::memcpy(to, lines_.data(), size_); }
  void load(const void* from) noexcept { std::memcpy(lines_.data(), from, size_); }

 private:
  static constexpr std::size_t kLine = 64;
  struct alignas(kLine) Line {
    std::byte bytes[kLine]{};
  };
  std::vector<Line> lines_;
  std::vector<StateEntry> entries_;
  std::size_t size_ = 0;
};

}  // namespace ergotic::physics
