// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/console.hpp"

#include <utility>

#include <ros/console.h>

namespace ergotic::node {
namespace {

constexpr std::size_t kMaxLines = 1000;

// rosconsole calls a plain function, which other nodelets do while the last station is unloaded.
std::mutex taking;
Console* taker = nullptr;

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
  {
    const std::lock_guard lock(taking);
    taker = this;
  }
  ::ros::console::backend::function_print = &Console::take;
  console_bridge::useOutputHandler(this);
}

Console::~Console() {
  console_bridge::restorePreviousOutputHandler();
  ::ros::console::backend::function_print = write_;
  {
    const std::lock_guard lock(taking);
    taker = nullptr;
  }
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
  const std::lock_guard lock(taking);
  if (taker != nullptr) {
    taker->add({logger, level, text, file, function, number});
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
    if (lines_.size() >= kMaxLines) {
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
