// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <vector>

#include "ergotic/scene/scene.hpp"

namespace ergotic::node {

/// Parameters on their way to other values: each evenly, or evenly in its logarithm where its range
/// has more than two decades above zero, as sliders move.
class Morph {
 public:
  Morph() = default;
  /// \param from      [parameters] present values, within their ranges
  /// \param to        values by indices of parameters, within their ranges
  /// \param begin_ns  of the clock of `step`
  /// \param seconds   0: at once
  Morph(const std::vector<scene::Parameter>& parameters,
        const std::vector<double>& from,
        const std::map<std::size_t, double>& to,
        std::int64_t begin_ns,
        double seconds);

  bool isOver() const { return ways_.empty(); }
  /// Somebody else moves this parameter from now on.
  void leave(std::size_t parameter);

  /// Moves parameters in turn to where they should be now: each once, if `set` takes so many. Those
  /// that have arrived have exactly the value that was asked for, and are left then.
  /// \param set  takes the index of a parameter and its value; false: no more now
  using Set = std::function<bool(std::size_t parameter, double value)>;
  void step(std::int64_t now_ns, const Set& set);

 private:
  struct Way {
    std::size_t parameter = 0;
    double from = 0.0;
    double to = 0.0;
    bool by_logarithm = false;
  };
  static double valueAt(const Way& way, double share);

  std::deque<Way> ways_;  // the first one is due next
  std::int64_t begin_ns_ = 0;
  double seconds_ = 0.0;
};

}  // namespace ergotic::node
