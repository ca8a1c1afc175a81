// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "coefficients.hpp"
#include "guarded.hpp"
#include "guarded_groups.hpp"
#include "points.hpp"
#include "state.hpp"
#include "stepper.hpp"

namespace ergotic::physics {

/// The guarded links of an instrument: finds the modules behind their ends, steps those of one rate
/// together, and keeps their books of energy.
template <class Real>
class GuardedRuns {
 public:
  /// Adds its entries to the arena. \pre the arena is not allocated
  GuardedRuns(const scene::Scene& scene,
              const Layout& layout,
              const Points<Real>& points,
              State<Real>& state);

  /// Steps the guarded links of sections whose steps end with this frame, adds their forces to all
  /// modules and points. Only then are all other forces of these steps there: links to faster
  /// sections give theirs frame by frame. \pre so are those of this frame. Realtime: yes
  void step(std::int64_t now,
            const CoefficientsOf<Real>& c,
            const Stepper<Real>& stepper,
            State<Real>& state) noexcept;

  /// Tanks follow other coefficients. Realtime: yes
  void retune(const CoefficientsOf<Real>& from,
              const CoefficientsOf<Real>& to,
              State<Real>& state) noexcept;

  std::vector<GuardReport> makeReports() const;
  /// Realtime: yes
  void read(const State<Real>& state, std::vector<GuardReport>& to) const noexcept;

 private:
  /// The modules behind both ends of a link.
  struct Reach {
    std::array<GuardedTerm, 24> terms;
    std::size_t count = 0;
    double offset[3] = {0.0, 0.0, 0.0};
  };
  struct Group {
    GuardedLinks<Real> links;
    std::vector<std::size_t> moving;  // links with an end on a place
    std::vector<unsigned char> idle;  // [links]
    std::size_t states_at;
  };

  GuardedLink describe(const GuardedRef& ref, const double* places) const;
  Reach reachOf(const GuardedRef& ref, const double* places) const noexcept;
  void reachEnd(int slot,
                int stride,
                int dimensions,
                const Eigen::Matrix3d& map,
                int slow_section,
                const double* places,
                Reach& to) const noexcept;
  bool isOnPlace(int slot) const noexcept;
  void collectReached();
  GuardedView<Real> viewOf(const Group& group,
                           const CoefficientsOf<Real>& c,
                           State<Real>& state) const noexcept;
  void followPlaces(std::size_t g, State<Real>& state) noexcept;
  void markIdle(std::size_t g, State<Real>& state) noexcept;
  void markDue(std::int64_t began) noexcept;
  void exchange(std::size_t g,
                std::int64_t began,
                const Stepper<Real>& stepper,
                State<Real>& state) noexcept;
  void closeBooks(std::size_t g, bool starts, State<Real>& state) const noexcept;
  GuardedState<Real>* states(std::size_t g, State<Real>& state) const noexcept {
    return state.arena().template at<GuardedState<Real>>(groups_[g].states_at);
  }

  const Layout& layout_;
  const Points<Real>& points_;
  std::vector<Eigen::Vector3d> rests_;   // [mats]
  std::vector<int> place_of_slot_;       // -1: none
  std::vector<int> projection_of_slot_;  // -1: none
  std::vector<GuardedGroup> members_;    // [groups]
  std::vector<Group> groups_;
  std::vector<unsigned char> due_;  // [sections] moved as the present step began
  std::vector<Real> forces_;        // [slots], of guarded links; zero between steps
  std::vector<int> reached_;        // slots that these can be on
};

extern template class GuardedRuns<float>;
extern template class GuardedRuns<double>;

}  // namespace ergotic::physics
