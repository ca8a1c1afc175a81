// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/accuracy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <utility>

#include "ergotic/advice/accuracy.hpp"
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/rt/thread.hpp"
#include "ergotic/scene/text/read_scene.hpp"

namespace ergotic::tools {
namespace {

constexpr int kRuns = 5;
constexpr double kRunS = 5e-3;  // CPU time of a run, at least

double cpuS() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

physics::Settled settled(const std::string& yaml, const physics::Rates& rates) {
  return physics::settle(scene::readYaml(yaml, "problem"), rates);
}

std::size_t ticksIn(double seconds, const physics::Rates& rates) {
  return static_cast<std::size_t>(std::ceil(seconds * rates.gesturalHz()));
}

/// Of what forces move, and of the links; those between rates go with the faster one.
double stepsPerSecond(const scene::Scene& scene, const physics::Rates& rates) {
  const auto rateOf = [&](int mat) {
    const scene::Section& section = scene.sectionOf(scene.mats[static_cast<std::size_t>(mat)]);
    return rates.audio_hz / physics::divisorOf(section, rates);
  };
  double sum = 0.0;
  for (int m = 0; m < static_cast<int>(scene.mats.size()); ++m) {
    const scene::MatType type = scene.mats[static_cast<std::size_t>(m)].type;
    const bool moves = type == scene::MatType::kMass || type == scene::MatType::kCell;
    sum += moves ? rateOf(m) : 0.0;
  }
  for (const scene::Lia& lia : scene.lias) {
    sum += std::max(rateOf(lia.a), rateOf(lia.b));
  }
  return sum;
}

}  // namespace

Experiment::Experiment(const std::string& yaml,
                       const physics::Rates& rates,
                       physics::Precision precision)
    : instrument_(physics::compile(settled(yaml, rates).scene, rates, precision)),
      start_(instrument_->stateSize()) {
  const auto frames = static_cast<std::size_t>(rates.ratio);
  positions_.resize(static_cast<std::size_t>(instrument_->ports()));
  forces_.resize(positions_.size());
  inputs_.resize(frames * static_cast<std::size_t>(instrument_->inputChannels()));
  outputs_.resize(frames * static_cast<std::size_t>(instrument_->outputChannels()));
  instrument_->saveState(start_.data());
}

std::vector<std::vector<double>> Experiment::play(double seconds,
                                                  const std::function<double(double)>& hand) {
  const rt::FlushDenormals as_when_played;
  instrument_->loadState(start_.data());
  const auto channels = static_cast<std::size_t>(instrument_->outputChannels());
  std::vector<std::vector<double>> heard(channels);
  const double tick_s = 1.0 / instrument_->rates().gesturalHz();
  const std::size_t ticks = ticksIn(seconds, instrument_->rates());
  for (std::size_t n = 0; n < ticks; ++n) {
    const double place = hand ? hand(static_cast<double>(n) * tick_s) : 0.0;
    std::fill(positions_.begin(), positions_.end(), place);
    instrument_->tick({positions_.data(), forces_.data(), inputs_.data(), outputs_.data()});
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
      heard[i % channels].push_back(outputs_[i]);
    }
  }
  return heard;
}

PlayCost Experiment::cost(double seconds) {
  const rt::FlushDenormals as_when_played;
  const physics::TickIo io{positions_.data(), forces_.data(), inputs_.data(), outputs_.data()};
  const std::size_t ticks = ticksIn(seconds, instrument_->rates());
  std::array<double, kRuns> runs{};
  for (double& run : runs) {
    const double begin = cpuS();
    std::size_t played = 0;
    while (cpuS() - begin < kRunS) {
      instrument_->loadState(start_.data());
      for (std::size_t n = 0; n < ticks; ++n) {
        instrument_->tick(io);
      }
      played += ticks;
    }
    run = (cpuS() - begin) * instrument_->rates().gesturalHz() / static_cast<double>(played);
  }
  std::nth_element(runs.begin(), runs.begin() + kRuns / 2, runs.end());
  return {runs[kRuns / 2], stepsPerSecond(instrument_->scene(), instrument_->rates())};
}

bool isPlayable(const std::string& yaml, const physics::Rates& rates) {
  return physics::certify(settled(yaml, rates).scene, rates).verdict != physics::Verdict::kUnstable;
}

std::vector<double> stringPartials(int masses, double pitch_hz, double rate_hz) {
  std::vector<double> partials = physics::partialsOf({masses, false}, pitch_hz / rate_hz, true);
  for (double& partial : partials) {
    partial *= rate_hz;
  }
  return partials;
}

const std::vector<double>& measuredRates() {
  static const std::vector<double> kRates{22050.0, 44100.0, 88200.0, 96000.0};
  return kRates;
}

}  // namespace ergotic::tools
