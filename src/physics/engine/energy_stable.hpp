// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "physics/laws/dry_friction.hpp"
#include "physics/laws/energy_stable_force.hpp"

namespace ergotic::physics {

/// One coordinate of a module on which an energy-stable link acts, directly or through points.
struct EnergyStableTerm {
  int slot = 0;                  ///< slot of the coordinate
  int module = 0;                ///< slot of the module's first coordinate
  int component = 0;             ///< 0 x, 1 y, 2 z
  double weight[3] = {1, 0, 0};  ///< weight in each coordinate of end a less end b
  int slow_section = -1;         ///< section of the module, if it is slower than the link
  bool is_tap = false;           ///< its next step is in EnergyStableView::ahead
};

struct EnergyStableLink {
  int dimensions = 0;  ///< 0: scalar; otherwise it works along the line that joins its ends
  std::vector<EnergyStableTerm> terms;
  double offset[3] = {0, 0, 0};  ///< end a less end b while all displacements are 0, m
  bool sticks = false;           ///< friction that comes after all others
  double share = 1.0;            ///< part of the step of a slower end in one step of the link
  bool may_wait = false;         ///< a contact that nothing but the motion of its terms closes
};

template <class Real>
class NearLinks;

/// Normal force of a dry friction, and its direction.
template <class Real>
struct Pressure {
  Real force = Real(0);                        ///< >= 0
  Real line[3] = {Real(0), Real(0), Real(0)};  ///< unit vector of the contact; 0: all slip counts
};

/// The modules as links see them within a step; `f`: forces of everything else.
template <class Real>
struct EnergyStableView {
  const Real* x = nullptr;
  const Real* d = nullptr;  ///< x[n] - x[n-1]
  const Real* f = nullptr;
  // The step to come is d <- d - (lose d + pull x) + inverse_mass f + drift.
  const Real* inverse_mass = nullptr;  ///< h^2/M; 0: forces do not move it
  const Real* drift = nullptr;
  const Real* lose = nullptr;
  const Real* pull = nullptr;
  const unsigned char* due = nullptr;       ///< [sections] 1 if it moved in this step
  const unsigned char* idle = nullptr;      ///< [links] 1 if it sleeps; none: all are awake
  const Real* ahead = nullptr;              ///< [slots] the step to come of taps
  const Pressure<Real>* pressed = nullptr;  ///< [links]
};

/// A module as the energy-stable links on it see it.
template <class Real>
struct EnergyStableModule {
  Real links = Real(0);                        // c, those that are active
  Real last[3] = {Real(0), Real(0), Real(0)};  // sum of their forces in the last step
  Real load[3] = {Real(0), Real(0), Real(0)};  // and in this one
  std::size_t first_link = 0;                  // 1 + one of them, while debts are settled
  // Of frictions that stick, in this step:
  Real heat = Real(0);   // what they took
  Real spent = Real(0);  // what others of them gave of that
};

/// Links that never give more energy than they took, of one rate, all together: those that share
/// masses know of each other.
///
/// Each has a tank: the work its force has absorbed. Its force is that of the law at a point a
/// little ahead (fourth order in contact time and rebound), cut to what the tank can pay for.
/// Friction has no tank, so it can only slow the slip down, at most to rest. That which sticks
/// comes after all others, one after the other: each knows what those before it have done. Source:
/// docs/physics/schemes.md, "Energy-stable links".
template <class Real>
class EnergyStableLinks {
 public:
  /// \param modules  [slots] all zero between steps; those who share no modules may share it.
  /// Realtime: no
  EnergyStableLinks(const std::vector<EnergyStableLink>& links,
                    std::vector<EnergyStableModule<Real>>& modules);

  std::size_t size() const noexcept { return links_.size(); }

  /// Fills the tanks with the energy that the links hold where the modules are.
  /// \param laws, states  [size()], here and below
  void start(const EnergyStableView<Real>& view,
             const EnergyStableLaw<Real>* laws,
             EnergyStableState<Real>* states) const noexcept;

  /// Works out the forces of this step, see EnergyStableState. End b receives them along the
  /// gradient, end a against it. \param near  the links that may have any. Realtime: yes. Cost:
  /// O(near)
  void step(const NearLinks<Real>& near,
            const EnergyStableView<Real>& view,
            const EnergyStableLaw<Real>* laws,
            EnergyStableState<Real>* states) noexcept;

  /// How far apart the ends of a contact were in the last step, m; 0 if it does anything, or may do
  /// so though nothing moves. \pre it was near then. Realtime: yes
  Real gapOf(std::size_t link, const EnergyStableState<Real>& state) const noexcept;

  /// Other laws come: their tanks follow, by work of whoever turned the knob.
  /// Realtime: yes. Cost: O(links)
  void retune(const EnergyStableView<Real>& view,
              const EnergyStableLaw<Real>* from,
              const EnergyStableLaw<Real>* to,
              EnergyStableState<Real>* states) const noexcept;

  /// Other modules for a link whose end has moved along a string.
  /// \pre as many terms as it was made with. Realtime: yes. Cost: O(count^2)
  void setTerms(std::size_t link,
                const EnergyStableTerm* terms,
                std::size_t count,
                const double (&offset)[3]) noexcept;

