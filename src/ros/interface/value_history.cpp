// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/value_history.hpp"

#include <utility>

namespace ergotic::node {

void ValueHistory::note(const std::vector<double>& values, std::int64_t now_ns) {
  if (!changed_ns_ || now_ns - *changed_ns_ > kPauseNs) {
    steps_.push_back(values);
  }
  if (steps_.size() > kMaxSteps) {
    steps_.pop_front();
  }
  changed_ns_ = now_ns;
}

std::vector<double> ValueHistory::undo() {
  std::vector<double> values = std::move(steps_.back());
  steps_.pop_back();
  changed_ns_.reset();
  return values;
}

void ValueHistory::clear() {
  steps_.clear();
  changed_ns_.reset();
}

}  // namespace ergotic::node
