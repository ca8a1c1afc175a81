// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "ergotic/physics/engine/energy.hpp"
#include "physics/layout/groups.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// Keeps the energy accounts. Links count their own work while they step (link_kernels.hpp); this
/// adds what comes in through slices, driven modules, force inputs and moving places, and works the
/// balance out from positions. Unmetered it counts nothing, and knows what positions alone say.
/// Source: docs/physics/accuracy.md, "Energy accounting".
template <class Real>
class EnergyMeter {
 public:
  /// Adds its entries to the arena. \pre the arena is not allocated
  EnergyMeter(const scene::Scene& scene, const Layout& layout, State<Real>& state);

  /// Counts what a section's own modules dissipated in a step, or lost by falling asleep.
  void addDissipated(int section, double energy, State<Real>& state) const noexcept;

  /// Counts the force of an input in this frame. `k`: index in Layout::feeds
  void addFeed(std::size_t k, Real force, State<Real>& state) const noexcept {
    if (state.isMetered()) {
      state.arena().template at<Feeding>(feeds_at_)[k].mean += force;
    }
  }

  /// Counts the work of a hand that holds a module, in the scene's unit.
  void addTouch(int section, double work, State<Real>& state) const noexcept {
    if (state.isMetered()) {
      state.arena().template at<SectionAccount>(accounts_at_)[section].from_inputs += work;
    }
  }

  /// Counts such work of a step to come: balances before that step leave it out.
  void addAhead(int section, double work, State<Real>& state) noexcept {
    addTouch(section, work, state);
    ahead_[static_cast<std::size_t>(section)] += work;
  }
  void forgetAhead() noexcept { std::fill(ahead_.begin(), ahead_.end(), 0.0); }

  /// Closes the energy accounts of the sections of a group whose steps end with this frame.
  void endFrame(const Group& group, std::int64_t now, State<Real>& state) const noexcept;

  /// The balance is counted from here on.
  void start(const CoefficientsOf<Real>& c, State<Real>& state) noexcept;

  /// Counts the change of energy between the two calls as work of the parameters. Call beginChange
  /// before the first and endChange after the last frame that mixes forces of old and new
  /// coefficients.
  void beginChange(const CoefficientsOf<Real>& c, State<Real>& state) noexcept;
  void endChange(const CoefficientsOf<Real>& c, State<Real>& state) noexcept;

  /// Room for `read`. Realtime: no.
  Energies make() const;
  void read(const CoefficientsOf<Real>& c, const State<Real>& state, Energies& to) const noexcept;

  /// Kinetic and potential energy of a section and its links, in the scene's unit.
  double storedIn(int section,
                  const CoefficientsOf<Real>& c,
                  const State<Real>& state) const noexcept;

 private:
  struct SectionAccount {
    double dissipated;
    double from_device;
    double from_inputs;
    static constexpr std::size_t kDoubles = 3;  // here and below: see numbersOf
  };
  /// A force over one step of its section: the mean so far, and that of the step before.
  struct Feeding {
    Real mean;
    Real last;
    static constexpr std::size_t kDoubles = sizeof(Real) == sizeof(double) ? 2 : 0;
  };
  struct Totals {
    double reference;
    double from_parameters;
    double before_change;
    static constexpr std::size_t kDoubles = 3;
  };
  /// A coordinate that something moves: of a slice, or of a driven module.
  struct Forced {
    int slot;
    bool device;
  };
  struct Coupled {
    int a;
    int b;
  };
  enum class Source { kDevice, kInputs };
  static constexpr std::size_t kInside = static_cast<std::size_t>(-1);

  bool endsStep(int section, std::int64_t now) const noexcept {
    return (now + 1) % layout_.sections[static_cast<std::size_t>(section)].divisor == 0;
  }
  Totals& totals(State<Real>& state) const noexcept {
    return *state.arena().template at<Totals>(totals_at_);
  }
  /// Calls `add(section, source, moved under the force of this step, moved under that of the
  /// last, feeding, force of this step)` for all that moves modules of a group.
  template <class StateType, class Add>
  void forEachSource(const Group& group, StateType& state, const Add& add) const noexcept;
  void addWorkOfInterpolatedSlices(const Group& group,
                                   std::int64_t now,
                                   State<Real>& state) const noexcept;
  void collectPointForces(const Group& group, State<Real>& state) const noexcept;

  double storedIn(std::size_t run,
                  const CoefficientsOf<Real>& c,
                  const State<Real>& state) const noexcept;
  LinkWork workOf(std::size_t run, const State<Real>& state) const noexcept;
  void addSections(const CoefficientsOf<Real>& c,
                   const State<Real>& state,
                   Energies& to) const noexcept;
  void addLinks(const CoefficientsOf<Real>& c,
                const State<Real>& state,
                Energies& to) const noexcept;
  void addSources(const State<Real>& state, Energies& to) const noexcept;
  double collect(const CoefficientsOf<Real>& c,
                 const State<Real>& state,
                 Energies& to) const noexcept;

  const Layout& layout_;
  double newton_;     // from the scene's units to joule
  Group everything_;  // sections and what moves modules
  std::vector<Forced> forced_;
  std::vector<std::vector<std::size_t>> forced_of_section_;
  std::vector<Coupled> couplings_;            // pairs of sections
  std::vector<std::size_t> coupling_of_run_;  // [runs] kInside: inside a section
  std::vector<bool> follows_positions_;       // [runs] what they store
  Energies scratch_;
  std::vector<double> ahead_;  // [sections] counted, but yet to be done
  std::size_t accounts_at_ = 0;
  std::size_t forced_at_ = 0;  // Feeding [forced]
  std::size_t feeds_at_ = 0;   // Feeding [feeds]
  std::size_t places_at_ = 0;  // Feeding [coordinates of places]
  std::size_t interpolated_work_at_ =
      0;  // work of their slices, double [coordinates of interpolated slices]
  std::size_t totals_at_ = 0;
};

extern template class EnergyMeter<float>;
extern template class EnergyMeter<double>;

}  // namespace ergotic::physics
