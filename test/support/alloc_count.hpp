// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace ergotic::test {

/// Counts the heap calls (malloc, calloc, realloc, aligned ones, free) of the calling thread while
/// the object lives, and the bytes that they take. Under sanitizers, which bring their own heap, it
/// counts nothing.
class AllocationScope {
 public:
  using Tell = void (*)(const char* function) noexcept;

  /// \param tell  is called at every heap call of the scope, if it is the outermost one
  explicit AllocationScope(Tell tell = nullptr) noexcept;
  ~AllocationScope();
  AllocationScope(const AllocationScope&) = delete;
  AllocationScope& operator=(const AllocationScope&) = delete;

  /// Heap calls so far.
  std::int64_t calls() const noexcept;
  /// Bytes taken so far and not given back.
  std::int64_t bytes() const noexcept;

  /// False where heap calls cannot be counted: tests then skip themselves.
  static bool isAvailable() noexcept;
};

}  // namespace ergotic::test
