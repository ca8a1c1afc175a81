// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/feel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <CLI/CLI.hpp>

#include "ergotic/exception.hpp"
#include "ergotic/station/judge_hands.hpp"
#include "tools/lib/plot.hpp"

namespace ergotic::tools {
namespace {

constexpr double kRestS = 0.1;     // before a stroke
constexpr double kSlopeM = 50e-6;  // over which a slope is measured, at least
constexpr std::size_t kSlopeTicks = 8;
constexpr double kNoise = 0.05;  // of the largest force: no less is let go
constexpr double kSlow = 0.01;   // m/s
constexpr double kFast = 0.5;
constexpr double kMaxTicks = 1e7;

/// A hand at one slice of a model.
class Hand {
 public:
  Hand(station::Performer& performer, int slice)
      : performer_(performer), slice_(static_cast<std::size_t>(slice)) {}

  double forceAt(double position) {
    physics::Instrument& instrument = *performer_.instrument;
    positions_[slice_] = position;
    const double time_s = static_cast<double>(tick_++) / instrument.rates().gesturalHz();
    performer_.rig->toModel(positions_.data(), time_s, performer_.positions.data());
    instrument.tick({performer_.positions.data(), performer_.forces.data(),
                     performer_.inputs.data(), performer_.outputs.data()});
    performer_.rig->toDevice(performer_.forces.data(), forces_.data());
    const double force = forces_[slice_];
    if (!std::isfinite(force)) {
      throw Exception("the force is not finite at " + std::to_string(position) +
                      " m: the model blows up");
    }
    return force;
  }

 private:
  station::Performer& performer_;
  std::size_t slice_;
  std::array<double, tgr::kMaxSlices> positions_{};
  std::array<double, tgr::kMaxSlices> forces_{};
  std::int64_t tick_ = 0;
};

/// Slope of force over position among ticks first...last, by least squares.
double slopeOf(const std::vector<FeltTick>& ticks, std::size_t first, std::size_t last) {
  const double count = static_cast<double>(last - first + 1);
  double x = 0.0;
  double f = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    x += ticks[i].position / count;
    f += ticks[i].force / count;
  }
  double xx = 0.0;
  double xf = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    xx += (ticks[i].position - x) * (ticks[i].position - x);
    xf += (ticks[i].position - x) * (ticks[i].force - f);
  }
  return xx > 0.0 ? xf / xx : 0.0;
}

double workOf(const std::vector<FeltTick>& ticks, std::size_t first, std::size_t last) {
  double work = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    work -=
        0.5 * (ticks[i].force + ticks[i + 1].force) * (ticks[i + 1].position - ticks[i].position);
  }
  return work;
}

Json strokeReport(const StrokeFigures& stroke) {
  Json report = {{"speed_m_per_s", stroke.speed},
                 {"press_mj", 1e3 * stroke.press_j},
                 {"given_back_mj", 1e3 * stroke.release_j},
                 {"kept_mj", 1e3 * (stroke.press_j - stroke.release_j)},
                 {"peak_n", stroke.peak_n},
                 {"stiffest_n_per_m", stroke.stiffest}};
  if (stroke.release_n > 0.0) {
    report["lets_go_at_n"] = stroke.release_n;
  }
  return report;
}

}  // namespace

void addOptions(CLI::App& app, FeelChoice& choice) {
  CLI::Option* const feel = app.add_option("--feel", choice.slice,
                                           "what a hand meets that moves this slice there and back")
                                ->type_name("slice:N");
  app.add_option("--feel-travel", choice.travel,
                 "how far from the zero of the hand, m at the device (default: 0.02)")
      ->check(CLI::Range(-1.0, 1.0))
      ->needs(feel);
  app.add_option("--feel-speed", choice.speeds, "m/s (default: 0.01 and 0.5)")
      ->check(CLI::Range(1e-4, 100.0))
      ->allow_extra_args(false)
      ->needs(feel);
  app.add_option("--feel-csv", choice.csv, "write force and position to this table")
      ->type_name("F.csv")
      ->needs(feel);
  app.add_option("--plot", choice.plot, "draw force against position")
      ->type_name("F.png")
      ->needs(feel);
}

int sliceOf(const FeelChoice& choice) {
  const std::string head = "slice:";
  const std::string number =
      choice.slice.compare(0, head.size(), head) == 0 ? choice.slice.substr(head.size()) : "";
  const bool is_number =
      !number.empty() && number.size() <= 2 &&
      std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!is_number || std::stoi(number) >= tgr::kMaxSlices) {
    throw Exception("--feel " + choice.slice +
                    ": allowed: slice:0 ... slice:" + std::to_string(tgr::kMaxSlices - 1));
  }
  return std::stoi(number);
}

