// SPDX-License-Identifier: BSD-3-Clause
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>

#include "ergotic/exception.hpp"
#include "ergotic/physics/settling/chaplet.hpp"
#include "tools/lib/check_report.hpp"

namespace ergotic::tools {
namespace {

using physics::Chaplet;
using physics::ChapletLoad;
using physics::decibels;

constexpr double kShownShares[] = {0.25, 0.5, 0.7, 1.0, 1.5};  // of fN
constexpr double kLowFrequency = 0.02;  // of fN, where a hand feels a chaplet as a mass
constexpr int kPointsPerNyquist = 200;
constexpr int kPoints = 4 * kPointsPerNyquist;

Json filterReport(const physics::FoundChaplet& found) {
  const Chaplet& chaplet = found.chaplet;
  Json gains = Json::array();
  for (const double share : kShownShares) {
    const double frequency_hz = share * chaplet.nyquistHz();
    gains.push_back({{"at_hz", frequency_hz},
                     {"free_db", decibels(chaplet.gain(frequency_hz, {}))},
                     {"loaded_db", decibels(chaplet.gain(frequency_hz, found.load))}});
  }
  return {{"name", found.name},
          {"steps_to_one", chaplet.ratio()},
          {"nyquist_hz", chaplet.nyquistHz()},
          {"mass_kg", chaplet.mass()},
          {"series_stiffness", chaplet.seriesStiffness()},
          {"felt_mass_kg", chaplet.apparentMass(kLowFrequency * chaplet.nyquistHz(), {})},
          {"load_damping", found.load.damping},
          {"load_stiffness", found.load.stiffness},
          {"gain", std::move(gains)}};
}

void writeRows(std::ostream& out, const physics::FoundChaplet& found) {
  const Chaplet& chaplet = found.chaplet;
  const double nyquist_hz = chaplet.nyquistHz();
  const Chaplet other = physics::tunedChaplet(
      scene::kChapletC3, chaplet.mass(), 0.5 / (nyquist_hz * chaplet.ratio()), chaplet.ratio());
  const bool has_other = chaplet.ratio() >= scene::kChapletC3LowestRatio;
  const auto level = [](const Chaplet& of, double frequency_hz, const ChapletLoad& load) {
    return decibels(of.gain(frequency_hz, load));
  };
  for (int i = 1; i <= kPoints; ++i) {
    const double share = static_cast<double>(i) / kPointsPerNyquist;
    const double frequency_hz = share * nyquist_hz;
    if (frequency_hz >= chaplet.ratio() * nyquist_hz) {
      break;  // half the faster rate: there is no more
    }
    const double free = level(chaplet, frequency_hz, {});
    const double loaded = level(chaplet, frequency_hz, found.load);
    const double held = decibels(chaplet.holdGain(frequency_hz));
    const double none = std::numeric_limits<double>::quiet_NaN();
    out << found.name << ',' << chaplet.ratio() << ',' << frequency_hz << ',' << share << ','
        << free << ',' << loaded << ',' << free + held << ',' << loaded + held << ','
        << (has_other ? level(other, frequency_hz, {}) : none) << ','
        << (has_other ? level(other, frequency_hz, found.load) : none) << '\n';
  }
}

}  // namespace

Json filtersReport(const scene::Scene& scene, const physics::Rates& rates) {
  Json report = Json::array();
  for (const physics::FoundChaplet& found : physics::findChaplets(scene, rates)) {
    report.push_back(filterReport(found));
  }
  return report;
}

void writeFilterResponse(const std::string& path,
                         const scene::Scene& scene,
                         const physics::Rates& rates) {
  const auto chaplets = physics::findChaplets(scene, rates);
  if (chaplets.empty()) {
    throw Exception(scene.file + ": there is no chaplet whose response could be written to '" +
                    path + "'");
  }
  std::ofstream out(path);
  out << "chaplet,ratio,frequency_hz,share_of_fn,free,loaded,free_held,loaded_held,c3_free,"
         "c3_loaded\n";
  for (const physics::FoundChaplet& found : chaplets) {
    writeRows(out, found);
  }
  out.close();
  if (!out) {
    throw Exception("cannot write '" + path + "': " + std::strerror(errno));
  }
}

}  // namespace ergotic::tools
