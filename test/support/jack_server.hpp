// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <sys/types.h>

namespace ergotic::test {

/// A JACK server of our own on the dummy driver: private name, gone with the object, with the test
/// program, or by `kill`.
class JackServer {
 public:
  struct Settings {
    int sample_rate = 44100;  ///< Hz
    int period_frames = 256;
    int channels = 2;  ///< physical ports, each way
    /// Every block waits for all clients, so that it has the frame time of its cycle.
    bool synchronous = true;
    int timeout_ms = 2000;  ///< before a client that a busy machine holds up is expelled
  };

  /// Not running yet; \param tag  tells servers of one test program apart
  explicit JackServer(const std::string& tag);
  JackServer(const std::string& tag, const Settings& settings);
  ~JackServer();
  JackServer(const JackServer&) = delete;
  JackServer& operator=(const JackServer&) = delete;

  /// Returns when clients can connect. \throws std::runtime_error with what jackd said
  void start();
  /// SIGTERM, and SIGKILL if that does not help; no effect if it does not run.
  void stop();
  /// SIGKILL: clients are not told.
  void kill();

  /// SIGSTOP, until `thaw`: it is there, and does nothing.
  void freeze();
  void thaw();

  const std::string& name() const noexcept { return name_; }
  /// Runs one of JACK's command line tools against this server. \return its exit status
  int tool(const std::string& command) const;

 private:
  void end(int signal);
  void giveBackPlace();

  std::string name_;
  Settings settings_;
  pid_t pid_ = -1;
};

}  // namespace ergotic::test
