// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/physics/engine/energy.hpp"
#include "ergotic/physics/options.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/physics/state/coefficients.hpp"
#include "ergotic/physics/state/state_entry.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// A hand that holds a module over a tick, wherever that is: a spring and a damper between the
/// module and where the hand wants it to be, on a straight line from the beginning of the tick to
/// its end. Places are displacements from rest, m, in the coordinates of Instrument's
/// `readDisplacements`.
struct Touch {
  static constexpr int kNothing = -1;

  int mat = kNothing;  ///< below Instrument::touchables(). \pre canTouch of it
  bool takes_hold =
      false;  ///< it wants the module to be where that is now, over this tick; cleared
  std::array<double, 3> from{};   ///< overwritten if it takes hold
  std::array<double, 3> to{};     ///< as `from`
  double stiffness = 0.0;         ///< N/m
  double damping = 0.0;           ///< N s/m
  double most_force = 0.0;        ///< N, of spring and damper together
  std::array<double, 3> force{};  ///< N, on the module in the last frame; overwritten
};
constexpr std::size_t kMaxTouches = 4;

/// Inputs and outputs of one tick. All arrays belong to the caller; R frames, frame-major.
struct TickIo {
  const double* positions = nullptr;  ///< [ports] slice positions, m, in the model
  double* forces = nullptr;           ///< [ports] force on each slice, N, overwritten
  const double* inputs = nullptr;     ///< [R][input channels]
  double* outputs = nullptr;          ///< [R][output channels], overwritten
  Touch* touches = nullptr;           ///< [kMaxTouches] null: none
};

/// The instrument: flat arrays and one `tick`.
///
/// A tick of index n (CORDIS-ANIMA): slices take their positions x[n]; each audio frame
/// r = 0...R-1 then
///   1. inputs arrive, masses of the sections due move (x += d, by the forces of their last step),
///      connection points follow them,
///   2. outputs are taken,
///   3. explicit links of the sections due give forces from the new positions, points hand theirs
///      on, then hands that hold modules, then energy-stable links, which need to know all other
///      forces.
/// Parts that do not need each other at the same instant go through all R frames by themselves
/// (docs/performance.md, "Groups and threads").
/// The forces on the slices after the last frame are F[n], a function of x[n]: they wait for the
/// next exchange with the device. Links across two rates run at the faster one, the slower end is
/// held and receives the mean force (docs/physics/multirate.md, "Coupling of two rates").
class Instrument {
 public:
  virtual ~Instrument() = default;

  /// Realtime: yes. Cost: O(modules * R), shared by CompileOptions::threads.
  virtual void tick(const TickIo& io) noexcept = 0;

  /// Ticks that gave no force and no sound because another thread did not finish its share within
  /// CompileOptions::wait_limit_ns. Realtime: yes.
  virtual std::int64_t stalledTicks() const noexcept { return 0; }
  /// True after a tick that stalled, until a later one finds the share finished and goes on from
  /// there. In between nothing is read: `isFinite` is true, the other `read` functions leave `to`
  /// alone, the state must not be saved or loaded, and `exchange` hands back what it got.
  /// Realtime: yes.
  virtual bool isUnderWay() const noexcept { return false; }
  /// Ends such a tick if all shares of it are done. \return false if it is still under way.
  /// Realtime: yes.
  virtual bool finish() noexcept { return true; }

  /// Coefficients for these parameter values (one per Scene::parameters).
  /// Realtime: no.
  /// \throws Exception if a value is outside its range, naming parameter, value and range
  virtual std::unique_ptr<Coefficients> prepare(const std::vector<double>& values) const = 0;

  /// Takes other coefficients from the next tick on, gives back those used so far. What the change
  /// does to the stored energy is counted as work of the parameters.
  /// Realtime: yes. Cost: O(modules + links). \pre made by `prepare` of this instrument
  virtual std::unique_ptr<Coefficients> exchange(std::unique_ptr<Coefficients> next) noexcept = 0;

