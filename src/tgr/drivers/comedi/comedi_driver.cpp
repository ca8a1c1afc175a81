// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/comedi/comedi_driver.hpp"

#include <algorithm>
#include <utility>

#include "ergotic/rt/realtime.hpp"

namespace ergotic::tgr {

void ComediDriver::open(double) {
  close();
  takeBoard();
  open_ = true;
}

void ComediDriver::close() noexcept {
  open_ = false;
  online_ = false;
  dropBoard();
}

void ComediDriver::reconnect() {
  if (open_ && !online_) {
    dropBoard();  // first: it may still hold the lock of the subdevices
    takeBoard();
  }
}

/// Opening takes its time; makeSafe need not wait for it, because the board begins with safe volts.
void ComediDriver::takeBoard() {
  auto board = std::make_unique<ComediBoard>(settings_);
  {
    const std::lock_guard<std::mutex> guard(board_mutex_);
    board_ = std::move(board);
  }
  online_ = true;
}

void ComediDriver::dropBoard() noexcept {
  std::unique_ptr<ComediBoard> old;
  const std::lock_guard<std::mutex> guard(board_mutex_);
  old = std::move(board_);
}

ERGOTIC_REALTIME std::uint32_t ComediDriver::exchange(const double* outputs,
                                                      double* inputs) noexcept {
  const bool safe = safe_;
  std::uint32_t flags = kDeviceLost;
  if (online_) {
    flags = board_->exchange(safe ? settings_.safe_volts.data() : outputs, inputs_.data());
    if ((!safe && safe_) || (safe && (flags & kWriteFailed) != 0)) {
      flags |= board_->writeSafe();
    }
    if ((flags & kDeviceLost) != 0) {
      online_ = false;  // the last touch: from here on the board is reconnect's
    }
  }
  std::copy_n(inputs_.begin(), slices(), inputs);
  return flags | (safe_ ? kMadeSafe : 0U);
}

void ComediDriver::makeSafe() noexcept {
  safe_ = true;
  const std::lock_guard<std::mutex> guard(board_mutex_);
  if (board_ != nullptr) {
    board_->writeSafe();
  }
}

}  // namespace ergotic::tgr
