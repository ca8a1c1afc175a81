// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/tick_source.hpp"

#include "ergotic/station/device_source.hpp"
#include "ergotic/station/timer_source.hpp"

namespace ergotic::station {

std::unique_ptr<TickSource> startTicks(Station& station,
                                       AudioBridge* bridge,
                                       const TimerOptions& options) {
  if (station.driver().clock() != nullptr) {
    auto device = std::make_unique<DeviceSource>(station, bridge);
    device->start(options.lock_memory);
    return device;
  }
  auto timer = std::make_unique<TimerSource>(station, bridge);
  timer->start(options);
  return timer;
}

}  // namespace ergotic::station
