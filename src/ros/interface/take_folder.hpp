// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace ergotic::node {

/// Properties of a take that its folder shows.
struct TakeFile {
  std::string name;
  std::string path;
  bool is_starred = false;
  std::int64_t written_ns = 0;  ///< time since 1970
};

/// The folder of the takes: `NAME.bag`, or `NAME+.bag` of one that is starred, which no name can
/// end in. All names are checked. Thread: one at a time
class TakeFolder {
 public:
  static constexpr std::size_t kMaxTakes = 100;

  explicit TakeFolder(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  /// The newest first, at most kMaxTakes.
  std::vector<TakeFile> list() const;
  /// \throws Exception if there is none of this name
  TakeFile find(const std::string& name) const;
  /// Path of a new take; makes the folder. \throws Exception if there is one of this name
  std::string placeFor(const std::string& name) const;

  // Each gives the new path. \throws Exception as `find`, or why it cannot be done

  /// \throws Exception as `placeFor`, too
  std::string rename(const std::string& name, const std::string& new_name) const;
  std::string star(const std::string& name, bool is_starred) const;
  /// Moves a take to the folder `trash`, under a name that is free there.
  std::string discard(const std::string& name) const;

 private:
  std::string pathOf(const std::string& name, bool is_starred) const;

  std::string path_;
};

}  // namespace ergotic::node
