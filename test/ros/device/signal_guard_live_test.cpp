// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/signal_guard.hpp"

#include <unistd.h>

#include <csignal>
#include <thread>

#include <sys/wait.h>

#include "support/test.hpp"

namespace ergotic::node {
namespace {

/// What a process of two stations does, in its order, when it is told to end.
std::string toldToEnd(int signal) {
  std::array<int, 2> pipe{};
  EXPECT_EQ(::pipe(pipe.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const auto say = [&pipe](const char* word) {
      [[maybe_unused]] const auto written = ::write(pipe[1], word, std::strlen(word));
    };
    const auto close = [&say] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      say("closed ");
    };
    const SignalGuard first([&say] { say("safe "); }, close);
    const SignalGuard second([&say] { say("safe "); }, close);
    ::raise(signal);
    std::this_thread::sleep_for(std::chrono::seconds(30));
    ::_exit(1);
  }
  ::close(pipe[1]);
  std::string told;
  char letter = 0;
  while (::read(pipe[0], &letter, 1) == 1) {
    told += letter;
  }
  ::close(pipe[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
  return told;
}

TEST(SignalGuardTest, MakesAllStationsSafeBeforeItClosesOne) {
  EXPECT_EQ(toldToEnd(SIGTERM), "safe safe closed closed ");
  EXPECT_EQ(toldToEnd(SIGHUP), "safe safe closed closed ");
}

}  // namespace
}  // namespace ergotic::node
