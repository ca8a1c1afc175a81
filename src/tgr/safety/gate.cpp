// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/tgr/safety/gate.hpp"

#include <algorithm>

#include "ergotic/rt/realtime.hpp"

namespace ergotic::tgr {

ERGOTIC_REALTIME void Gate::open() noexcept {
  if (!open_) {
    open_ = true;
    ramp_ = 0.0;
  }
}

ERGOTIC_REALTIME void Gate::close() noexcept {
  open_ = false;
  ramp_ = 0.0;
}

ERGOTIC_REALTIME double Gate::next() noexcept {
  const double gain = ramp_ * resume_gain_;
  ramp_ = std::min(1.0, ramp_ + step_);
  resume_gain_ = std::min(1.0, resume_gain_ + resume_step_);
  return gain;
}

}  // namespace ergotic::tgr
