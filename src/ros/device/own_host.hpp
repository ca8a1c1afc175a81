// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ergotic::node {

/// Access to the listening sockets of this process. Linux only. Realtime: no. Thread: any

/// Restricts the sockets of this process that listen on these TCP ports to connections from this
/// host, whatever address they are bound to.
/// \return reason if some of them could not be restricted, else nothing
std::optional<std::string> hearOwnHostOnly(const std::vector<std::uint16_t>& ports);

/// Whether every socket of this host that listens on a TCP port has an address of this host alone;
/// false also if none listens, as then another host does.
bool listensOnOwnHostOnly(std::uint16_t port);

/// Whether this name or address of a host is the loopback interface, and nothing else.
bool isLoopback(const std::string& host);

/// Closes the station to other hosts. ROS has no authentication: every program that reaches the
/// nodes or the master of a station may do anything that its player may.
class OwnHost {
 public:
  /// Closes this process to other hosts, unless they are allowed.
  /// \pre ros::start was called
  explicit OwnHost(bool allow_remote);

  /// Reason why others may call, or nothing: force is permitted then. The master may have changed.
  std::optional<std::string> breach() const;

 private:
  bool allow_remote_;
  bool is_master_here_;
  std::optional<std::string> failure_;
};

}  // namespace ergotic::node