  /// The whole mutable state is one block of `stateSize()` bytes, described by `stateEntries()`.
  virtual std::size_t stateSize() const noexcept = 0;
  virtual std::vector<StateEntry> stateEntries() const = 0;
  /// Realtime: yes.
  virtual void saveState(void* to) const noexcept = 0;
  /// Realtime: yes. \pre saved by an instrument compiled from the same scene, rates and precision
  virtual void loadState(const void* from) noexcept = 0;

  /// Modules of the scene, and behind them the places of its outlines, one after the other: what
  /// `Touch::mat` may name. Realtime: yes.
  int touchables() const noexcept { return touchables_; }
  /// Whether a hand can hold a module: one that moves by itself, no slice, ground or point; and of
  /// bodies that are played by their modes the places of the outline.
  /// Realtime: yes. \pre 0 <= mat < touchables()
  virtual bool canTouch(int /*mat*/) const noexcept { return false; }

  /// Displacement from rest of every module, m, in the order of Scene::mats: as many numbers for
  /// each as its section has coordinates that move (Scene::coordinates in all).
  /// Realtime: yes.
  virtual void readDisplacements(float* to) const noexcept = 0;

  /// Room for `readEnergies` and `readTanks`. Realtime: no.
  virtual Energies makeEnergies() const = 0;
  virtual std::vector<TankReport> makeTankReports() const = 0;
  /// \pre made by the above. Realtime: yes. Cost: O(modules + links)
  virtual void readEnergies(Energies& to) const noexcept = 0;
  virtual void readTanks(std::vector<TankReport>& to) const noexcept = 0;

  /// Choices of compile() for each part of the scene, with reasons, one line each. Realtime: no.
  virtual std::vector<std::string> describe() const = 0;
  /// Those of these lines that a player should see, as Settled::notes: choices that the scene left
  /// open, with the error they are predicted to make. Realtime: no.
  virtual std::vector<std::string> notes() const { return {}; }

  /// True if every displacement, and what every energy-stable link may spend, is a finite number.
  /// Realtime: yes. Cost: O(modules + links)
  virtual bool isFinite() const noexcept = 0;

  const scene::Scene& scene() const noexcept { return *scene_; }
  const Rates& rates() const noexcept { return rates_; }
  const CompileOptions& options() const noexcept { return options_; }
  Precision precision() const noexcept { return options_.precision; }
  int ports() const noexcept { return static_cast<int>(scene_->ports.size()); }
  int inputChannels() const noexcept { return input_channels_; }
  int outputChannels() const noexcept { return output_channels_; }

 protected:
  Instrument(std::shared_ptr<const scene::Scene> scene,
             const Rates& rates,
             const CompileOptions& options)
      : scene_(std::move(scene)),
        rates_(rates),
        options_(options),
        input_channels_(scene_->inputChannels()),
        output_channels_(scene_->outputChannels()),
        touchables_(static_cast<int>(scene_->mats.size())) {
    for (const scene::Outline& outline : scene_->outlines) {
      touchables_ += static_cast<int>(outline.rest.size());
    }
  }

 private:
  std::shared_ptr<const scene::Scene> scene_;
  Rates rates_;
  CompileOptions options_;
  int input_channels_;
  int output_channels_;
  int touchables_;
};

/// Turns a valid scene into arrays. Does not certify. The instrument shares the scene; one that is
/// given by reference is copied.
/// \pre    settled (settle.hpp)
/// \throws Exception if the scene needs something that these rates do not allow
std::unique_ptr<Instrument> compile(std::shared_ptr<const scene::Scene> scene,
                                    const Rates& rates,
                                    const CompileOptions& options);
std::unique_ptr<Instrument> compile(const scene::Scene& scene,
                                    const Rates& rates,
                                    const CompileOptions& options);

}  // namespace ergotic::physics
