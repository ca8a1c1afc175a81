// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "ergotic/physics/engine/instrument.hpp"

namespace ergotic::physics {

/// The linear part of a scene, see monodromy(): at rest at 0, nothing pulls, nobody touches it.
/// \param slices  modules that stay in a hand: the ports that are left, at scales of 1
scene::Scene linearPart(scene::Scene scene, const std::vector<int>& slices = {});

/// True of links of which something stays in that part.
bool hasLinearPart(const scene::Lia& lia);

/// A place of the state of an instrument, and the module that it is of, -1: none.
struct MovingSlot {
  std::size_t slot = 0;
  int module = -1;
};

/// Steps an instrument from states of one's own, one period of its slowest section at a time.
/// Realtime: no.
class LinearStepper {
 public:
  LinearStepper(const scene::Scene& linear, const Rates& rates);

  /// Numbers of each of the three parts of a state: positions, differences, forces.
  int slots() const { return static_cast<int>(slots_.size()); }
  /// Numbers of a state: behind these three parts, the forces that slices have yet to get which
  /// are interpolated.
  int numbers() const { return 3 * slots() + static_cast<int>(interpolated_forces_); }
  /// The module that a slot is of, -1: none.
  int moduleOf(int slot) const { return slots_[static_cast<std::size_t>(slot)].module; }
  double periodSeconds() const { return period_s_; }
  int ticks() const { return ticks_; }  ///< per period

  /// \param state  shape (numbers), at the start of a period
  /// \param moved  port whose position is 1 from the start of the period on, 0 of the others; -1:
  ///               of all
  /// \return       the same one period later
  Eigen::VectorXd step(const Eigen::VectorXd& state, int moved = -1);
  /// [ports] on their slices, in the last tick of that period.
  const std::vector<double>& forces() const { return forces_; }

 private:
  double& number(int which, std::size_t slot);
  /// Calls `visit(index, number)` for all numbers of the present state.
  template <class Visit>
  void visitNumbers(const Visit& visit);

  std::vector<MovingSlot> slots_;  // whose state counts

  std::unique_ptr<Instrument> instrument_;
  std::vector<std::byte> rest_;  // the state at time 0
  std::vector<std::byte> state_;
  std::size_t offsets_[4] = {0, 0, 0, 0};
  std::size_t interpolated_forces_ = 0;
  int ticks_;
  double period_s_;
  std::vector<double> positions_;
  std::vector<double> forces_;
  std::vector<double> inputs_;
  std::vector<double> outputs_;
};

/// Growth of a linear scene that is too large for its eigenvalues, measured over 2000 periods: the
/// slope of the logarithm of its size over the second half. It may show growth, but never proves
/// that there is none.
struct GrowthSeen {
  double per_second = 0.0;
  bool is_visible = false;  ///< larger, of either sign, than what the method scatters by
  int periods = 0;          ///< less than 2000 in very large scenes
};
GrowthSeen watchGrowth(const scene::Scene& linear, const Rates& rates);

}  // namespace ergotic::physics
