// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ergotic::tools {

/// Refuses what libsmf would end the process for, and what it does not read: files that break off,
/// events that are none, times that are no pulses of a quarter.
/// \param bytes  of a standard MIDI file (MMA RP-001), of at most 2 GiB
/// \param file   for messages
/// \throws Exception naming file, place in bytes, value and what is allowed
void checkMidiFile(const std::string& bytes, const std::string& file);

}  // namespace ergotic::tools
