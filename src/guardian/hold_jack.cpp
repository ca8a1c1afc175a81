// SPDX-License-Identifier: BSD-3-Clause
#include <semaphore.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include <jack/jack.h>

#include "ergotic/exception.hpp"
#include "guardian/hold.hpp"

namespace ergotic::guardian {
namespace {

void ignore(const char*) {}

/// A client without ports. A thread of its own cuts: libjack may not come back from a server that
/// hangs.
class JackHold final : public Hold {
 public:
  JackHold(const std::string& server, std::vector<std::string> ports) : ports_(std::move(ports)) {
    jack_set_error_function(ignore);
    jack_set_info_function(ignore);
    const auto options = server.empty() ? JackNoStartServer : JackNoStartServer | JackServerName;
    client_ = jack_client_open("ergotic_guardian", static_cast<jack_options_t>(options), nullptr,
                               server.c_str());
    if (client_ == nullptr) {
      throw DeviceError("JACK takes no client of the guardian");
    }
    ::sem_init(&woken_, 0, 0);
    thread_ = std::thread([this] { run(); });
  }
  /// Once all is cut that was to be.
  ~JackHold() override {
    ends_ = true;
    ::sem_post(&woken_);
    thread_.join();
    jack_client_close(client_);
  }
  JackHold(const JackHold&) = delete;
  JackHold& operator=(const JackHold&) = delete;

  void makeSafe() noexcept override {
    wanted_ = true;
    ::sem_post(&woken_);
  }

 private:
  void run() {
    do {
      ::sem_wait(&woken_);
      if (wanted_.exchange(false)) {
        std::for_each(ports_.begin(), ports_.end(), [this](const auto& port) { cut(port); });
      }
    } while (!ends_ || wanted_);
  }
  void cut(const std::string& name) {
    const jack_port_t* const port = jack_port_by_name(client_, name.c_str());
    if (port == nullptr) {
      return;  // the server has taken it away by itself
    }
    const char** const sinks = jack_port_get_all_connections(client_, port);
    for (const char** sink = sinks; sink != nullptr && *sink != nullptr; ++sink) {
      jack_disconnect(client_, name.c_str(), *sink);
    }
    jack_free(static_cast<void*>(sinks));
  }

  std::vector<std::string> ports_;
  jack_client_t* client_ = nullptr;
  sem_t woken_{};
  std::atomic<bool> wanted_{false};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace

std::unique_ptr<Hold> holdJack(const std::vector<std::string>& words) {
  return std::make_unique<JackHold>(words.at(0),
                                    std::vector<std::string>(words.begin() + 1, words.end()));
}

}  // namespace ergotic::guardian
