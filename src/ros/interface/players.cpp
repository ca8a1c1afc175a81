// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/players.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include "ergotic/exception.hpp"

namespace ergotic::node {
namespace {

template <class Value>
[[noreturn]] void refuse(const char* field, const Value& value, const std::string& allowed) {
  std::ostringstream text;
  text << field << " is " << value << ", allowed: " << allowed;
  throw Exception(text.str());
}

void check(const HandTargets& wanted) {
  if (wanted.indices.size() > static_cast<std::size_t>(tgr::kMaxSlices)) {
    refuse("the number of indices", wanted.indices.size(),
           "at most " + std::to_string(tgr::kMaxSlices));
  }
  if (!wanted.release && wanted.targets.size() != wanted.indices.size()) {
    refuse("the number of targets", wanted.targets.size(),
           std::to_string(wanted.indices.size()) + ", as there are indices");
  }
  if (wanted.grip > HandTargets::KEY) {
    refuse("grip", static_cast<int>(wanted.grip), "0...4");
  }
  if (!(wanted.glide >= 0.0 && wanted.glide <= tgr::HandMove::kMaxGlideS)) {
    refuse("glide", wanted.glide, "0...60 s");
  }
  if (!(wanted.timeout >= 0.0)) {
    refuse("timeout", wanted.timeout, "0 or more seconds");
  }
  if (!wanted.release && wanted.indices.empty()) {
    refuse("the number of indices", 0, "1 or more");
  }
}

std::vector<tgr::HandMove> allOf(std::uint64_t slices) {
  std::vector<tgr::HandMove> moves;
  for (int slice = 0; slice < tgr::kMaxSlices; ++slice) {
    if ((slices >> static_cast<unsigned>(slice) & 1U) != 0U) {
      moves.emplace_back();
      moves.back().slice = slice;
    }
  }
  return moves;
}

}  // namespace

std::vector<tgr::HandMove> Players::configure(const tgr::EndEffectors& end_effectors) {
  tgr::ToolHands hands(end_effectors);
  const std::lock_guard lock(mutex_);
  hands_ = std::move(hands);
  std::uint64_t held = 0;
  for (Sender& sender : senders_) {
    held |= std::exchange(sender.slices, 0);
  }
  std::vector<tgr::HandMove> released = allOf(held);
  for (tgr::HandMove& move : released) {
    move.lets_go = true;
  }
  return released;
}

bool Players::has(const std::string& end_effector) {
  const std::lock_guard lock(mutex_);
  return hands_.has(end_effector);
}

std::vector<tgr::HandMove> Players::read(const HandTargets& wanted,
                                         const std::string& sender,
                                         double now_s) {
  check(wanted);
  const std::lock_guard lock(mutex_);
  const std::uint8_t source = numberOf(sender);
  std::uint64_t& held = senders_[source].slices;
  std::vector<tgr::HandMove> wanted_moves =
      wanted.release && wanted.indices.empty()
          ? allOf(held)
          : hands_.moves(
                {wanted.end_effector, wanted.indices, wanted.targets, wanted.release != 0U});
  const double stamp_s = wanted.header.stamp.toSec();
  for (tgr::HandMove& move : wanted_moves) {
    move.source = source;
    move.time_s = stamp_s > 0.0 ? stamp_s : now_s;
    move.timeout_s = wanted.timeout;
    move.glide_s = wanted.glide;
    move.grip = static_cast<tgr::HandGrip>(wanted.grip);
    move.lets_go = wanted.release != 0U;
    const std::uint64_t bit = std::uint64_t{1} << static_cast<unsigned>(move.slice);
    for (Sender& other : senders_) {  // of several that move a slice, the last has it
      other.slices &= ~bit;
    }
    held |= move.lets_go ? 0 : bit;
  }
  return wanted_moves;
}

/// Number of a sender. If there are more senders than numbers, the sender that holds nothing and
/// was silent for longest loses its number.
std::uint8_t Players::numberOf(const std::string& sender) {
  auto found = std::find_if(senders_.begin(), senders_.end(),
                            [&](const Sender& known) { return known.name == sender; });
  if (found == senders_.end() && senders_.size() < tgr::kMaxHandSources) {
    found = senders_.insert(senders_.end(), Sender{sender, 0, 0});
  } else if (found == senders_.end()) {
    found =
        std::min_element(senders_.begin(), senders_.end(), [](const Sender& a, const Sender& b) {
          return std::pair(a.slices != 0, a.heard) < std::pair(b.slices != 0, b.heard);
        });
    *found = Sender{sender, 0, 0};
  }
  found->heard = ++messages_;
  return static_cast<std::uint8_t>(found - senders_.begin());
}

}  // namespace ergotic::node
