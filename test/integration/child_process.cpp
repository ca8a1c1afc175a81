// SPDX-License-Identifier: BSD-3-Clause
#include "integration/child_process.hpp"

#include <spawn.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

#include <sys/wait.h>

namespace ergotic::test {
namespace {

std::vector<char*> pointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) {
    pointers.push_back(text.data());
  }
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> mergedWithOurs(std::map<std::string, std::string> environment) {
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    const auto end = text.find('=');
    environment.emplace(text.substr(0, end),
                        text.substr(end + 1));  // ours do not replace given ones
  }
  std::vector<std::string> merged;
  for (const auto& [name, value] : environment) {
    merged.push_back(name + "=" + value);
  }
  return merged;
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command,
                           const std::map<std::string, std::string>& environment) {
  std::vector<std::string> arguments = command;
  std::vector<std::string> variables = mergedWithOurs(environment);
  if (posix_spawn(&pid_, command.front().c_str(), nullptr, nullptr, pointersTo(arguments).data(),
                  pointersTo(variables).data()) != 0) {
    throw std::runtime_error("cannot start " + command.front());
  }
}

ChildProcess::~ChildProcess() {
  if (isRunning()) {
    signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
}

void ChildProcess::signal(int number) const {
  kill(pid_, number);
}

bool ChildProcess::isRunning() {
  int status = 0;
  if (!status_ && waitpid(pid_, &status, WNOHANG) == pid_) {
    status_ = status;
  }
  return !status_;
}

std::optional<int> ChildProcess::wait(double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (isRunning() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return status_;
}

}  // namespace ergotic::test