  /// Energy stored in a link of this law where the modules are now. Realtime: yes
  Real stored(const EnergyStableView<Real>& view,
              const EnergyStableLaw<Real>& law,
              std::size_t link) const noexcept;

 private:
  struct Term {
    int slot;
    int module;
    int component;
    int slow_section;
    bool is_tap;
    bool opens_module;  // first term of the link on this module
    Real weight[3];
  };
  struct Link {
    bool euclidean;
    bool sticks;
    int dimensions;
    Real share;
    std::size_t first;
    std::size_t count;
    Real offset[3];
  };
  using Motion = EnergyStableMotion<Real>;
  using Module = EnergyStableModule<Real>;
  /// Links that share masses, kept where one of them, the root, stands.
  struct Cluster {
    std::size_t parent = 0;  // towards the root
    Real before = Real(0);   // what the tanks of all held before this step
    Real left = Real(0);     // what they hold after it, with its heat
    Real credit = Real(0);   // of that, those that have something left
    Real alone = Real(0);    // work that the forces do by the motion without them
    Real part = Real(1);     // of all forces that the tanks can pay for
  };

  bool isFree(const EnergyStableView<Real>& view, const Term& term) const noexcept;
  void measure(const EnergyStableView<Real>& view,
               const EnergyStableLaw<Real>& law,
               const Link& link,
               EnergyStableState<Real>& state,
               Motion& m) const noexcept;
  void place(const EnergyStableView<Real>& view,
             const EnergyStableLaw<Real>& law,
             const Link& link,
             Motion& motion) const noexcept;
  /// How far end a moves against end b: in the step just made, in the one to come if nothing
  /// energy-stable pushes, and the part of both by modules that forces do not move.
  struct Course {
    Real now[3] = {Real(0), Real(0), Real(0)};
    Real next[3] = {Real(0), Real(0), Real(0)};
    Real fixed_now[3] = {Real(0), Real(0), Real(0)};
    Real fixed_next[3] = {Real(0), Real(0), Real(0)};
  };
  Course courseOf(const EnergyStableView<Real>& view, const Link& link) const noexcept;
  /// \return how far end a moves against end b along the link in the step just made
  Real measureScalar(const EnergyStableView<Real>& view,
                     const EnergyStableLaw<Real>& law,
                     const Link& link,
                     EnergyStableState<Real>& state,
                     Motion& m) const noexcept;
  Real measureSpatial(const EnergyStableView<Real>& view,
                      const EnergyStableLaw<Real>& law,
                      const Link& link,
                      EnergyStableState<Real>& state,
                      Motion& m) const noexcept;
  void countActive(const EnergyStableView<Real>& view,
                   const Link& link,
                   const Motion& m,
                   Real last) noexcept;
  void yieldOf(const EnergyStableView<Real>& view, const Link& link, Motion& m) const noexcept;
  void expectOthers(const EnergyStableView<Real>& view,
                    const Link& link,
                    bool is_contact,
                    Real last,
                    Motion& m) const noexcept;
  void load(const Link& link, const Motion& m) noexcept;
  void exertOthers(const NearLinks<Real>& near,
                   const EnergyStableView<Real>& view,
                   const EnergyStableLaw<Real>* laws,
                   EnergyStableState<Real>* states) noexcept;
  void rub(const EnergyStableView<Real>& view,
           const EnergyStableLaw<Real>& law,
           const Pressure<Real>& pressed,
           const Link& link,
           Motion& m,
           EnergyStableState<Real>& state) noexcept;
  Slide<Real> slideOf(const EnergyStableView<Real>& view,
                      const Pressure<Real>& pressed,
                      const Link& link,
                      Motion& m,
                      EnergyStableState<Real>& state) const noexcept;
  template <class Visit>
  void visitShares(const EnergyStableView<Real>& view,
                   const Link& link,
                   const Motion& m,
                   const Visit& visit) noexcept;
  void closeRub(const EnergyStableView<Real>& view,
                const Link& link,
                const Motion& m,
                EnergyStableState<Real>& state) noexcept;
  static Real leverOf(const Term& term, const Motion& m) noexcept;
  void correctCharge(const EnergyStableView<Real>& view,
                     const Link& link,
                     Motion& m,
                     EnergyStableState<Real>& state) const noexcept;
  std::size_t rootOf(std::size_t link) noexcept;
  void joinThoseThatShare(const NearLinks<Real>& near, const EnergyStableView<Real>& view) noexcept;
  void settleDebts(const NearLinks<Real>& near,
                   const EnergyStableView<Real>& view,
                   EnergyStableState<Real>* states) noexcept;
  void weaken(const Link& link, Real part, Motion& m, EnergyStableState<Real>& state) noexcept;

  std::vector<Link> links_;
  std::vector<std::size_t> sticking_;
  std::vector<Term> terms_;
  std::vector<Motion> motions_;
  std::vector<Cluster> clusters_;  // [links]
  std::vector<Module>& modules_;
};

extern template class EnergyStableLinks<float>;
extern template class EnergyStableLinks<double>;

}  // namespace ergotic::physics
