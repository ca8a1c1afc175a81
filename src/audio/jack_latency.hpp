// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <jack/jack.h>

#include "ergotic/audio/jack_client.hpp"

/// What JACK's latency callback asks of a client. Realtime: no.
namespace ergotic::audio {

/// Smallest and largest latency of ports; 0 if there are none.
jack_latency_range_t latencyOf(const std::vector<jack_port_t*>& ports,
                               jack_latency_callback_mode_t mode) noexcept;

/// From the world to the ports of a terminal, or from them into the world.
jack_latency_range_t latencyOf(const JackTerminal& terminal,
                               jack_latency_callback_mode_t mode,
                               std::uint32_t period_frames) noexcept;

void setLatency(const std::vector<jack_port_t*>& ports,
                jack_latency_callback_mode_t mode,
                jack_latency_range_t range) noexcept;

}  // namespace ergotic::audio
