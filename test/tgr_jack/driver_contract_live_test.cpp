// SPDX-License-Identifier: BSD-3-Clause
#include "support/driver_contract.hpp"

#include "tgr_jack/jack_rigs.hpp"

namespace ergotic::test {
namespace {

/// One server for all tests; 48 frames per tick, two ticks per block.
const JackServer& contractServer() {
  struct Running : JackServer {
    Running() : JackServer("contract", serverSettings(48000, 96)) { start(); }
  };
  static const Running server;
  return server;
}

class JackRig {
 public:
  static constexpr bool kFeelsForce = true;
  tgr::Driver& driver() { return driver_; }
  void elapse() {}

 private:
  JackDeviceClient device_{contractServer(), jackDevice()};
  TickedDriver driver_{std::make_unique<tgr::JackDriver>(jackDriver(contractServer()))};
};

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(Jack, DriverContractTest, JackRig);

}  // namespace ergotic::test
