// SPDX-License-Identifier: BSD-3-Clause
#include "ros/device/process_faults.hpp"

#include <signal.h>
#include <spawn.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include <sys/wait.h>

#include "ergotic/exception.hpp"

namespace ergotic::node {

void requireStop(double seconds) {
  constexpr double kMinS = 0.001;
  constexpr double kMaxS = 10.0;
  if (!(seconds >= kMinS && seconds <= kMaxS)) {
    throw Exception("amount of stopped is " + std::to_string(seconds) + " s, allowed: 0.001...10");
  }
}

/// A shell does all of it, one after the other: were the stop ours, the wake-up might come first.
void stopThisProcess(double seconds) {
  const std::string process = std::to_string(getpid());
  std::string shell = "sh";
  std::string option = "-c";
  std::string script =
      "kill -STOP " + process + " && sleep " + std::to_string(seconds) + "; kill -CONT " + process;
  const std::array<char*, 4> command{shell.data(), option.data(), script.data(), nullptr};
  pid_t stopper = 0;
  const int error = posix_spawn(&stopper, "/bin/sh", nullptr, nullptr, command.data(), environ);
  if (error != 0) {
    throw DeviceError(std::string("nothing that would stop the process: /bin/sh: ") +
                      std::strerror(error));
  }
  while (::waitpid(stopper, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void killThisProcess() {
  ::kill(getpid(), SIGKILL);
  std::abort();  // not reached
}

}  // namespace ergotic::node
