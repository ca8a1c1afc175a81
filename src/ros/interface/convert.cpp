// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/convert.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

#include "ergotic/station/health.hpp"
#include "ros/device/end_effectors.hpp"
#include "ros/interface/model_loader.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::node {
namespace {

using EventType = station::Event::Type;

constexpr std::size_t kMaxCuts = 100;  // links named; a generator makes many

// Messages carry the numbers of our enumerations.
template <class T>
constexpr std::uint8_t number(T value) {
  return static_cast<std::uint8_t>(value);
}
static_assert(ModelStructure::POINT == number(scene::MatType::kPoint));
static_assert(Event::FAULT == number(EventType::kFault));
static_assert(Event::AUDIO_STOPPED == number(EventType::kAudioStopped));
static_assert(Event::CONFIGURED == number(EventType::kConfigured));
static_assert(Event::RECOVERED == number(EventType::kRecovered));
static_assert(Event::REFUSED == number(EventType::kRefused));
static_assert(Event::INJECTED == number(EventType::kInjected));

using station::ForceState;
static_assert(Status::DISCONNECTED == number(ForceState::kDisconnected));
static_assert(Status::UNCALIBRATED == number(ForceState::kUncalibrated));
static_assert(Status::READY == number(ForceState::kReady));
static_assert(Status::ENGAGING == number(ForceState::kEngaging));
static_assert(Status::PLAYING == number(ForceState::kPlaying));
static_assert(Status::FAULT == number(ForceState::kFault));

using tgr::FaultReason;
static_assert(Status::FAULT_NONE == number(FaultReason::kNone));
static_assert(Status::FAULT_DEVICE_LOST == number(FaultReason::kDeviceLost));
static_assert(Status::FAULT_MISSING_SAMPLES == number(FaultReason::kMissingSamples));
static_assert(Status::FAULT_BAD_POSITION == number(FaultReason::kBadPosition));
static_assert(Status::FAULT_MODEL_BLOW_UP == number(FaultReason::kModelBlowUp));
static_assert(Status::FAULT_STALL == number(FaultReason::kStall));
static_assert(Status::FAULT_MADE_SAFE == number(FaultReason::kMadeSafe));
static_assert(Status::FAULT_JUMP == number(FaultReason::kJump));
static_assert(Status::FAULT_FROZEN == number(FaultReason::kFrozen));
static_assert(Status::FAULT_WRITE_FAILED == number(FaultReason::kWriteFailed));
static_assert(Status::FAULT_FORCE_TOO_HIGH == number(FaultReason::kForceTooHigh));
static_assert(Status::FAULT_ENERGY == number(FaultReason::kEnergy));
static_assert(Status::FAULT_EMERGENCY_STOP == number(FaultReason::kEmergencyStop));
static_assert(Status::FAULT_PRESENCE == number(FaultReason::kPresence));
static_assert(Status::FAULT_WORKSPACE == number(FaultReason::kWorkspace));
static_assert(Status::FAULT_WATCHDOG == number(FaultReason::kWatchdog));
static_assert(Status::FAULT_MASTER_LOST == number(FaultReason::kMasterLost));

const char* toString(station::LateCause cause) {
  switch (cause) {
    case station::LateCause::kWakeUp:
      return "the thread was woken late";
    case station::LateCause::kDevice:
      return "the device was slow";
    case station::LateCause::kCompute:
      return "the computation took too long";
  }
  return "";
}

std::string textOf(const station::Event& event, const scene::Scene* scene) {
  std::ostringstream text;
  const auto milliseconds = [](double seconds) { return seconds * 1e3; };
  switch (event.type) {
    case EventType::kEngaged:
      text << "force ramps in over " << event.value << " s";
      break;
    case EventType::kPlaying:
      text << "full force";
      break;
    case EventType::kStopped:
      text << "force is zero";
      break;
    case EventType::kSwapped:
      text << (event.index != 0 ? "another model plays"
                                : "a model was discarded, as a newer one was loaded")
           << (event.value != 0.0 ? ", force is zero until engage" : "");
      break;
    case EventType::kParameter: {
      const auto index = static_cast<std::size_t>(event.index);
      const bool plays = event.frame >= 0;  // else it is of a model that `scene` is not
      const bool known = plays && scene != nullptr && index < scene->parameters.size();
      text << (known ? scene->parameters[index].name : "parameter " + std::to_string(index))
           << (plays ? "" : " of the model that comes next") << " = " << event.value;
      break;
    }
    case EventType::kKeyframe:
      text << (event.index != 0 ? "keyframe" : "the state is too large for a keyframe");
      break;
    case EventType::kFault:
      text << "force latched at zero: ";
      if (static_cast<station::FaultReason>(event.index) == station::FaultReason::kStall) {
        text << station::explainStall(event.value, event.id);
        break;
      }
      text << toString(static_cast<station::FaultReason>(event.index));
      if (event.value >= 0.0) {
        text << ", slice " << event.value;
      }
      break;
    case EventType::kLateTick:
      text << "tick " << milliseconds(event.value)
           << " ms late: " << toString(static_cast<station::LateCause>(event.index));
      break;
    case EventType::kStall:
      text << "stall of " << milliseconds(event.value) << " ms, " << event.index
           << " ticks caught up";
      break;
    case EventType::kTicksLost:
      text << event.index << " ticks never ran";
      break;
    case EventType::kUnderrun:
      text << "underrun: " << event.index << " frames of silence from frame " << event.frame;
      break;
    case EventType::kAudioSkipped:
      text << "JACK skipped " << event.index << " frames from frame " << event.frame;
      break;
    case EventType::kAudioStarted:
      text << "sound from frame " << event.frame;
      break;
    case EventType::kAudioStopped:
      text << "no sound: the audio server is gone";
      break;
    case EventType::kConfigured:
      text << "other end-effectors are in place";
      break;
    case EventType::kRecovered:
      text << "recovered" << (event.index != 0 ? ", the model began anew" : "");
      break;
    case EventType::kRefused:
      text << toString(static_cast<station::Refusal>(event.index));
      break;
    case EventType::kInjected:
      text << "a fault is made on purpose, for " << event.value << " ticks";
      break;
    case EventType::kHold:  // has a message of its own
      break;
  }
  return text.str();
}

void addSections(const scene::Scene& scene, const physics::Rates& rates, ModelStructure& message) {
  for (const scene::Section& section : scene.sections) {
    message.section_names.push_back(section.name);
    message.section_rates.push_back(rates.audio_hz / physics::divisorOf(section, rates));
    message.section_poses.push_back(toPose(section.pose));
    message.section_dimensions.push_back(
        static_cast<std::uint8_t>(scene::dimensionsOf(section.geometry)));
  }
}

geometry_msgs::Point toPoint(const Eigen::Vector3d& place) {
  geometry_msgs::Point point;
  point.x = place.x();
  point.y = place.y();
  point.z = place.z();
  return point;
}

}  // namespace

