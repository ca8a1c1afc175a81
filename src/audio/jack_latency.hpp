// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <jack/jack.h>

#include "ergotic/audio/jack_client.hpp"

/// Functions for JACK's latency callback. Realtime: no.
namespace ergotic::audio {

/// Smallest and largest latency of ports; 0 if there are none.
jack_latency_range_t latencyOf(const std::vector<jack_port_t*>& ports,
                               jack_latency_callback_mode_t mode) noexcept;

/// Latency between the world and the ports of a terminal, in the direction of `mode`.
jack_latency_range_t latencyOf(const JackTerminal& terminal,
                               jack_latency_callback_mode_t mode,
                               std::uint32_t period_frames) noexcept;

void setLatency(const std::vector<jack_port_t*>& ports,
                jack_latency_callback_mode_t mode,
                jack_latency_range_t range) noexcept;

}  // namespace ergotic::audio
