// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/own_host.hpp"

#include <unistd.h>

#include <array>
#include <string>

#include <netinet/in.h>
#include <sys/socket.h>

#include "support/test.hpp"

namespace ergotic::node {
namespace {

/// A socket that listens on a port of its own.
class Listening {
 public:
  explicit Listening(std::uint32_t address) : fd_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in name = {};
    name.sin_family = AF_INET;
    name.sin_addr.s_addr = htonl(address);
    socklen_t size = sizeof name;
    EXPECT_EQ(bind(fd_, reinterpret_cast<const sockaddr*>(&name), size), 0);
    EXPECT_EQ(listen(fd_, 1), 0);
    EXPECT_EQ(getsockname(fd_, reinterpret_cast<sockaddr*>(&name), &size), 0);
    port_ = ntohs(name.sin_port);
  }
  ~Listening() { close(fd_); }
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

  std::uint16_t port() const { return port_; }
  /// The only network interface that it hears; empty: all.
  std::string interface() const {
    std::array<char, 64> name{};
    socklen_t size = name.size();
    EXPECT_EQ(getsockopt(fd_, SOL_SOCKET, SO_BINDTODEVICE, name.data(), &size), 0);
    return name.data();
  }

 private:
  int fd_;
  std::uint16_t port_ = 0;
};

TEST(OwnHostTest, SeesWhichPortsAreOpenToOthers) {
  EXPECT_TRUE(listensOnOwnHostOnly(Listening(INADDR_LOOPBACK).port()));
  EXPECT_FALSE(listensOnOwnHostOnly(Listening(INADDR_ANY).port()));
}

TEST(OwnHostTest, WhereNobodyListensItIsAnotherHostThatDoes) {
  std::uint16_t free_port = 0;
  {
    const Listening gone(INADDR_LOOPBACK);
    free_port = gone.port();
  }
  EXPECT_FALSE(listensOnOwnHostOnly(free_port));
}

TEST(OwnHostTest, KnowsItselfByNameAndAddress) {
  EXPECT_TRUE(isLoopback("localhost"));
  EXPECT_TRUE(isLoopback("127.0.1.1"));
  EXPECT_TRUE(isLoopback("::1"));
  EXPECT_FALSE(isLoopback("198.18.77.2"));
  EXPECT_FALSE(isLoopback("128.0.0.1"));
  EXPECT_FALSE(isLoopback("::2"));
  EXPECT_FALSE(isLoopback("nobody.invalid"));
}

TEST(OwnHostTest, ClosesThePortsThatItIsToldAndNoOthers) {
  const Listening ours(INADDR_ANY);
  const Listening others(INADDR_ANY);
  EXPECT_EQ(hearOwnHostOnly({ours.port()}), std::nullopt);
  EXPECT_EQ(ours.interface(), "lo");
  EXPECT_EQ(others.interface(), "");
}

}  // namespace
}  // namespace ergotic::node
