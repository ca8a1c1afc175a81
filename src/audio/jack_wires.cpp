// SPDX-License-Identifier: BSD-3-Clause
#include "audio/jack_wires.hpp"

#include <cstdlib>
#include <memory>
#include <mutex>
#include <set>

#include "audio/jack_library.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::audio {

namespace {

struct FreePorts {
  void operator()(const char** ports) const { jack_free(static_cast<void*>(ports)); }
};

std::vector<std::string> namesIn(const char** names) {
  const std::unique_ptr<const char*, FreePorts> owned(names);
  std::vector<std::string> all;
  for (const char** name = names; name != nullptr && *name != nullptr; ++name) {
    all.emplace_back(*name);
  }
  return all;
}

std::mutex reserved_mutex;
std::multiset<std::string> reserved;

/// A wire has nothing else at its ends.
void requireAlone(const std::vector<std::string>& connected,
                  const std::string& port,
                  const std::string& with) {
  for (const std::string& other : connected) {
    if (other != with) {
      throw DeviceError("JACK: `" + port + "` is wired to `" + with +
                        "` alone, but connected with `" + other + "` too; disconnect them");
    }
  }
}

}  // namespace

std::vector<std::string> jackPorts(jack_client_t* client,
                                   const char* regex,
                                   unsigned long flags,
                                   const char* type) {
  return namesIn(jack_get_ports(client, regex, type, flags));
}

ReservedSinks::ReservedSinks(const std::vector<std::string>& peers) : peers_(peers) {
  const std::lock_guard<std::mutex> lock(reserved_mutex);
  reserved.insert(peers_.begin(), peers_.end());
}

ReservedSinks::~ReservedSinks() {
  const std::lock_guard<std::mutex> lock(reserved_mutex);
  for (const std::string& peer : peers_) {
    reserved.erase(reserved.find(peer));
  }
}

bool ReservedSinks::has(const std::string& sink, std::size_t physical) {
  const std::lock_guard<std::mutex> lock(reserved_mutex);
  return reserved.count(sink) > 0 || reserved.count("physical " + std::to_string(physical)) > 0;
}

JackWires::JackWires(jack_client_t* client,
                     const std::vector<jack_port_t*>& ports,
                     const std::vector<std::string>& peers,
                     bool into_us)
    : client_(client), into_us_(into_us) {
  for (std::size_t i = 0; i < peers.size(); ++i) {
    wires_.push_back({ports[i], peers[i]});
  }
}

bool JackWires::mend() const {
  bool mended = false;
  for (const Wire& wire : wires_) {
    mended = mend(wire) || mended;
  }
  return mended;
}

/// Full name of a peer. \throws DeviceError if there is no such port
std::string JackWires::nameOf(const std::string& peer) const {
  const unsigned long direction = into_us_ ? JackPortIsOutput : JackPortIsInput;
  const std::string kind = into_us_ ? " that gives samples" : " that takes samples";
  const std::string physical = "physical ";
  if (peer.compare(0, physical.size(), physical) != 0) {
    const jack_port_t* port = jack_port_by_name(client_, peer.c_str());
    if (port == nullptr || (static_cast<unsigned long>(jack_port_flags(port)) & direction) == 0) {
      throw DeviceError("JACK: no port `" + peer + "`" + kind);
    }
    return peer;
  }
  const auto there = jackPorts(client_, nullptr, direction | JackPortIsPhysical);
  const auto index = static_cast<std::size_t>(std::atoi(peer.c_str() + physical.size()));
  if (index < 1 || index > there.size()) {
    throw DeviceError("JACK: no " + peer + " port" + kind + ", the sound card has " +
                      std::to_string(there.size()));
  }
  return there[index - 1];
}

bool JackWires::mend(const Wire& wire) const {
  const std::string peer = nameOf(wire.peer);
  const std::string own = jack_port_name(wire.port);
  const auto ours = namesIn(jack_port_get_connections(wire.port));
  requireAlone(ours, own, peer);
  if (!into_us_) {  // what gives us samples may give them to others as well
    const jack_port_t* sink = jack_port_by_name(client_, peer.c_str());
    requireAlone(namesIn(jack_port_get_all_connections(client_, sink)), peer, own);
  }
  if (!ours.empty()) {
    return false;
  }
  const std::string& from = into_us_ ? peer : own;
  const std::string& to = into_us_ ? own : peer;
  jack_library::takeMessage();
  if (jack_connect(client_, from.c_str(), to.c_str()) != 0) {
    throw DeviceError("JACK: `" + from + "` cannot be connected to `" + to +
                      "`: " + jack_library::takeMessage());
  }
  return true;
}

}  // namespace ergotic::audio
