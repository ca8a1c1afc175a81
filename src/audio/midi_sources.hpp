// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <regex>
#include <string>
#include <vector>

#include <jack/jack.h>

namespace ergotic::audio {

/// Connects MIDI ports of others to one of ours, each once when it appears: a port that was
/// disconnected by hand stays so until it has gone and come back.
/// Realtime: no. Thread: one
class MidiSources {
 public:
  /// \param wish  as JackConfig::midi_connect. \throws Exception if it is no regular expression
  explicit MidiSources(const std::string& wish);

  /// \param names  of one port: its own, and its aliases
  bool wants(const std::vector<std::string>& names, bool is_physical) const;

  /// Connects what has appeared; what cannot be is tried again. Not with the first call that finds
  /// it, for a client that has ports and is about to be activated may not be wired yet: a
  /// synchronous server would wait for it, for 20 s.
  void connect(jack_client_t* client, jack_port_t* input);

 private:
  bool is_none_;
  bool is_physical_;
  std::regex pattern_;
  std::map<std::string, bool> is_connected_;  // of those that are there
};

}  // namespace ergotic::audio
