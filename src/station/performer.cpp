// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/station/performer.hpp"

#include <memory>
#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/physics/certificate/precision.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/scene.hpp"
#include "ergotic/station/measure_load.hpp"

namespace ergotic::station {
namespace {

MotionFrame emptyMotion(const physics::Instrument& instrument) {
  MotionFrame frame;
  frame.displacement.resize(static_cast<std::size_t>(instrument.scene().coordinates()));
  frame.energies = instrument.makeEnergies();
  frame.tanks = instrument.makeTankReports();
  return frame;
}

std::size_t samplesOf(const physics::Instrument& instrument, int channels) {
  return static_cast<std::size_t>(instrument.rates().ratio) * static_cast<std::size_t>(channels);
}

bool isAllowed(physics::Verdict verdict, const PerformerPolicy& policy) {
  switch (verdict) {
    case physics::Verdict::kPassive:
    case physics::Verdict::kBounded:
      return true;
    case physics::Verdict::kUnproven:
      return policy.allow_unproven || policy.allow_unstable;
    case physics::Verdict::kUnstable:
      return policy.allow_unstable;
  }
  return false;
}

[[noreturn]] void refuse(const scene::Scene& scene, const physics::Certificate& certificate) {
  std::string text = "scene '" + scene.name + "' is refused: " + toString(certificate.verdict);
  for (const std::string& finding : certificate.findings) {
    text += "\n" + finding;
  }
  throw RefusedScene(text, certificate.verdict);
}

/// Makes every page of the state resident; its content stays.
void warm(Performer& performer) {
  physics::Instrument& instrument = *performer.instrument;
  instrument.saveState(performer.initial.data());
  instrument.loadState(performer.initial.data());
  performer.publishMotion(0);
}

/// \throws Exception if its ticks would come late
void requireLight(Performer& performer, double max_load) {
  const double load = measureLoad(performer);
  if (load > max_load) {
    throw Exception(describeLoad(*performer.instrument, load, max_load));
  }
}

}  // namespace

Performer::Performer(std::unique_ptr<physics::Instrument> made, std::unique_ptr<tgr::Rig> between)
    : instrument(std::move(made)),
      rig(std::move(between)),
      positions(instrument->scene().ports.size()),
      forces(instrument->scene().ports.size()),
      inputs(samplesOf(*instrument, instrument->inputChannels())),
      outputs(samplesOf(*instrument, instrument->outputChannels())),
      motion(emptyMotion(*instrument)),
      initial(instrument->stateSize()) {
  instrument->saveState(initial.data());
  for (const scene::Parameter& parameter : instrument->scene().parameters) {
    parameters.push_back(parameter.value);
  }
}

void Performer::restart() noexcept {
  instrument->loadState(initial.data());
  ticks = 0;
}

void Performer::publishMotion(std::int64_t tick) noexcept {
  MotionFrame& frame = motion.draft();
  frame.tick = tick;
  instrument->readDisplacements(frame.displacement.data());
  instrument->readEnergies(frame.energies);
  instrument->readTanks(frame.tanks);
  motion.publish();
}

std::unique_ptr<Performer> makePerformer(scene::Scene scene,
                                         const physics::Rates& rates,
                                         const physics::CompileOptions& options,
                                         const PerformerPolicy& policy) {
  const auto tell = [&, all = scene.mats.size() + scene.lias.size()](const char* stage) {
    if (policy.on_stage) {
      policy.on_stage(std::string(stage) + " " + std::to_string(all) + " modules and links");
    }
  };
  tell("validate and settle");
  scene::validate(scene);
  auto rig = tgr::makeRig(scene, policy.end_effectors, policy.slices);
  physics::Settled settled = physics::settle(std::move(scene), rates);
  const std::vector<std::string> warnings = settled.scene.warnings;
  tell("certify");
  physics::DeviceTraits device = policy.device;
  device.taken_ports = tgr::takenPorts(settled.scene, policy.end_effectors);
  const physics::CompileOptions compile = physics::withPrecision(options, settled.scene);
  physics::Certificate certificate =
      inPrecision(physics::certify(settled.scene, rates, device), settled.scene, compile);
  if (!isAllowed(certificate.verdict, policy)) {
    refuse(settled.scene, certificate);
  }
  tell("compile");
  auto performer = std::make_unique<Performer>(
      physics::compile(std::make_shared<const scene::Scene>(std::move(settled.scene)), rates,
                       compile),
      std::move(rig));
  performer->warnings = warnings;
  const auto warn = [&](const std::vector<std::string>& said) {
    performer->warnings.insert(performer->warnings.end(), said.begin(), said.end());
  };
  warn(certificate.findings);
  warn(settled.notes);
  warn(performer->instrument->notes());
  performer->certificate = std::move(certificate);
  performer->allow_unproven = policy.allow_unproven || policy.allow_unstable;
  warm(*performer);
  if (policy.max_load > 0.0) {
    tell("measure");
    requireLight(*performer, policy.max_load);
  }
  return performer;
}

}  // namespace ergotic::station