ModelStructure toModelStructure(const scene::Scene& scene, const physics::Rates& rates) {
  ModelStructure message;
  message.name = scene.name;
  message.scene_hash = textHash(scene.text);
  addSections(scene, rates, message);
  for (const scene::Mat& mat : scene.mats) {
    message.module_names.push_back(mat.name);
    message.module_types.push_back(number(mat.type));
    message.module_sections.push_back(static_cast<std::uint32_t>(mat.section));
    const Eigen::Vector3f rest = (scene.sectionOf(mat).pose * mat.rest).cast<float>();
    message.rest_positions.insert(message.rest_positions.end(), rest.data(), rest.data() + 3);
  }
  for (std::size_t law = 0; law < scene::kLiaTypes; ++law) {
    message.law_names.emplace_back(scene::lawOf(static_cast<scene::LiaType>(law)).name);
  }
  for (const scene::Lia& lia : scene.lias) {
    message.links.push_back(static_cast<std::uint32_t>(lia.a));
    message.links.push_back(static_cast<std::uint32_t>(lia.b));
    message.link_types.push_back(number(lia.type));
  }
  if (scene.about.picture) {
    message.camera = {toPoint(scene.about.picture->from), toPoint(scene.about.picture->at)};
  }
  for (const scene::StringInfo& string : scene.strings) {
    message.string_names.push_back(string.name);
    message.string_first.push_back(static_cast<std::uint32_t>(string.first));
    message.string_count.push_back(static_cast<std::uint32_t>(string.count));
  }
  return message;
}

std::shared_ptr<Picture> toPicture(const physics::Instrument& instrument, double zoom) {
  const scene::Scene& scene = instrument.scene();
  const auto show = [&](const scene::Scene& drawn) {
    return std::make_shared<Picture>(Picture{toModelStructure(drawn, instrument.rates()),
                                             Markers(drawn, zoom), Outlines(scene)});
  };
  return scene.outlines.empty() ? show(scene) : show(Outlines::addTo(scene));  // a copy is large
}

