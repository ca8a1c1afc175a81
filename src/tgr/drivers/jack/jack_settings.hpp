// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace YAML {
class Node;
}

namespace ergotic::tgr {

/// A TGR wired to a DC-coupled sound card.
struct JackDriverConfig {
  std::string client = "ergotic_tgr";       ///< name of our JACK client
  std::string server;                       ///< empty: $JACK_DEFAULT_SERVER, else `default`
  std::vector<std::string> position_ports;  ///< `client:port` or `physical N`, one for each slice
  std::vector<std::string> force_ports;     ///< as above, as many
  std::string heartbeat_port;               ///< as above; empty: none
  double volts_per_unit = 1.0;              ///< volts at full scale, both ways
  std::optional<double> damping;            ///< own damping of a slice, N s/m, if it is known
  int round_trip_frames = 0;                ///< measured value; 0: as JACK declares it
  double wait_s = 5.0;  ///< timeout for server and ports, then for the round trip
};

/// Reads the settings of the driver, see docs/tgr.md. \param file  for messages
/// \throws TextError with file:line:col, value and allowed range
JackDriverConfig readJackSettings(const YAML::Node& node, const std::string& file);

}  // namespace ergotic::tgr
