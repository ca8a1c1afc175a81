// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/replay_driver.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include "ergotic/rt/realtime.hpp"
#include "tgr/require.hpp"

namespace ergotic::tgr {
namespace {

class ReplayDriver final : public Driver {
 public:
  explicit ReplayDriver(std::unique_ptr<GestureSource> source)
      : source_(std::move(source)), slices_(source_->slices()) {
    requireWithin("slices of the gesture", slices_, 1, kMaxSlices, "");
  }

  void open(double) override { open_ = true; }
  void close() noexcept override { open_ = false; }
  bool canHurt() const noexcept override { return false; }
  bool isSteppedByExchange() const noexcept override { return true; }
  int slices() const noexcept override { return slices_; }

  ERGOTIC_REALTIME std::uint32_t exchange(const double*, double* positions) noexcept override {
    std::uint32_t flags = safe_ ? kMadeSafe : kExchangeOk;
    if (!open_) {
      flags |= kDeviceLost;
    } else if (!source_->next(last_.data())) {
      flags |= kMissingSample;
    }
    std::copy_n(last_.begin(), slices_, positions);
    return flags;
  }

  void makeSafe() noexcept override { safe_ = true; }
  void rearm() noexcept override { safe_ = false; }

 private:
  std::unique_ptr<GestureSource> source_;
  int slices_;
  std::array<double, kMaxSlices> last_{};
  std::atomic<bool> open_{false};
  std::atomic<bool> safe_{false};
};

}  // namespace

std::unique_ptr<Driver> makeReplayDriver(std::unique_ptr<GestureSource> source) {
  return std::make_unique<ReplayDriver>(std::move(source));
}

}  // namespace ergotic::tgr
