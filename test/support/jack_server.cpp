// SPDX-License-Identifier: BSD-3-Clause
#include "support/jack_server.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <thread>

#include <sys/prctl.h>
#include <sys/wait.h>

#include "support/places.hpp"
#include "support/test.hpp"

namespace ergotic::test {

namespace {

constexpr std::chrono::milliseconds kLook{20};
constexpr int kLooks = 1000;  // 20 s: shared machines are slow

std::string logPath(const std::string& name) {
  return (std::filesystem::temp_directory_path() / (name + ".log")).string();
}

/// Where clients knock; there once the server listens.
std::string socketPath(const std::string& name) {
  return "/dev/shm/jack_" + name + "_" + std::to_string(getuid()) + "_0";
}

/// JACK has room for eight servers, and a killed one keeps its place until its name comes again.
bool holdsAPlace(const std::string& name) {
  return textOf("/dev/shm/jack-shm-registry").find(":" + name + ":") != std::string::npos;
}

[[noreturn]] void becomeServer(const std::vector<std::string>& words, const std::string& log) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  const int out = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(out, STDOUT_FILENO);
  dup2(out, STDERR_FILENO);
  std::vector<char*> arguments;
  for (const std::string& word : words) {
    arguments.push_back(const_cast<char*>(word.c_str()));
  }
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

}  // namespace

JackServer::JackServer(const std::string& tag) : JackServer(tag, Settings{}) {}

JackServer::JackServer(const std::string& tag, const Settings& settings)
    : name_("ergotic_test_" + std::to_string(getpid()) + "_" + tag), settings_(settings) {}

JackServer::~JackServer() {
  stop();
  if (holdsAPlace(name_)) {
    giveBackPlace();
  }
  std::filesystem::remove(logPath(name_));
  // Semaphores that neither a killed server nor its clients took away.
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm")) {
    if (entry.path().filename().string().find("_" + name_ + "_") != std::string::npos) {
      std::filesystem::remove(entry.path());
    }
  }
}

void JackServer::giveBackPlace() {
  try {
    start();
    stop();
  } catch (const std::exception& error) {
    std::cerr << name_ << " keeps its place among JACK's servers: " << error.what() << std::endl;
  }
}

void JackServer::start() {
  // Real-time where permitted; two seconds before a client that a busy machine holds up is
  // expelled.
  const std::string realtime = geteuid() == 0 ? "-R" : "-r";
  std::vector<std::string> words{"jackd", "-n",
                                 name_,   realtime,
                                 "-P",    "70",
                                 "-t",    std::to_string(settings_.timeout_ms),
                                 "-d",    "dummy",
                                 "-r",    std::to_string(settings_.sample_rate),
                                 "-p",    std::to_string(settings_.period_frames),
                                 "-C",    std::to_string(settings_.channels),
                                 "-P",    std::to_string(settings_.channels)};
  if (settings_.synchronous) {
    words.insert(words.begin() + 1, "-S");
  }
  std::filesystem::remove(socketPath(name_));  // of one that was killed
  pid_ = fork();
  if (pid_ == 0) {
    becomeServer(words, logPath(name_));
  }
  for (int look = 0; look < kLooks; ++look) {
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) == pid_) {
      pid_ = -1;
      throw std::runtime_error("jackd (Debian package jackd2) does not start: " +
                               textOf(logPath(name_)));
    }
    if (std::filesystem::exists(socketPath(name_))) {
      return;
    }
    std::this_thread::sleep_for(kLook);
  }
  throw std::runtime_error("jackd does not listen at " + socketPath(name_) + ": " +
                           textOf(logPath(name_)));
}

void JackServer::stop() {
  end(SIGTERM);
}

void JackServer::kill() {
  end(SIGKILL);
}

void JackServer::freeze() {
  ::kill(pid_, SIGSTOP);
}

void JackServer::thaw() {
  ::kill(pid_, SIGCONT);
}

void JackServer::end(int signal) {
  if (pid_ < 0) {
    return;
  }
  ::kill(pid_, signal);
  for (int look = 0; waitpid(pid_, nullptr, WNOHANG) == 0; ++look) {
    if (look == kLooks / 4) {
      ::kill(pid_, SIGKILL);
    }
    std::this_thread::sleep_for(kLook);
  }
  pid_ = -1;
  std::filesystem::remove(socketPath(name_));
}

int JackServer::tool(const std::string& command) const {
  const std::string line = "JACK_DEFAULT_SERVER=" + name_ + " " + command + " >/dev/null 2>&1";
  const int status = std::system(line.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace ergotic::test
