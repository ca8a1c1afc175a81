// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <string>

namespace ergotic::panel {

/// Log of a station's last messages, newest last. A repeated message stays one line, until another
/// one comes.
class MessageLog {
 public:
  static constexpr std::size_t kLines = 100;

  /// \param time  when, for readers
  /// \param kind  of what is summed up with others of its kind; empty: never
  void add(const std::string& time, const std::string& text, const std::string& kind = "");

  /// Text of all lines, separated by "\n".
  std::string text() const;
  /// Number that grows with each change.
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
