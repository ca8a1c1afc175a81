// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/check_modes.hpp"

#include <cmath>
#include <limits>

#include <CLI/CLI.hpp>

#include "tools/lib/plot.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {
namespace {

using physics::SceneMode;
using physics::SceneModes;

const char* kindName(SceneMode::Kind kind) {
  return kind == SceneMode::Kind::kRings    ? "rings"
         : kind == SceneMode::Kind::kCreeps ? "creeps"
                                            : "grows";
}

Json weightsOf(const std::vector<std::string>& names, const std::vector<double>& weights) {
  Json report = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i) {
    report[names[i]] = weights[i];
  }
  return report;
}

std::vector<std::string> outputNames(const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const scene::Output& output : scene.outputs) {
    names.push_back(output.name);
  }
  return names;
}

Json modeReport(const SceneModes& found, std::size_t i, const std::vector<std::string>& outputs) {
  const SceneMode& mode = found.modes[i];
  Json entry = {{"mode", i + 1}, {"hz", mode.frequency_hz}};
  if (mode.asked >= 0) {
    const physics::AskedPitch& asked = found.asked[static_cast<std::size_t>(mode.asked)];
    entry["cents"] = mode.cents;
    entry["from"] = asked.body + " " + std::to_string(asked.partial);
  }
  if (std::isinf(mode.t60_s)) {
    entry["t60_s"] = "no loss";
  } else {
    entry["t60_s"] = mode.t60_s;
  }
  if (mode.kind != SceneMode::Kind::kRings) {
    entry["kind"] = kindName(mode.kind);
  }
  if (mode.error > 0.0) {
    entry["error"] = mode.error;
  }
  entry["peak"] = mode.peak;
  if (!outputs.empty()) {
    entry["outputs"] = weightsOf(outputs, mode.at_outputs);
  }
  if (!found.points.empty()) {
    entry["points"] = weightsOf(found.points, mode.at_points);
  }
  return entry;
}

Json modesReport(const SceneModes& found,
                 const scene::Scene& scene,
                 const physics::Rates& rates,
                 const ModesChoice& choice) {
  Json report = {{"scene", scene.name}, {"audio_rate_hz", rates.audio_hz}};
  Json window = Json::object();
  window["from_hz"] = choice.window.from_hz;
  if (std::isfinite(choice.window.to_hz)) {
    window["to_hz"] = choice.window.to_hz;
  }
  window["modes"] = found.counted;
  window["told"] = found.modes.size();
  window["count"] = found.is_certain ? "complete" : "uncertain: within the rounding of factors";
  report["window"] = std::move(window);
  Json rigid = Json::object();
  for (const physics::RigidMotions& one : found.rigid) {
    rigid[one.section] = one.count;
  }
  report["motions_as_a_whole"] = std::move(rigid);
  const std::vector<std::string> outputs = outputNames(scene);
  Json modes = Json::array();
  for (std::size_t i = 0; i < found.modes.size(); ++i) {
    modes.push_back(modeReport(found, i, outputs));
  }
  report["modes"] = std::move(modes);
  Json missing = Json::array();
  for (const physics::AskedPitch& asked : found.asked) {
    const bool is_inside = asked.hz >= choice.window.from_hz && asked.hz <= choice.window.to_hz &&
                           (found.modes.size() == static_cast<std::size_t>(found.counted) ||
                            (!found.modes.empty() && asked.hz <= found.modes.back().frequency_hz));
    if (!asked.is_found && is_inside) {
      missing.push_back({{"body", asked.body}, {"partial", asked.partial}, {"hz", asked.hz}});
    }
  }
  report["asked_but_not_found"] = std::move(missing);
  report["notes"] = found.notes;
  return report;
}

void writeCsv(const SceneModes& found, const scene::Scene& scene, std::ostream& out) {
  out.precision(std::numeric_limits<double>::max_digits10);
  out << "mode,kind,frequency_hz,cents,asked,t60_s,error,peak";
  for (const std::string& name : outputNames(scene)) {
    out << ",output:" << name;
  }
  for (const std::string& name : found.points) {
    out << ",point:" << name;
  }
  out << '\n';
  for (std::size_t i = 0; i < found.modes.size(); ++i) {
    const SceneMode& mode = found.modes[i];
    out << i + 1 << ',' << kindName(mode.kind) << ',' << mode.frequency_hz << ',';
    if (mode.asked >= 0) {
      const physics::AskedPitch& asked = found.asked[static_cast<std::size_t>(mode.asked)];
      out << mode.cents << ',' << asked.body << ' ' << asked.partial;
    } else {
      out << ',';
    }
    out << ',' << mode.t60_s << ',' << mode.error << ',' << mode.peak;
    for (const std::vector<double>* weights : {&mode.at_outputs, &mode.at_points}) {
      for (const double weight : *weights) {
        out << ',' << weight;
      }
    }
    out << '\n';
  }
}

}  // namespace

void addOptions(CLI::App& app, ModesChoice& choice) {
  CLI::Option* const modes =
      app.add_flag("--modes", choice.are_wanted, "say at what the scene sounds, and nothing else");
  app.add_option("--most", choice.window.most, "of the modes, the lowest (default: 20)")
      ->check(CLI::Range(1, physics::kMaxModes))
      ->needs(modes);
  app.add_option("--from", choice.window.from_hz, "lowest frequency of the modes, Hz (default: 0)")
      ->check(CLI::NonNegativeNumber)
      ->needs(modes);
  app.add_option("--to", choice.window.to_hz, "highest frequency of the modes, Hz (default: any)")
      ->check(CLI::PositiveNumber)
      ->needs(modes);
  app.add_option("--csv", choice.csv, "write the modes to this table, too")
      ->type_name("FILE.csv")
      ->needs(modes);
  app.add_option("--plot", choice.plot, "draw the modes, too")->type_name("FILE.png")->needs(modes);
}

void checkModes(const scene::Scene& asked,
                const scene::Scene& settled,
                const physics::Rates& rates,
                const ModesChoice& choice,
                bool json) {
  const SceneModes found = physics::modesOf(settled, rates, choice.window, asked);
  const auto write = [&](std::ostream& out) { writeCsv(found, settled, out); };
  if (!choice.csv.empty()) {
    writeTable(choice.csv, write);
  }
  if (!choice.plot.empty()) {
    plot("plot_modes", choice.plot, write);
  }
  const Json report = modesReport(found, settled, rates, choice);
  tell(report, json);
}

}  // namespace ergotic::tools
