// SPDX-License-Identifier: BSD-3-Clause
#include "audio/jack_latency.hpp"

#include <algorithm>

namespace ergotic::audio {

jack_latency_range_t latencyOf(const std::vector<jack_port_t*>& ports,
                               jack_latency_callback_mode_t mode) noexcept {
  jack_latency_range_t total{0, 0};
  for (std::size_t i = 0; i < ports.size(); ++i) {
    jack_latency_range_t range{};
    jack_port_get_latency_range(ports[i], mode, &range);
    total.min = i == 0 ? range.min : std::min(total.min, range.min);
    total.max = std::max(total.max, range.max);
  }
  return total;
}

jack_latency_range_t latencyOf(const JackTerminal& terminal,
                               jack_latency_callback_mode_t mode,
                               std::uint32_t period_frames) noexcept {
  const std::uint32_t frames =
      mode == JackCaptureLatency
          ? terminal.output_latency_frames
          : terminal.input_latency_frames + terminal.input_latency_periods * period_frames;
  return {frames, frames};
}

void setLatency(const std::vector<jack_port_t*>& ports,
                jack_latency_callback_mode_t mode,
                jack_latency_range_t range) noexcept {
  for (jack_port_t* port : ports) {
    jack_port_set_latency_range(port, mode, &range);
  }
}

}  // namespace ergotic::audio
