// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <future>
#include <memory>
#include <string>
#include <utility>

namespace ergotic::node {

/// Outcome of what a caller asked for, in words.
struct Answer {
  bool ok = false;
  std::string message;
};
using Promise = std::shared_ptr<std::promise<Answer>>;
/// \param promise  null: no caller waits
inline void answer(const Promise& promise, bool ok, std::string message) {
  if (promise) {
    promise->set_value({ok, std::move(message)});
  }
}

}  // namespace ergotic::node