ParametersMessage toParameters(const scene::Scene& scene, const std::vector<double>& values) {
  ParametersMessage message;
  for (const scene::Parameter& parameter : scene.parameters) {
    message.names.push_back(parameter.name);
    message.lows.push_back(parameter.minimum);
    message.highs.push_back(parameter.maximum);
    message.defaults.push_back(parameter.value);
    message.units.push_back(parameter.unit);
  }
  message.values = values;
  return message;
}

Event toEvent(const station::Event& event, const scene::Scene* scene) {
  Event message;
  message.tick = event.tick;
  message.type = number(event.type);
  message.text = textOf(event, scene);
  message.index = event.index;
  message.value = event.value;
  message.frame = event.frame;
  return message;
}

namespace {

/// Name of a module, or of a point of the outlines, which follow the modules.
std::string nameOfModule(const scene::Scene& scene, std::size_t module) {
  if (module < scene.mats.size()) {
    return scene.mats[module].name;
  }
  module -= scene.mats.size();
  for (const scene::Outline& outline : scene.outlines) {
    if (module < outline.rest.size()) {
      return Outlines::nameOf(outline, module);
    }
    module -= outline.rest.size();
  }
  return "";
}

}  // namespace

Hold toHold(const station::Event& event, const scene::Scene& scene) {
  const station::Hold& hold = event.hold;
  Hold message;
  message.tick = event.tick;
  message.hand = static_cast<std::uint8_t>(event.index);
  message.module = hold.mat;
  message.name = hold.mat < 0 ? "" : nameOfModule(scene, static_cast<std::size_t>(hold.mat));
  message.takes_hold = hold.takes_hold ? 1U : 0U;
  std::copy(hold.at.begin(), hold.at.end(), message.at.begin());
  std::copy(hold.goal.begin(), hold.goal.end(), message.goal.begin());
  message.ticks_left = hold.ticks_left;
  message.stiffness = hold.stiffness;
  message.damping = hold.damping;
  message.most_force = hold.most_force;
  return message;
}

sensor_msgs::JointState toJointState(const station::Snapshot& snapshot) {
  sensor_msgs::JointState message;
  for (std::size_t i = 0; i < static_cast<std::size_t>(snapshot.slices); ++i) {
    message.name.push_back("slice_" + std::to_string(i));
    message.position.push_back(snapshot.slice_position[i]);
    message.velocity.push_back(snapshot.slice_velocity[i]);
    message.effort.push_back(snapshot.slice_force[i]);
  }
  return message;
}

void fillStatus(station::ForceState state, tgr::FaultReason fault, Status& status) {
  status.state = number(state);
  status.fault = number(fault);
  status.state_text = station::toString(state);
  if (fault != tgr::FaultReason::kNone) {
    status.state_text += std::string(": ") + toString(fault);
  }
}

void fillStatus(const station::Snapshot& snapshot, Status& status) {
  const station::Counters& counters = snapshot.counters;
  fillStatus(snapshot.state, snapshot.fault, status);
  if (snapshot.fault == tgr::FaultReason::kStall) {
    status.state_text = station::toString(snapshot.state) + std::string(": ") +
                        station::explainStall(snapshot.stall_s, snapshot.stalls_borne);
  }
  status.slices = static_cast<std::uint32_t>(snapshot.slices);
  status.audio_running = snapshot.audio_running;
  status.clock_locked = snapshot.clock_locked;
  status.ticks = counters.ticks;
  status.late_wake_up = counters.late_wake_up;
  status.late_device = counters.late_device;
  status.late_compute = counters.late_compute;
  status.stalls = counters.stalls;
  status.catch_up_ticks = counters.catch_up_ticks;
  status.lost_ticks = counters.lost_ticks;
  status.underruns = counters.underruns;
  status.underrun_frames = counters.underrun_frames;
  status.xruns = counters.xruns;
  status.bad_input_samples = counters.bad_input_samples;
  status.dropped_records = counters.dropped_records;
  status.load_mean = counters.load_mean;
  status.load_peak = counters.load_peak;
  status.late_worst = counters.late_worst_s;
  status.peak_force = counters.peak_force_n;
  status.peak_raw_force = counters.peak_raw_force_n;
  status.port_energy_min = counters.port_energy_min_j;
  status.clamped_ticks = counters.clamped_ticks;
  status.muted_ticks = counters.muted_ticks;
}

