// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ergotic/scene/name.hpp"

namespace ergotic::scene {

/// Names of one kind of thing and their indices. Cost of `add` and `find`: O(1).
class NameTable {
 public:
  void reserve(std::size_t count);
  /// \return index of the name if it was there before, else -1 (and it is added)
  int add(const Name& name, int index);
  /// \return -1 if there is none
  int find(std::string_view name) const;
  std::vector<std::string> names() const;  ///< sorted

 private:
  /// Open addressing: a name is in the first free slot from that of its hash on.
  struct Slot {
    Name name;
    int index = -1;
    std::uint32_t hash = 0;
    bool is_taken = false;
  };
  std::size_t first(std::uint32_t hash) const { return hash & (slots_.size() - 1); }
  std::size_t next(std::size_t slot) const { return (slot + 1) & (slots_.size() - 1); }
  void resize(std::size_t slots);

  std::vector<Slot> slots_;  // a power of two of them, at most half of which are taken
  std::size_t count_ = 0;
};

/// `'text'`, cut to a length that fits in a message.
std::string quoted(const std::string& text);

/// `; did you mean 'x'?`, else `; known: a, b, c` if they are few, else nothing.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

}  // namespace ergotic::scene
