// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/own_host.hpp"

#include <netdb.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <netinet/in.h>
#include <ros/connection_manager.h>
#include <ros/master.h>
#include <ros/xmlrpc_manager.h>
#include <sys/socket.h>

namespace ergotic::node {
namespace {

constexpr char kLoopback[] = "lo";
constexpr char kListens[] = "0A";  // state of a line of /proc/net/tcp

/// \return its port if `fd` is a TCP socket that listens, else 0
std::uint16_t listeningPort(int fd) {
  int listens = 0;
  socklen_t size = sizeof listens;
  sockaddr_storage address = {};
  socklen_t length = sizeof address;
  if (getsockopt(fd, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) != 0 || listens == 0 ||
      getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length) != 0) {
    return 0;
  }
  switch (address.ss_family) {
    case AF_INET:
      return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
    case AF_INET6:
      return ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port);
    default:
      return 0;
  }
}

std::vector<int> openFiles() {
  std::vector<int> files;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    files.push_back(std::stoi(entry.path().filename()));
  }
  return files;
}

/// \param address  of a line of /proc/net/tcp or tcp6: words of 32 bits in the order of this host
bool isOfOwnHost(const std::string& address) {
  constexpr char kLoopback6[] = "00000000000000000000000001000000";
  constexpr char kMapped[] = "0000000000000000FFFF0000";  // an IPv4 address in an IPv6 one
  const std::string::size_type mapped = sizeof kMapped - 1;
  const std::string v4 = address.rfind(kMapped, 0) == 0 ? address.substr(mapped) : address;
  return address == kLoopback6 || (v4.size() == 8 && v4.substr(6) == "7F");
}

bool isLoopback(const sockaddr& address) {
  switch (address.sa_family) {
    case AF_INET:
      return ntohl(reinterpret_cast<const sockaddr_in&>(address).sin_addr.s_addr) >> 24U ==
             IN_LOOPBACKNET;
    case AF_INET6:
      return IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr);
    default:
      return false;
  }
}

struct Listening {
  bool anybody = false;
  bool own_host_only = true;
};

void look(const char* table, std::uint16_t port, Listening& listening) {
  std::ifstream lines(table);
  std::string line;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string number;
    std::string local;
    std::string remote;
    std::string state;
    words >> number >> local >> remote >> state;
    const auto colon = local.find(':');
    if (state == kListens && colon != std::string::npos &&
        std::stoi(local.substr(colon + 1), nullptr, 16) == port) {
      listening.anybody = true;
      listening.own_host_only = listening.own_host_only && isOfOwnHost(local.substr(0, colon));
    }
  }
}

}  // namespace

std::optional<std::string> hearOwnHostOnly(const std::vector<std::uint16_t>& ports) {
  for (const int fd : openFiles()) {
    const std::uint16_t port = listeningPort(fd);
    if (port == 0 || std::find(ports.begin(), ports.end(), port) == ports.end()) {
      continue;
    }
    if (setsockopt(fd, SOL_SOCKET, SO_BINDTODEVICE, kLoopback, sizeof kLoopback) != 0) {
      return "port " + std::to_string(port) +
             " of this process cannot be closed to other hosts: " + std::strerror(errno);
    }
  }
  return std::nullopt;
}

bool listensOnOwnHostOnly(std::uint16_t port) {
  Listening listening;
  look("/proc/net/tcp", port, listening);
  look("/proc/net/tcp6", port, listening);
  return listening.anybody && listening.own_host_only;
}

bool isLoopback(const std::string& host) {
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), nullptr, nullptr, &found) != 0) {
    return false;
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> all(found, &freeaddrinfo);
  const addrinfo* address = all.get();
  while (address != nullptr && isLoopback(*address->ai_addr)) {
    address = address->ai_next;
  }
  return address == nullptr;
}

OwnHost::OwnHost(bool allow_remote)
    : allow_remote_(allow_remote), is_master_here_(isLoopback(::ros::master::getHost())) {
  if (!allow_remote) {
    failure_ = hearOwnHostOnly(
        {static_cast<std::uint16_t>(::ros::XMLRPCManager::instance()->getServerPort()),
         static_cast<std::uint16_t>(::ros::ConnectionManager::instance()->getTCPPort())});
  }
}

std::optional<std::string> OwnHost::breach() const {
  if (allow_remote_ || failure_) {
    return allow_remote_ ? std::nullopt : failure_;
  }
  if (is_master_here_ &&
      listensOnOwnHostOnly(static_cast<std::uint16_t>(::ros::master::getPort()))) {
    return std::nullopt;
  }
  return "the ROS master at " + ::ros::master::getURI() +
         " can be reached from other hosts, and anybody there could let force out: start roslaunch "
         "or roscore with ROS_IP=127.0.0.1, or the station with allow_remote:=true";
}

}  // namespace ergotic::node
