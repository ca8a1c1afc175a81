// SPDX-License-Identifier: BSD-3-Clause
#include "support/station_doubles.hpp"

#include <cstring>
#include <numeric>

#include "support/test.hpp"

namespace ergotic::test {
namespace {

scene::Scene sceneOf(const SpringInstrument::Setting& setting) {
  scene::Scene scene;
  scene.name = "spring";
  scene.sections.emplace_back();
  scene.mats.emplace_back();
  scene.mats[0].type = scene::MatType::kSlice;
  scene.ports.push_back(setting.port);
  scene.ports[0].name = "hand";
  scene.parameters.push_back({"stiffness", setting.stiffness, 0.0, 1e6, {}, {}});
  for (int c = 0; c < setting.outputs; ++c) {
    scene.outputs.emplace_back();
    scene.outputs.back().channel = c;
  }
  for (int c = 0; c < setting.inputs; ++c) {
    scene.inputs.emplace_back();
    scene.inputs.back().channel = c;
  }
  return scene;
}

}  // namespace

std::uint32_t ScriptedDriver::exchange(const double* forces, double* positions) noexcept {
  const std::int64_t n = log_.exchanges++;
  std::copy_n(forces, slices_, log_.forces.begin());
  if (watch) {
    watch(n, forces);
  }
  for (int s = 0; s < slices_; ++s) {
    positions[s] = position_(n, s);
  }
  const std::uint32_t safe = log_.safe.load() ? tgr::kMadeSafe : 0U;
  return safe | (flags_of ? flags_of(n) : 0U);
}

SpringInstrument::SpringInstrument(const Setting& setting)
    : Instrument(std::make_shared<const scene::Scene>(sceneOf(setting)),
                 {setting.audio_hz, setting.ratio},
                 physics::Precision::kDouble),
      setting_(setting),
      stiffness_(std::make_unique<Stiffness>()) {
  stiffness_->value = setting.stiffness;
}

SpringInstrument::~SpringInstrument() {
  if (setting_.destroyed != nullptr) {
    ++*setting_.destroyed;
  }
}

void SpringInstrument::tick(const physics::TickIo& io) noexcept {
  if (held_up) {
    io.forces[0] = 0.0;
    std::fill_n(io.outputs, rates().ratio * outputChannels(), 0.0);
    return;
  }
  const std::int64_t tick = frames_ / rates().ratio;
  io.forces[0] =
      tick == setting_.bad_force_at ? std::nan("") : -stiffness_->value * io.positions[0];
  const int in = rates().ratio * inputChannels();
  last_input = std::accumulate(io.inputs, io.inputs + in, 0.0);
  double* to = io.outputs;
  for (int r = 0; r < rates().ratio; ++r, ++frames_) {
    const double sample = setting_.count_frames ? static_cast<double>(frames_) : setting_.level;
    to = std::fill_n(to, outputChannels(), sample);
  }
  if (tick == setting_.bad_sample_at) {
    io.outputs[0] = std::numeric_limits<double>::infinity();
  }
}

std::unique_ptr<physics::Coefficients> SpringInstrument::prepare(
    const std::vector<double>& values) const {
  auto made = std::make_unique<Stiffness>();
  made->value = values.at(0);
  return made;
}

std::unique_ptr<physics::Coefficients> SpringInstrument::exchange(
    std::unique_ptr<physics::Coefficients> next) noexcept {
  if (held_up) {
    return next;
  }
  std::unique_ptr<physics::Coefficients> old(stiffness_.release());
  stiffness_.reset(static_cast<Stiffness*>(next.release()));
  return old;
}

std::vector<physics::StateEntry> SpringInstrument::stateEntries() const {
  return {{"frames", 0, sizeof(frames_)}};
}

void SpringInstrument::saveState(void* to) const noexcept {
  std::memcpy(to, &frames_, sizeof(frames_));
}

void SpringInstrument::loadState(const void* from) noexcept {
  std::memcpy(&frames_, from, sizeof(frames_));
}

void SpringInstrument::readDisplacements(float* to) const noexcept {
  to[0] = static_cast<float>(frames_);
}

bool SpringInstrument::isFinite() const noexcept {
  return setting_.bad_displacement_at < 0 ||
         frames_ / rates().ratio <= setting_.bad_displacement_at;
}

std::unique_ptr<station::Performer> makeSpring(const SpringInstrument::Setting& setting) {
  auto spring = std::make_unique<SpringInstrument>(setting);
  auto rig = tgr::makeRig(spring->scene(), {}, tgr::kMaxSlices);
  return std::make_unique<station::Performer>(std::move(spring), std::move(rig));
}

Bench::Bench(const SpringInstrument::Setting& setting,
             ScriptedDriver::Position position,
             const station::StationConfig& config,
             int slices) {
  auto made = std::make_unique<ScriptedDriver>(slices, log, std::move(position));
  driver = made.get();
  auto performer = makeSpring(setting);
  instrument = static_cast<SpringInstrument*>(performer->instrument.get());
  station =
      std::make_unique<station::Station>(config, std::move(made), std::move(performer), interlock);
}

station::StationConfig Bench::quickConfig() {
  station::StationConfig config;
  config.output_channels = 2;
  config.input_channels = 1;
  config.safety.ramp_s = 0.1;
  // Scripted hands jump, and what is sent shall be what was made.
  config.safety.max_speed_m_per_s = 100.0;
  config.safety.slew_n_per_s = 1e6;
  config.safety.energy_cap_j = 10.0;
  config.safety.energy_supply_w = 20.0;
  config.safety.energy_limit_j = 100.0;
  config.record_ring = 1U << 12U;
  config.keyframe_bytes = 1U << 10U;
  return config;
}

bool Bench::command(station::Command::Type type) {
  return command(type, 0.0);
}

bool Bench::command(station::Command::Type type, double value, int index) {
  station::Command made;
  made.type = type;
  made.value = value;
  made.index = index;
  return station->submit(made);
}

bool Bench::swap(std::unique_ptr<station::Performer> performer,
                 station::SwapForce force,
                 station::Caller caller) {
  station::Command made;
  made.type = station::Command::Type::kSwap;
  made.index = static_cast<int>(force);
  made.caller = caller;
  made.performer = performer.get();
  const bool taken = station->submit(made);
  if (taken) {
    static_cast<void>(performer.release());
  }
  return taken;
}

void Bench::engage(station::Caller caller) {
  station::Command made;
  made.type = station::Command::Type::kEngage;
  made.caller = caller;
  station->submit(made);
  run(kRampTicks);
}

std::vector<station::Event> Bench::events() {
  std::vector<station::Event> all;
  station::Event event;
  while (station->poll(event)) {
    all.push_back(event);
    performers.emplace_back(event.performer);
    coefficients.emplace_back(event.coefficients);
    rigs.emplace_back(event.rig);
  }
  return all;
}

std::vector<station::GestureTick> Bench::recorded() {
  // A few at a time: a live station has locked all memory, and a buffer for the longest run would
  // be mapped and filled with pages at each call, beside the tick.
  std::vector<station::GestureTick> ticks;
  std::array<station::GestureTick, 16> some;
  while (const std::size_t count = station->pollGestures(some.data(), some.size())) {
    ticks.insert(ticks.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return ticks;
}

void Bench::run(std::int64_t ticks) {
  for (std::int64_t i = 0; i < ticks; ++i) {
    station->cycle({0, true});
  }
}

int count(const std::vector<station::Event>& events, station::Event::Type type) {
  return static_cast<int>(std::count_if(
      events.begin(), events.end(), [type](const station::Event& e) { return e.type == type; }));
}

std::int64_t lateEvents(const std::vector<station::Event>& events, station::LateCause cause) {
  return std::count_if(events.begin(), events.end(), [cause](const station::Event& event) {
    return event.type == station::Event::Type::kLateTick &&
           event.index == static_cast<std::int64_t>(cause);
  });
}

station::Event firstOf(const std::vector<station::Event>& events, station::Event::Type type) {
  for (const station::Event& event : events) {
    if (event.type == type) {
      return event;
    }
  }
  station::Event none;
  none.tick = -1;
  return none;
}

void FrameLog::push(std::int64_t first, const float* frames, int nframes) noexcept {
  for (int i = 0; i < nframes; ++i) {
    samples.push_back(frames[static_cast<std::size_t>(i) * channels_]);
    indices.push_back(first + i);
  }
}

bool FrameLog::pull(std::int64_t /*first*/, float* frames, int nframes) noexcept {
  std::fill_n(frames, nframes, input_level);
  return input_level != 0.0F;
}

}  // namespace ergotic::test
