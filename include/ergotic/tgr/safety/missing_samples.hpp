// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace ergotic::tgr {

/// Counts samples that did not come, in a row. A tick that the host itself missed asked for none.
/// Realtime: yes
class MissingSamples {
 public:
  /// \param most  that are held
  explicit MissingSamples(int most) noexcept : most_(most) {}

  /// \return true if it may be held: not too many are missing
  bool miss() noexcept {
    missing_ += missing_ <= most_ ? 1 : 0;
    return missing_ <= most_;
  }
  void cameAgain() noexcept { missing_ = 0; }

 private:
  int most_;
  int missing_ = 0;
};

}  // namespace ergotic::tgr
