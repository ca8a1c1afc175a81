// SPDX-License-Identifier: BSD-3-Clause
#include "ros/process_faults.hpp"

#include <signal.h>
#include <spawn.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <string>

#include <sys/wait.h>

#include "ergotic/exception.hpp"

namespace ergotic::node {

void requireStop(double seconds) {
  constexpr double kLeastS = 0.001;
  constexpr double kMostS = 10.0;
  if (!(seconds >= kLeastS && seconds <= kMostS)) {
    throw Exception("amount of stopped is " + std::to_string(seconds) + " s, allowed: 0.001...10");
  }
}

void stopThisProcess(double seconds) {
  std::string shell = "sh";
  std::string option = "-c";
  std::string script =
      "sleep " + std::to_string(seconds) + "; kill -CONT " + std::to_string(getpid());
  const std::array<char*, 4> command{shell.data(), option.data(), script.data(), nullptr};
  pid_t waker = 0;
  const int error = posix_spawn(&waker, "/bin/sh", nullptr, nullptr, command.data(), environ);
  if (error != 0) {
    throw DeviceError(std::string("nothing that would wake the process: /bin/sh: ") +
                      std::strerror(error));
  }
  ::kill(getpid(), SIGSTOP);
  ::waitpid(waker, nullptr, 0);
}

void killThisProcess() {
  ::kill(getpid(), SIGKILL);
  std::abort();  // not reached
}

}  // namespace ergotic::node
