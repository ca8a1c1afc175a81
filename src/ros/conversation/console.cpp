// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/console.hpp"

#include <atomic>
#include <utility>

#include <ros/console.h>

namespace ergotic::node {
namespace {

constexpr std::size_t kMostLines = 1000;

std::atomic<Console*> of_this_process{nullptr};  // rosconsole calls a plain function

}  // namespace

std::shared_ptr<Console> Console::ofThisProcess() {
  static std::mutex mutex;
  static std::weak_ptr<Console> shared;
  const std::lock_guard lock(mutex);
  std::shared_ptr<Console> console = shared.lock();
  if (!console) {
    console.reset(new Console);
    shared = console;
  }
  return console;
}

Console::Console() {
  ::ros::console::initialize();
  write_ = ::ros::console::backend::function_print;
  thread_ = std::thread([this] { run(); });
  of_this_process = this;
  ::ros::console::backend::function_print = &Console::take;
  console_bridge::useOutputHandler(this);
}

Console::~Console() {
  console_bridge::restorePreviousOutputHandler();
  ::ros::console::backend::function_print = write_;
  of_this_process = nullptr;
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  woken_.notify_all();
  thread_.join();
}

void Console::take(void* logger,
                   ::ros::console::Level level,
                   const char* text,
                   const char* file,
                   const char* function,
                   int number) {
  if (Console* const console = of_this_process) {
    console->add({logger, level, text, file, function, number});
  }
}

void Console::log(const std::string& text,
                  console_bridge::LogLevel level,
                  const char* file,
                  int number) {
  static_assert(static_cast<int>(::ros::console::levels::Error) ==
                static_cast<int>(console_bridge::CONSOLE_BRIDGE_LOG_ERROR));
  add({nullptr, static_cast<::ros::console::Level>(level), text, file, "", number});
}

void Console::add(Line line) {
  {
    const std::lock_guard lock(mutex_);
    if (lines_.size() >= kMostLines) {
      return;
    }
    lines_.push_back(std::move(line));
  }
  woken_.notify_all();
}

void Console::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    woken_.wait(lock, [this] { return ends_ || !lines_.empty(); });
    if (lines_.empty()) {
      return;
    }
    const Line line = std::move(lines_.front());
    lines_.pop_front();
    lock.unlock();
    write_(line.logger, line.level, line.text.c_str(), line.file.c_str(), line.function.c_str(),
           line.number);
    lock.lock();
  }
}

}  // namespace ergotic::node
