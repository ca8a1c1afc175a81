// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <ergotic/Event.h>

namespace ergotic::node {

/// Log of late ticks, stalls and missing sound: the first of each kind is reported, the others are
/// counted, once a minute, so that the log still shows everything else if they are frequent.
/// Thread: one
class Disturbances {
 public:
  static bool isOne(const Event& event);

  /// Counts it; an underrun that goes on from one period to the next counts once, as in Status, and
  /// once more in each minute that it goes on.
  /// \return whether it is the first of its kind. \pre isOne
  bool isFirst(const Event& event);

  /// "in the last minute: 12 late ticks, 3 stalls", with advice if the sound was often interrupted;
  /// empty before a minute is over, and if there was nothing but what was reported. \param now_ns
  /// of CLOCK_MONOTONIC
  std::string ofLastMinute(std::int64_t now_ns);

 private:
  struct Count {
    std::int64_t all = 0;
    std::int64_t told = 0;
  };
  static constexpr std::size_t kKinds = 4;

  std::array<Count, kKinds> counts_;
  std::int64_t minute_ns_ = 0;      // when the present one began; 0: none yet
  std::int64_t underrun_end_ = -1;  // frame after the last that was missing
  bool underrun_goes_on_ = false;   // seen since the last minute was told
  bool underrun_began_ = false;     // likewise
};

}  // namespace ergotic::node
