// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include <ergotic/HandTargets.h>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/end_effector.hpp"
#include "ergotic/tgr/players/tool_hands.hpp"

namespace ergotic::node {

/// Understands what players want of the hands of a simulated device: coordinates of end-effectors
/// become slices, senders become numbers. Thread: any
class Players {
 public:
  /// Takes other end-effectors from now on.
  /// \return moves that release everything that is held
  /// \throws TextError if one of them cannot be put together
  std::vector<tgr::HandMove> configure(const tgr::EndEffectors& end_effectors);

  /// Whether there is an end-effector of that name.
  bool has(const std::string& end_effector);

  /// \param sender  node, by what it says itself
  /// \param now_s   of targets without a stamp, s
  /// \return what the hands shall do
  /// \throws Exception naming field, value and allowed range; nothing has changed then
  std::vector<tgr::HandMove> read(const HandTargets& wanted,
                                  const std::string& sender,
                                  double now_s);

 private:
  struct Sender {
    std::string name;
    std::uint64_t slices = 0;  // that it holds, a bit each
    std::uint64_t heard = 0;   // number of its last message
  };
  std::uint8_t numberOf(const std::string& sender);

  std::mutex mutex_;  // of what follows
  tgr::ToolHands hands_;
  std::vector<Sender> senders_;  // at most kMaxHandSources
  std::uint64_t messages_ = 0;
};

}  // namespace ergotic::node