Stroke feel(station::Performer& performer, int slice, double travel, double speed) {
  if ((performer.rig->slicesInUse() >> static_cast<unsigned>(slice) & 1U) == 0) {
    throw Exception("--feel slice:" + std::to_string(slice) +
                    ": no port of the scene moves with this slice");
  }
  const double rate_hz = performer.instrument->rates().gesturalHz();
  if (!(std::abs(travel) / speed * rate_hz < kMaxTicks) || travel == 0.0) {
    throw Exception("--feel-travel " + std::to_string(travel) + " m at " + std::to_string(speed) +
                    " m/s: allowed: not 0, and at most " + std::to_string(kMaxTicks) + " ticks");
  }
  performer.restart();
  Hand hand(performer, slice);
  for (double rest_s = 0.0; rest_s < kRestS; rest_s += 1.0 / rate_hz) {
    hand.forceAt(0.0);
  }
  const double step = std::copysign(speed / rate_hz, travel);
  const auto steps = static_cast<std::size_t>(std::ceil(std::abs(travel / step) * (1.0 - 1e-12)));
  Stroke stroke;
  stroke.speed = speed;
  stroke.turn = steps + 1;
  double last = 0.0;
  for (std::size_t i = 0; i <= 2 * steps; ++i) {
    const std::size_t from_zero = i <= steps ? i : 2 * steps - i;
    const double whole = static_cast<double>(from_zero) * step;
    const double position = from_zero == steps ? travel : whole;
    stroke.ticks.push_back({position, (position - last) * rate_hz, hand.forceAt(position)});
    last = position;
  }
  return stroke;
}

StrokeFigures figuresOf(const Stroke& stroke) {
  StrokeFigures figures;
  figures.speed = stroke.speed;
  const std::vector<FeltTick>& ticks = stroke.ticks;
  figures.press_j = workOf(ticks, 0, stroke.turn - 1);
  figures.release_j = -workOf(ticks, stroke.turn - 1, ticks.size() - 1);
  const double way = ticks[stroke.turn - 1].position < 0.0 ? -1.0 : 1.0;
  const double step = std::abs(ticks[1].position - ticks[0].position);
  const std::size_t window =
      std::max(kSlopeTicks, static_cast<std::size_t>(std::ceil(kSlopeM / step)));
  for (const FeltTick& tick : ticks) {
    figures.peak_n = std::max(figures.peak_n, std::abs(tick.force));
  }
  double most = 0.0;
  double slope = 0.0;
  for (std::size_t i = 0; i < stroke.turn; ++i) {
    const double resists = -way * ticks[i].force;
    slope = i < window ? slope : std::max(slope, -slopeOf(ticks, i - window, i));
    if (resists > most) {
      most = resists;
      figures.stiffest = slope;  // what springs back after the last of these is no stiffness
    }
    if (resists < 0.5 * most && most > kNoise * figures.peak_n) {
      figures.release_n = most;
    }
  }
  return figures;
}

void writeFeel(const std::vector<Stroke>& strokes, std::ostream& out) {
  out.precision(std::numeric_limits<double>::max_digits10);
  out << "speed_m_per_s,way,position_m,velocity_m_per_s,force_n\n";
  for (const Stroke& stroke : strokes) {
    for (std::size_t i = 0; i < stroke.ticks.size(); ++i) {
      const FeltTick& tick = stroke.ticks[i];
      out << stroke.speed << ',' << (i < stroke.turn ? "press" : "release") << ',' << tick.position
          << ',' << tick.speed << ',' << tick.force << '\n';
    }
  }
}

Json feelReport(station::Performer& performer,
                const physics::DeviceTraits& device,
                const tgr::EndEffectors& end_effectors,
                const FeelChoice& choice) {
  const int slice = sliceOf(choice);
  const std::vector<double> speeds =
      choice.speeds.empty() ? std::vector<double>{kSlow, kFast} : choice.speeds;
  std::vector<Stroke> strokes;
  Json figures = Json::array();
  for (const double speed : speeds) {
    strokes.push_back(feel(performer, slice, choice.travel, speed));
    figures.push_back(strokeReport(figuresOf(strokes.back())));
  }
  Json report = {{"slice", slice}, {"travel_m", choice.travel}, {"strokes", std::move(figures)}};
  double limit = 0.0;
  const physics::Instrument& instrument = *performer.instrument;
  for (const station::SliceLoad& load :
       station::judgeHands(instrument.scene(), instrument.rates(), performer.certificate, device,
                           end_effectors)
           .slices) {
    if (load.slice == slice) {
      limit = load.stiffness_limit;
      report["certified_n_per_m"] = load.together;
      report["passive_up_to_n_per_m"] = limit;
    }
  }
  if (!choice.csv.empty()) {
    writeTable(choice.csv, [&](std::ostream& out) { writeFeel(strokes, out); });
  }
  if (!choice.plot.empty()) {
    plot("plot_feel", choice.plot, [&](std::ostream& out) {
      out << "# passive_up_to_n_per_m " << limit << '\n';
      writeFeel(strokes, out);
    });
  }
  return report;
}

}  // namespace ergotic::tools
