// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace ergotic::node {

/// Values of the parameters of a scene before each change, so that changes can be undone. Changes
/// that follow one another within a second are one.
class ValueHistory {
 public:
  static constexpr std::size_t kMaxSteps = 50;
  static constexpr std::int64_t kPauseNs = 1'000'000'000;

  /// Records values before a change. \param values  [parameters] as they are
  void note(const std::vector<double>& values, std::int64_t now_ns);
  bool canUndo() const { return !steps_.empty(); }
  /// \return the values before the last change, which is forgotten. \pre canUndo()
  std::vector<double> undo();
  /// Clears the history, when another scene plays.
  void clear();

 private:
  std::deque<std::vector<double>> steps_;   // the newest at the end
  std::optional<std::int64_t> changed_ns_;  // nothing: the next change is another one
};

}  // namespace ergotic::node
