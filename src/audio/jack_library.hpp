// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>

/// Access to the state that libjack keeps once per process.
namespace ergotic::audio::jack_library {

/// Keeps libjack's messages off the terminal. Thread: any
void silence();

/// The last message of libjack, empty if there was none since the last call. Thread: any
std::string takeMessage();

/// Runs a call that libjack may never return from, on a thread of its own, and waits at most two
/// seconds for it. \return whether it came back. Thread: any
bool callPatiently(std::function<void()> call);

/// A call above has not come back: libjack holds its lock, no client can be opened. Thread: any
bool isStuck();

/// The library is PipeWire's, which calls the latency callback while other calls are under way and
/// may then be torn down by jack_port_set_latency_range (seen with 0.3.65). Thread: any
bool isOfPipeWire();

/// JACK's clock minus CLOCK_MONOTONIC, ns; 0 within the accuracy of measurement. Thread: any
std::int64_t clockOffsetNs();

}  // namespace ergotic::audio::jack_library
