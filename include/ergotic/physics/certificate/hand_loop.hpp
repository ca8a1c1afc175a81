// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <vector>

namespace ergotic::physics {

/// Properties of a device on which passivity at the ports depends.
struct DeviceTraits {
  double damping = 2.0;      ///< damping of each slice by itself, N s/m, > 0
  double delay_ticks = 1.0;  ///< delay from a position to the force that answers it, >= 0
  /// Indices in Scene::ports: their slice does not move them by itself, whatever the scene says.
  std::vector<int> taken_ports = {};
  double mass = 0.3;  ///< moving mass of each slice, kg, >= 0
};

/// N/m: no hand resists more at any frequency by its position.
constexpr double kStiffestHand = 2e4;

/// Judgement on the load that a slice meets.
enum class HandLevel {
  kSilent,   ///< at most half of the limit at which a hand may oscillate
  kWarned,   ///< more than that
  kRefused,  ///< more than a slice of twice the damping bears: it will buzz or jump
};

/// Load that a slice meets, at the device.
struct HandLoad {
  double stiffness = 0.0;  ///< N/m, >= 0
  double damping = 0.0;    ///< N s/m, >= 0
  double interpolated_stiffness =
      0.0;  ///< of these, of what sees the slice interpolated (coupling: smooth)
  double interpolated_damping = 0.0;
};

/// The share of a part, 0 of nothing.
inline double partOf(double part, double all) {
  return all > 0.0 ? part / all : 0.0;
}

/// A slice with a mass m and a damping b in a hand, and a spring K and a damper B that answer its
/// sampled position d ticks late, with a force that is held for a tick. What sees the slice
/// interpolated answers with the response of the interpolation and its adjoint.
///
/// The hand is anything passive, of any mass, that is not stiffer than kStiffestHand. Without m
/// that is the condition of Colgate and Schenkel (1997), exact by Fardad and Bamieh (2009):
/// `b > max K T/2 sin((d + 1/2) w T)/sin(w T/2) - B cos((d + 1) w T)`.
/// Realtime: no. Source: docs/physics/stability.md, "Passivity at the device".
class HandLoop {
 public:
  /// \param steps  of the faster section in a tick, where slices are interpolated
  HandLoop(const DeviceTraits& device, double tick_s, int steps = 2);

  /// The stiffest spring that by itself no hand sets off, N/m: 2 b/((1 + 2 d) T), d by 3/2 more
  /// for the part that sees the slice interpolated.
  double stiffnessLimit(double interpolated = 0.0) const;
  /// The strongest damper that by itself no hand sets off, N s/m, to 1 %. Cost: 1 ms, as of what
  /// follows
  double dampingLimit(double interpolated = 0.0) const;

  /// Factor by which the whole load must be divided so that no hand makes it unstable; 1: at the
  /// limit. The worse of the spring with the damper and without, as a damper does not act wherever
  /// the spring does.
  double share(const HandLoad& load) const;
  double share(double stiffness, double damping) const { return share({stiffness, damping}); }

  HandLevel judge(const HandLoad& load) const;
  HandLevel judge(double stiffness, double damping) const { return judge({stiffness, damping}); }

 private:
  /// Mobilities that the slice and its hand may have at one frequency of the samples.
  class Mobilities;

  std::complex<double> answerAt(double angle, const HandLoad& load) const;
  double shareAt(double angle, const HandLoad& load) const;
  double worstShare(const HandLoad& load) const;

  double damping_;
  double delay_;
  double mass_;
  double tick_s_;
  int steps_;
  std::vector<double>
      of_spring_;  // [ticks] what sees the slice interpolated answers, see interpolationResponse
  std::vector<double> of_damper_;  // [ticks]
};

}  // namespace ergotic::physics
