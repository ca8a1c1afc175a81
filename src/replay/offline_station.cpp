// SPDX-License-Identifier: BSD-3-Clause
#include "replay/offline_station.hpp"

#include <algorithm>
#include <utility>

#include "ergotic/exception.hpp"

namespace ergotic::replay {
namespace {

/// The shortest that a station takes: no hand waits here for the force to come, and strokes during
/// a ramp go further than later ones, for less holds them back.
constexpr double kRampS = 0.1;

station::StationConfig configOf(const physics::Rates& rates,
                                int inputs,
                                int outputs,
                                std::int64_t first_tick) {
  station::StationConfig config;
  config.rates = rates;
  config.input_channels = inputs;
  config.output_channels = outputs;
  config.record_ring = 1;  // nobody reads it
  config.first_tick = first_tick;
  config.safety.ramp_s = kRampS;
  return config;
}

}  // namespace

bool isBlowUp(const station::Event& event) {
  return event.type == station::Event::Type::kFault &&
         event.index == static_cast<std::int64_t>(station::FaultReason::kModelBlowUp);
}

OfflineStation::OfflineStation(std::unique_ptr<station::Performer> performer,
                               std::unique_ptr<tgr::Driver> driver,
                               int output_channels,
                               std::int64_t first_tick,
                               SoundSource inputs)
    : inputs_(std::move(inputs)),
      output_channels_(output_channels),
      rates_(performer->instrument->rates()),
      station_(configOf(rates_, inputs_.channels, output_channels, first_tick),
               std::move(driver),
               std::move(performer)) {
  sound_.resize(static_cast<std::size_t>(rates_.ratio * output_channels_));
  station_.setFramePort(this);
}

void OfflineStation::submit(const station::Command& command) {
  if (!station_.submit(command)) {
    throw Exception("more commands in one tick than a station takes");
  }
}

void OfflineStation::move(const tgr::HandMove& move, double due_tick) {
  if (!station_.move(move, due_tick)) {
    throw Exception("slice " + std::to_string(move.slice) +
                    ": the station has no simulated hand there, or too many moves in one tick");
  }
}

void OfflineStation::setParameter(const physics::Instrument& instrument,
                                  const std::vector<double>& values,
                                  int index) {
  auto coefficients = instrument.prepare(values);
  station::Command change;
  change.type = station::Command::Type::kParameter;
  change.index = index;
  change.value = values[static_cast<std::size_t>(index)];
  change.coefficients = coefficients.get();
  submit(change);
  static_cast<void>(coefficients.release());  // comes back with its event
}

void OfflineStation::hold(std::size_t hand, const station::Hold& hold) {
  if (!station_.hold(hand, hold, nullptr)) {
    throw Exception("hand " + std::to_string(hand) +
                    " holds a module with a value outside its range");
  }
}

void OfflineStation::cycle(double* frames, const std::function<void(const station::Event&)>& hear) {
  station::Station::Timing timing;
  timing.freewheel = true;
  station_.cycle(timing);
  std::copy(sound_.begin(), sound_.end(), frames);
  station::Event event;
  while (station_.poll(event)) {
    const std::unique_ptr<station::Performer> performer(event.performer);
    const std::unique_ptr<physics::Coefficients> coefficients(event.coefficients);
    if (hear) {
      hear(event);
    }
  }
}

void OfflineStation::push(std::int64_t /*first*/, const float* frames, int nframes) noexcept {
  std::copy_n(frames, nframes * output_channels_, sound_.data());
}

bool OfflineStation::pull(std::int64_t first, float* frames, int nframes) noexcept {
  if (!inputs_.read) {
    return false;
  }
  inputs_.read(first, nframes, frames);
  return true;
}

}  // namespace ergotic::replay
