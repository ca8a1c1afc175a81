// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "ergotic/rt/realtime.hpp"
#include "ergotic/rt/ring.hpp"
#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/gesture.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

class ReadAhead final : public GestureSource {
 public:
  ReadAhead(std::unique_ptr<GestureSource> slow, std::size_t ticks)
      : slow_(std::move(slow)), slices_(slow_->slices()) {
    requireWithin("slices of the gesture", slices_, 1, kMaxSlices, "");
    rows_ = std::make_unique<rt::Ring<double>>(ticks * width());
    fill();
    thread_ = std::thread([this] { run(); });
  }
  ~ReadAhead() override {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
    }
    woken_.notify_all();
    thread_.join();
  }
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  int slices() const noexcept override { return slices_; }

  ERGOTIC_REALTIME bool next(double* positions) noexcept override {
    const bool is_all = is_all_;  // before the rows are counted: none comes after it
    ++wanted_;
    while (rows_->readable() >= width()) {
      std::array<double, kMaxSlices> row{};
      rows_->pop(row.data(), width());
      if (--wanted_ == 0) {
        std::copy_n(row.begin(), slices_, positions);
        return true;
      }  // else it was wanted when it was not there yet
    }
    wanted_ = is_all ? 0 : wanted_;
    return false;
  }

 private:
  std::size_t width() const noexcept { return static_cast<std::size_t>(slices_); }

  void run() {
    using namespace std::chrono_literals;
    constexpr auto kPause = 20ms;  // a tenth of what is ahead at the fastest ticks
    std::unique_lock lock(mutex_);
    while (!is_all_ && !woken_.wait_for(lock, kPause, [this] { return quit_; })) {
      lock.unlock();
      fill();
      lock.lock();
    }
  }
  void fill() noexcept {
    std::array<double, kMaxSlices> row{};
    while (!is_all_ && rows_->writable() >= width()) {
      if (slow_->next(row.data())) {
        rows_->push(row.data(), width());
      } else {
        is_all_ = true;
      }
    }
  }

  std::unique_ptr<GestureSource> slow_;  // the thread's, once it runs
  int slices_;
  std::unique_ptr<rt::Ring<double>> rows_;
  std::atomic<bool> is_all_{false};  // that there is
  std::int64_t wanted_ = 0;          // the tick's: rows that were asked for and did not come

  std::mutex mutex_;  // of what follows
  std::condition_variable woken_;
  bool quit_ = false;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<GestureSource> readAhead(std::unique_ptr<GestureSource> slow, std::size_t ticks) {
  return std::make_unique<ReadAhead>(std::move(slow), ticks);
}

}  // namespace ergotic::tgr
