// SPDX-License-Identifier: BSD-3-Clause
#include "audio/midi_sources.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <jack/midiport.h>

#include "audio/jack_wires.hpp"
#include "ergotic/audio/jack_client.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::audio {
namespace {

/// Bridges give ports numbers, and say in an alias what the device is called.
std::vector<std::string> allNamesOf(const std::string& name, const jack_port_t* port) {
  const auto size = static_cast<std::size_t>(jack_port_name_size());
  std::array<std::string, 2> aliases{std::string(size, '\0'), std::string(size, '\0')};
  std::array<char*, 2> texts{aliases[0].data(), aliases[1].data()};
  const int count = jack_port_get_aliases(port, texts.data());
  std::vector<std::string> names{name};
  for (int i = 0; i < std::min(count, 2); ++i) {
    names.emplace_back(texts[static_cast<std::size_t>(i)]);
  }
  return names;
}

}  // namespace

MidiSources::MidiSources(const std::string& wish)
    : is_none_(wish.empty() || wish == kNoMidi), is_physical_(wish == kPhysicalMidi) {
  try {
    pattern_.assign(wish, std::regex::extended | std::regex::icase);
  } catch (const std::regex_error& error) {
    throw Exception("JACK MIDI sources: `" + wish + "` (" + error.what() +
                    "), allowed: " + kPhysicalMidi + ", " + kNoMidi +
                    ", or a part of the names of ports, a regular expression");
  }
}

bool MidiSources::wants(const std::vector<std::string>& names, bool is_physical) const {
  if (is_none_ || is_physical_) {
    return is_physical_ && is_physical;
  }
  return std::any_of(names.begin(), names.end(),
                     [this](const std::string& name) { return std::regex_search(name, pattern_); });
}

void MidiSources::connect(jack_client_t* client, jack_port_t* input) {
  if (is_none_) {
    return;
  }
  std::map<std::string, bool> is_connected;
  for (const std::string& name :
       jackPorts(client, nullptr, JackPortIsOutput, JACK_DEFAULT_MIDI_TYPE)) {
    const jack_port_t* const port = jack_port_by_name(client, name.c_str());
    if (port == nullptr ||
        !wants(allNamesOf(name, port), (jack_port_flags(port) & JackPortIsPhysical) != 0)) {
      continue;
    }
    const auto before = is_connected_.find(name);
    const bool was_there = before != is_connected_.end();
    is_connected[name] =
        was_there && (before->second || jack_port_connected_to(input, name.c_str()) != 0 ||
                      jack_connect(client, name.c_str(), jack_port_name(input)) == 0);
  }
  is_connected_ = std::move(is_connected);
}

}  // namespace ergotic::audio
