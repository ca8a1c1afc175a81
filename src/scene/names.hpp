// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

namespace ergotic::scene {

/// Names of one kind of thing and their indices. Cost of `add` and `find`: O(1).
class NameTable {
 public:
  void reserve(std::size_t count) { indices_.reserve(count); }
  /// \return index of the name if it was there before, else -1 (and it is added)
  int add(const std::string& name, int index);
  /// \return -1 if there is none
  int find(const std::string& name) const;
  std::vector<std::string> names() const;  ///< sorted

 private:
  std::unordered_map<std::string, int> indices_;
};

/// `'text'`, cut to a length that fits in a message.
std::string quoted(const std::string& text);

/// `; did you mean 'x'?`, else `; known: a, b, c` if they are few, else nothing.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

}  // namespace ergotic::scene
