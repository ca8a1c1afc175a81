// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/engine/instrument.hpp"

#include <optional>

#include "at.hpp"
#include "ergotic/exception.hpp"
#include "physics/engine/instrument_of.hpp"
#include "physics/modes/modal_scene.hpp"
#include "physics/step_units.hpp"

namespace ergotic::physics {
namespace {

/// Modules start where the scene says, with the velocity that it says.
template <class Real>
void placeInitialState(const Rates& rates, Mechanism<Real>& mechanism) {
  const scene::Scene& scene = *mechanism.scene;
  for (std::size_t s = 0; s < mechanism.layout.sections.size(); ++s) {
    const SectionRange& range = mechanism.layout.sections[s];
    const StepUnits units(scene, rates, range.divisor);
    for (int slot = range.first; slot < range.end; ++slot) {
      if (mechanism.layout.mat_of_slot[at(slot)] < 0) {
        continue;
      }
      const scene::Mat& mat = scene.mats[at(mechanism.layout.mat_of_slot[at(slot)])];
      for (int k = 0; k < range.dimensions; ++k) {
        const int here = slot + k * range.stride;
        mechanism.state.x()[here] = static_cast<Real>(mat.position[k] - mat.rest[k]);
        if (slot < range.fixed && mat.type != scene::MatType::kGround) {
          mechanism.state.d()[here] = static_cast<Real>(units.velocity(mat.push->velocity[k]));
          mechanism.state.f()[here] = static_cast<Real>(mat.push->first_force[k]);
        }
      }
    }
  }
  mechanism.interpolation.placeAtStart(mechanism.state.x());
  mechanism.points.placeAtStart(*mechanism.coefficients, mechanism.state.x(), mechanism.state.d(),
                                mechanism.state.places());
  for (const Group& group : mechanism.groups.running) {
    fillProxies(group, mechanism.state);
  }
  for (std::size_t r = 0; mechanism.state.isMetered() && r < mechanism.layout.runs.size(); ++r) {
    if (remembers(mechanism.layout.runs[r]) && !mechanism.layout.runs[r].energy_stable) {
      mechanism.stepper.storeAtStart(r, mechanism.coefficients->runs[r], mechanism.state);
    }
  }
}

/// Compiles a scene into an instrument: every value is made once, from those before it.
template <class Real>
std::unique_ptr<Instrument> compileFor(std::shared_ptr<const scene::Scene> written,
                                       const Rates& rates,
                                       const CompileOptions& options) {
  std::vector<std::string> notes;
  std::optional<scene::Scene> modal = withModes(*written, rates, notes);
  const auto played = modal ? std::make_shared<const scene::Scene>(*std::move(modal)) : written;
  Layout layout = makeLayout(*played, rates);
  Groups groups = makeGroups(*played, rates, layout);
  auto coefficients = std::make_unique<CoefficientsOf<Real>>(*played, rates, layout);
  State<Real> state(layout, options.metered);
  auto mechanism = std::make_unique<Mechanism<Real>>(played, written->mats.size(), rates, options,
                                                     std::move(layout), std::move(groups),
                                                     std::move(coefficients), std::move(state));
  placeInitialState(rates, *mechanism);
  Picture picture(played, written->mats.size(), mechanism->layout);
  return std::make_unique<InstrumentOf<Real>>(std::move(written), rates, options,
                                              std::move(mechanism), std::move(picture),
                                              std::move(notes));
}

}  // namespace

scene::Scene withParameters(scene::Scene scene, const std::vector<double>& values) {
  if (values.size() != scene.parameters.size()) {
    throw Exception(std::to_string(values.size()) + " parameter values for a scene with " +
                    std::to_string(scene.parameters.size()));
  }
  for (std::size_t p = 0; p < values.size(); ++p) {
    scene::Parameter& parameter = scene.parameters[p];
    if (!(values[p] >= parameter.minimum && values[p] <= parameter.maximum)) {
      throw Exception("parameter '" + parameter.name + "': " + std::to_string(values[p]) +
                      " is outside its range " + std::to_string(parameter.minimum) + "..." +
                      std::to_string(parameter.maximum));
    }
    parameter.value = values[p];
  }
  return scene;
}

std::unique_ptr<Instrument> compile(std::shared_ptr<const scene::Scene> scene,
                                    const Rates& rates,
                                    const CompileOptions& options) {
  if (!scene::isSettled(*scene)) {
    throw Exception("scene '" + scene->name + "' is not settled: settle() comes before compile()");
  }
  if (options.threads < 1 || options.threads > kMaxThreads) {
    throw Exception("threads: " + std::to_string(options.threads) + ", allowed: 1..." +
                    std::to_string(kMaxThreads));
  }
  if (options.precision == Precision::kAuto) {
    throw Exception("precision: auto is to be chosen before compile(), by withPrecision()");
  }
  if (options.precision == Precision::kFloat) {
    return compileFor<float>(std::move(scene), rates, options);
  }
  return compileFor<double>(std::move(scene), rates, options);
}

std::unique_ptr<Instrument> compile(const scene::Scene& scene,
                                    const Rates& rates,
                                    const CompileOptions& options) {
  return compile(std::make_shared<const scene::Scene>(scene), rates, options);
}

}  // namespace ergotic::physics
