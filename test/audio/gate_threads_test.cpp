// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "audio/gate.hpp"

namespace ergotic::audio {
namespace {

TEST(GateThreadsTest, NobodyIsInsideOnceCloseHasReturned) {
  constexpr int kRounds = 300;
  Gate gate;
  int guarded = 0;  // written inside, and by the closer while closed: a race if the gate leaks
  std::atomic<bool> quit{false};
  std::atomic<int> visits{0};
  std::thread visitor([&] {
    while (!quit) {
      if (gate.enter()) {
        ++guarded;
        ++visits;
        gate.leave();
      }
    }
  });
  int closed_rounds = 0;
  for (int round = 0; round < kRounds; ++round) {
    const int before = visits;
    gate.open();
    while (visits == before) {
      std::this_thread::yield();
    }
    gate.close();
    const int seen = guarded;
    std::this_thread::yield();
    closed_rounds += guarded == seen && seen == visits ? 1 : 0;
    guarded = seen;
  }
  quit = true;
  visitor.join();
  EXPECT_EQ(closed_rounds, kRounds);
  EXPECT_GE(visits, kRounds);
}

}  // namespace
}  // namespace ergotic::audio
