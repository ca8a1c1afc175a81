// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/disturbances.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace ergotic::node {
namespace {

constexpr std::int64_t kMinuteNs = 60'000'000'000;
constexpr std::int64_t kManyUnderruns = 10;  // in a minute
constexpr const char* kAdvice =
    "; close other programs, or start with a larger ring_depth, which scripts/station --tune finds";

struct DisturbanceKind {
  std::uint8_t type;
  const char* words;
};
constexpr DisturbanceKind kDisturbances[] = {{Event::LATE_TICK, "late ticks"},
                                             {Event::STALL, "stalls"},
                                             {Event::UNDERRUN, "underruns of the sound"},
                                             {Event::AUDIO_SKIPPED, "periods left out by JACK"}};

/// Index in kDisturbances; its size if the event is none.
std::size_t kindOfDisturbance(const Event& event) {
  const auto* const found =
      std::find_if(std::begin(kDisturbances), std::end(kDisturbances),
                   [&event](const DisturbanceKind& kind) { return kind.type == event.type; });
  return static_cast<std::size_t>(found - std::begin(kDisturbances));
}

}  // namespace

bool Disturbances::isOne(const Event& event) {
  return kindOfDisturbance(event) < std::size(kDisturbances);
}

bool Disturbances::isFirst(const Event& event) {
  if (event.type == Event::UNDERRUN) {
    const bool goes_on = event.frame == underrun_end_;
    underrun_end_ = event.frame + event.index;
    if (goes_on) {
      underrun_goes_on_ = true;
      return false;
    }
    underrun_began_ = true;
  }
  Count& count = counts_[kindOfDisturbance(event)];
  ++count.all;
  if (count.all > 1) {
    return false;
  }
  count.told = 1;
  return true;
}

std::string Disturbances::ofLastMinute(std::int64_t now_ns) {
  static_assert(std::size(kDisturbances) == kKinds);
  minute_ns_ = minute_ns_ == 0 ? now_ns : minute_ns_;
  if (now_ns - minute_ns_ < kMinuteNs) {
    return "";
  }
  minute_ns_ = now_ns;
  const bool began = std::exchange(underrun_began_, false);
  const bool is_from_before = std::exchange(underrun_goes_on_, false) && !began;
  std::string text;
  std::string advice;
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    Count& count = counts_[kind];
    if (kDisturbances[kind].type == Event::UNDERRUN) {
      count.all += is_from_before ? 1 : 0;
      advice = is_from_before || count.all - count.told > kManyUnderruns ? kAdvice : "";
    }
    if (count.all > count.told) {
      text += (text.empty() ? "in the last minute: " : ", ") +
              std::to_string(count.all - count.told) + " " + kDisturbances[kind].words;
    }
    count.told = count.all;
  }
  return text + advice;
}

}  // namespace ergotic::node
