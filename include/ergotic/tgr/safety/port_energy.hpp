// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace ergotic::tgr {

/// Energy that a port took from the hand, from the forces that really acted. Realtime: yes, all but
/// the constructor.
///
///   E <- min(E - F_app dx + c b dx^2 / T + supply, cap + |F| |x - x0|),   dx = x[n] - x[n-1]
///   E <- max(E + dg max(-F (x - x0), 0) / 2, min(E, 0))
///   c = 1 while (1/2 + d) sum(-dF dx) <= sum(b dx^2 / T) over some kMemoryS of contact, else 0
///
/// F_app is the force that the device held from the sample n - 1 to the sample n; under such a
/// force -F_app dx is exact (Stramigioli, Secchi, van der Schaft, Fantuzzi 2005). b is the damping
/// of the slice itself: while there is force, what it takes is no gift to the hand, as long as it
/// is enough for what sampling gives out (Colgate, Schenkel 1997). A contact too stiff for that is
/// on its own, so that it never trembles on the slice's account. The bound keeps what was
/// dissipated long ago from paying for what is given out now: F is the force that the model wants,
/// cut to its limit, and x0 where it was last 0, whether it goes out or not, so that all comes back
/// that any spring, soft or stiff, can have stored. dg is the change of the gain that the force is
/// multiplied by: by so much it changes what a linear spring gives back.
///
/// A force issued at tick n is sent by the exchange of tick n + 1, and acts from there on: with a
/// device's own delay of e ticks, F_app was issued at n - 2 - e, and d = 1 + e forces are under
/// way.
class PortEnergy {
 public:
  struct Rules {
    double cap_j = 0.0;
    double supply_w = 0.0;
    double damping = 0.0;  ///< b, N s/m
    double tick_s = 0.0;
    int delay_ticks = 1;  ///< d, 1...kMaxDelayTicks
  };
  explicit PortEnergy(const Rules& rules);

  /// A sample came. \param dx  m. \param ticks  since the last one
  void moved(double dx, std::int64_t ticks) noexcept;

  /// Energy to come, without the force that is to be issued now, if every tick moves by `dx`: J.
  double predicted(double dx) const noexcept;

  /// Records the force that the model wants at the position of the last `moved`. \param force  N,
  /// limited
  void follow(double force) noexcept;
  /// Marks the position at which the next force was 0 as unknown: it is taken to be kUnknownWayM
  /// away, in the direction of the push. A hand that rests in a wall when a model starts then gets
  /// its full force.
  void loseTrack() noexcept { is_lost_ = true; }
  /// Takes a change of the gain of the force into account.
  void lift(double gain_change) noexcept;

  /// Records a force, which the next exchange will send.
  void issue(double force) noexcept;
  /// Records that zero is sent instead of the force issued last.
  void withdraw() noexcept { under_way_[newest_] = 0.0; }
  double issued() const noexcept { return under_way_[newest_]; }  ///< N

  double energy() const noexcept { return energy_; }  ///< J
  double least() const noexcept { return least_; }    ///< J, since `forget`

  /// Sets the energy to 0; forces under way stay.
  void restart() noexcept { energy_ = 0.0; }
  /// Clears everything but the force that the model wants.
  void forget() noexcept;

  static constexpr int kMaxDelayTicks = 256;
  static constexpr double kUnknownWayM = 0.02;
  static constexpr double kMemoryS = 0.02;

 private:
  bool pays() const noexcept { return sampling_j_ <= damped_j_; }

  double cap_j_;
  double supply_j_;                // per tick
  double damping_j_;               // per m^2 and tick
  double loop_ticks_;              // 1/2 + d
  double kept_;                    // of the sums, per tick
  std::vector<double> under_way_;  // d + 1 forces: d under way, and the one before them
  std::size_t newest_ = 0;
  double energy_ = 0.0;
  double least_ = 0.0;
  double wanted_ = 0.0;      // by the model, N
  double way_ = 0.0;         // since that was 0, m
  double dx_ = 0.0;          // of this tick, m
  double own_j_ = 0.0;       // taken by the slice itself in this tick
  double sampling_j_ = 0.0;  // given out by sampling, lately
  double damped_j_ = 0.0;    // taken by the slice itself, lately
  bool is_lost_ = false;
};

}  // namespace ergotic::tgr