void fillStatus(std::uint64_t uncalibrated, Status& status) {
  status.uncalibrated.clear();
  for (std::uint32_t slice = 0; slice < std::uint32_t{tgr::kMaxSlices}; ++slice) {
    if ((uncalibrated >> slice & 1U) != 0) {
      status.uncalibrated.push_back(slice);
    }
  }
}

void fillStatus(const physics::Instrument& instrument, Status& status) {
  const scene::Scene& scene = instrument.scene();
  status.model = scene.name;
  status.audio_rate = instrument.rates().audio_hz;
  status.gestural_rate = instrument.rates().gesturalHz();
  status.ratio = static_cast<std::uint32_t>(instrument.rates().ratio);
  status.precision = nameOf(instrument.precision());
  status.isa = nameOf(instrument.options().isa);
  status.threads = static_cast<std::uint32_t>(instrument.options().threads);
  status.metered = instrument.options().metered;
  status.modules = static_cast<std::uint32_t>(scene.mats.size());
  status.links = static_cast<std::uint32_t>(scene.lias.size());
}

void fillStatus(const station::MotionFrame& motion, const scene::Scene& scene, Status& status) {
  status.stored_energy = motion.energies.stored;
  status.energy_residual = station::relativeResidual(motion.energies);
  if (std::none_of(motion.tanks.begin(), motion.tanks.end(), station::isCutTooOften)) {
    status.guard_warning.clear();
  } else if (status.guard_warning.empty()) {  // one is enough, and costs a look at the whole scene
    const std::vector<std::string> warnings = station::tankWarnings(
        scene, {status.audio_rate, static_cast<int>(status.ratio)}, motion.tanks);
    status.guard_warning = warnings.empty() ? "" : warnings.front();
  }
}

ModelEnergy toModelEnergy(const station::MotionFrame& motion) {
  ModelEnergy message;
  message.tick = motion.tick;
  message.stored = motion.energies.stored;
  message.from_parameters = motion.energies.from_parameters;
  message.residual = motion.energies.residual;
  for (const physics::SectionEnergy& section : motion.energies.sections) {
    message.kinetic.push_back(section.kinetic);
    message.potential.push_back(section.potential);
    message.dissipated.push_back(section.dissipated);
    message.from_device.push_back(section.from_device);
    message.from_inputs.push_back(section.from_inputs);
    message.from_links.push_back(section.from_links);
  }
  for (const physics::CouplingEnergy& coupling : motion.energies.couplings) {
    message.couplings.push_back(static_cast<std::uint32_t>(coupling.section_a));
    message.couplings.push_back(static_cast<std::uint32_t>(coupling.section_b));
    message.coupling_stored.push_back(coupling.stored);
    message.coupling_dissipated.push_back(coupling.dissipated);
    message.coupling_made.push_back(coupling.made);
  }
  return message;
}

Cuts toCuts(const station::MotionFrame& motion, const scene::Scene& scene) {
  std::vector<physics::TankReport> cut;
  std::copy_if(motion.tanks.begin(), motion.tanks.end(), std::back_inserter(cut),
               [](const physics::TankReport& tank) { return tank.clipped > 0; });
  std::stable_sort(cut.begin(), cut.end(),
                   [](const auto& a, const auto& b) { return a.clipped > b.clipped; });
  cut.resize(std::min(cut.size(), kMaxCuts));
  Cuts message;
  for (const physics::TankReport& tank : cut) {
    message.links.push_back(scene.lias[static_cast<std::size_t>(tank.lia)].name);
    message.active.push_back(tank.active);
    message.cut.push_back(tank.clipped);
  }
  return message;
}

Keyframe toKeyframe(const station::Keyframe& keyframe,
                    const physics::Instrument& instrument,
                    std::uint32_t slices) {
  const scene::Scene& scene = instrument.scene();
  Keyframe message;
  message.tick = keyframe.tick;
  message.scene = scene.text;
  message.scene_name = scene.file;
  message.scene_hash = textHash(scene.text);
  message.audio_rate = instrument.rates().audio_hz;
  message.ratio = static_cast<std::uint32_t>(instrument.rates().ratio);
  message.precision = nameOf(instrument.precision());
  message.isa = nameOf(instrument.options().isa);
  message.threads = static_cast<std::uint32_t>(instrument.options().threads);
  message.metered = instrument.options().metered;
  message.slices = slices;
  message.state = keyframe.state;
  for (const scene::Parameter& parameter : scene.parameters) {
    message.parameter_names.push_back(parameter.name);
  }
  message.parameter_values = keyframe.parameters;
  return message;
}

}  // namespace ergotic::node
