// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/bench_measure.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"
#include "lab/lib/plain_network.hpp"

namespace ergotic::tools {
namespace {

constexpr double kWindowNs = 4e6;
constexpr int kGestureTicks = 64;  // after which the hands begin again

/// An instrument whose hands go up and down.
class Hands {
 public:
  explicit Hands(physics::Instrument& instrument)
      : instrument_(instrument),
        ports_(static_cast<std::size_t>(instrument.ports())),
        forces_(ports_),
        inputs_(frames() * static_cast<std::size_t>(instrument.inputChannels())),
        outputs_(frames() * static_cast<std::size_t>(instrument.outputChannels())) {
    for (std::size_t i = 0; i < kGestureTicks * ports_; ++i) {
      const double turn = static_cast<double>(i / std::max<std::size_t>(1, ports_)) / kGestureTicks;
      positions_.push_back(1e-3 * std::sin(2.0 * M_PI * turn + static_cast<double>(i)));
    }
  }

  void step(int frames) {
    for (int f = 0; f < frames; f += instrument_.rates().ratio) {
      tick_ = (tick_ + 1) % kGestureTicks;
      instrument_.tick(
          {positions_.data() + tick_ * ports_, forces_.data(), inputs_.data(), outputs_.data()});
    }
  }

 private:
  std::size_t frames() const { return static_cast<std::size_t>(instrument_.rates().ratio); }

  physics::Instrument& instrument_;
  std::size_t ports_;
  std::size_t tick_ = 0;
  std::vector<double> positions_;  // [kGestureTicks][ports]
  std::vector<double> forces_;
  std::vector<double> inputs_;
  std::vector<double> outputs_;
};

using Now = double (*)();

double clockNs() {
  return static_cast<double>(rt::monotonicNs());
}

/// Steps in windows, with the time of all of them.
template <class Player>
struct Stopwatch {
  Player& player;
  Now now;
  int frames;  // of a window
  double ns = 0.0;
  double counted = 0.0;

  /// Warms up, and finds how many ticks take as long as a window should.
  Stopwatch(Player& stepped, Now clock, int ratio) : player(stepped), now(clock), frames(ratio) {
    for (;;) {
      const double begin = now();
      player.step(frames);
      const double taken = now() - begin;
      if (taken > kWindowNs / 4 || frames > (1 << 26)) {
        const double windows = std::max(kWindowNs / std::max(taken, 1.0), 1.0);
        frames = static_cast<int>(windows) * frames;
        return;
      }
      frames *= 2;
    }
  }
  void window() {
    const double begin = now();
    player.step(frames);
    ns += now() - begin;
    counted += frames;
  }
  double take() {
    const double per_frame = ns / counted;
    ns = counted = 0.0;
    return per_frame;
  }
};

double secondsSince(std::int64_t begin_ns) {
  return 1e-9 * static_cast<double>(rt::monotonicNs() - begin_ns);
}

void measureRuns(physics::Instrument& instrument,
                 PlainNetwork* plain,
                 const BenchSettings& settings,
                 BenchResult& result) {
  const rt::FlushDenormals as_when_played;
  const Now now = settings.compile.threads > 1 ? clockNs : threadCpuNs;
  const int ratio = instrument.rates().ratio;
  Hands hands(instrument);
  Stopwatch<Hands> ours(hands, now, ratio);
  std::unique_ptr<Stopwatch<PlainNetwork>> theirs;
  if (plain != nullptr) {
    theirs = std::make_unique<Stopwatch<PlainNetwork>>(*plain, now, ratio);
  }
  for (int run = 0; run < settings.runs; ++run) {
    const std::int64_t begin = rt::monotonicNs();
    do {
      if (theirs) {
        theirs->window();
      }
      ours.window();
    } while (secondsSince(begin) < settings.seconds / settings.runs);
    result.ns.push_back(ours.take());
    if (theirs) {
      result.plain_ns.push_back(theirs->take());
    }
  }
}

}  // namespace

BenchResult measure(const BenchKind& kind, int modules, const BenchSettings& settings) {
  BenchResult result;
  result.scene = kind.name;
  const physics::Rates rates = benchRates();
  const std::int64_t begin = rt::monotonicNs();
  const scene::Scene scene = kind.make(modules);
  result.make_s = secondsSince(begin);
  result.modules = modulesOf(scene);
  result.links = scene.lias.size();
  result.masses = result.modules - result.links;
  result.work = workOf(scene, rates, settings.compile.precision);
  const std::int64_t made = rt::monotonicNs();
  const auto instrument = physics::compile(scene, rates, settings.compile);
  result.compile_s = secondsSince(made);
  result.chosen = instrument->describe();
  const auto plain =
      kind.is_plain ? makePlainNetwork(scene, rates, settings.compile.precision) : nullptr;
  measureRuns(*instrument, plain.get(), settings, result);
  return result;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double ratioOf(const BenchResult& result) {
  if (result.plain_ns.empty()) {
    return 0.0;
  }
  std::vector<double> ratios;
  for (std::size_t run = 0; run < result.ns.size(); ++run) {
    ratios.push_back(result.plain_ns[run] / result.ns[run]);
  }
  return median(ratios);
}

}  // namespace ergotic::tools
