// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <jack/jack.h>

namespace ergotic::audio {

/// Port names of one direction. \param flags  of jack_get_ports
std::vector<std::string> jackPorts(jack_client_t* client,
                                   const char* regex,
                                   unsigned long flags,
                                   const char* type = JACK_DEFAULT_AUDIO_TYPE);

/// Keeps what outputs of this process are wired to, while it lives, from being connected to by
/// `JackConfig::connect`: a force-feedback device is no loudspeaker. Whatever the server, which may
/// go by two names. Thread: any
class ReservedSinks {
 public:
  /// \param peers  as JackConfig::output_peers
  explicit ReservedSinks(const std::vector<std::string>& peers);
  ~ReservedSinks();
  ReservedSinks(const ReservedSinks&) = delete;
  ReservedSinks& operator=(const ReservedSinks&) = delete;

  /// \param physical  its number among the physical ports, from 1 on
  static bool has(const std::string& sink, std::size_t physical);

 private:
  std::vector<std::string> peers_;
};

/// Connections one to one between our ports and those of others.
/// Realtime: no. Thread: one
class JackWires {
 public:
  /// \param peers  one for each of the ports: `client:port` or `physical N`; none: no wires
  /// \param into_us  our ports are inputs
  JackWires(jack_client_t* client,
            const std::vector<jack_port_t*>& ports,
            const std::vector<std::string>& peers,
            bool into_us);

  /// Connects what is not connected; connections of others stay.
  /// \return whether it had to. \throws DeviceError saying which wire is missing or shared
  bool mend() const;

 private:
  struct Wire {
    jack_port_t* port;
    std::string peer;
  };
  std::string nameOf(const std::string& peer) const;
  bool mend(const Wire& wire) const;

  jack_client_t* client_;
  bool into_us_;
  std::vector<Wire> wires_;
};

}  // namespace ergotic::audio
