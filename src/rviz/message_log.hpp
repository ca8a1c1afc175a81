// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <string>

namespace ergotic::panel {

/// The last lines that a station told, newest last. What comes again and again is one line, until
/// something else happens.
class MessageLog {
 public:
  static constexpr std::size_t kLines = 100;

  /// \param time  when, for readers
  /// \param kind  of what is summed up with others of its kind; empty: never
  void add(const std::string& time, const std::string& text, const std::string& kind = "");

  /// All lines, ended by "\n" but for the last.
  std::string text() const;
  /// Grows with each change.
  std::size_t version() const { return version_; }

 private:
  struct Line {
    std::string time;
    std::string text;
    std::string kind;
    int times = 1;
  };
  std::deque<Line> lines_;
  std::size_t version_ = 0;
};

}  // namespace ergotic::panel
