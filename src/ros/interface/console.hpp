// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <console_bridge/console.h>

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <ros/console_backend.h>

namespace ergotic::node {

/// Keeps the threads of this process from waiting for a terminal: a thread of its own writes the
/// log. A terminal that is held (Ctrl-S) or a pipe without a reader would otherwise block the
/// thread that reads the sockets at its next warning, and a request to stop would not be received.
/// Lines that do not fit are lost. Thread: any
class Console : private console_bridge::OutputHandler {
 public:
  /// Console of this process, shared by its stations.
  static std::shared_ptr<Console> ofThisProcess();
  ~Console() override;  ///< writes what waits
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

 private:
  using Print = decltype(::ros::console::backend::function_print);
  /// A log line from rosconsole.
  struct Line {
    void* logger = nullptr;
    ::ros::console::Level level = ::ros::console::levels::Info;
    std::string text;
    std::string file;
    std::string function;
    int number = 0;
  };

  Console();
  /// Logs errors that roscpp finds in headers.
  void log(const std::string& text,
           console_bridge::LogLevel level,
           const char* file,
           int number) override;
  static void take(void* logger,
                   ::ros::console::Level level,
                   const char* text,
                   const char* file,
                   const char* function,
                   int number);
  void add(Line line);
  void run();

  Print write_ = nullptr;  // rosconsole's own
  std::mutex mutex_;       // of what follows
  std::condition_variable woken_;
  std::deque<Line> lines_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace ergotic::node
