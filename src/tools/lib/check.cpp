// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/check.hpp"

#include <iostream>
#include <map>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/generate/pitch.hpp"
#include "tools/lib/check_filters.hpp"
#include "tools/lib/check_names.hpp"
#include "tools/lib/check_ports.hpp"
#include "tools/lib/check_sections.hpp"
#include "tools/lib/cost.hpp"
#include "tools/lib/end_effectors.hpp"
#include "tools/lib/load_figures.hpp"
#include "tools/lib/report.hpp"
#include "tools/lib/target.hpp"

namespace ergotic::tools {
namespace {

using scene::Scene;

const scene::Mat& matAt(const Scene& scene, int index) {
  return scene.mats[static_cast<std::size_t>(index)];
}

Report counts(const std::map<std::string, std::size_t>& by_name) {
  Report report = Report::map();
  for (const auto& [name, count] : by_name) {
    report.add(name, Report::number(count));
  }
  return report;
}

Report linksOf(const Scene& scene) {
  std::map<std::string, std::size_t> by_type;
  std::map<std::string, std::size_t> by_scheme;
  std::size_t between_sections = 0;
  for (const scene::Lia& lia : scene.lias) {
    ++by_type[nameOf(lia.type)];
    ++by_scheme[lia.scheme == scene::Scheme::kGuarded ? "guarded" : "explicit"];
    const bool across = matAt(scene, lia.a).section != matAt(scene, lia.b).section;
    between_sections += across ? 1 : 0;
  }
  return Report::map()
      .add("count", Report::number(scene.lias.size()))
      .add("types", counts(by_type))
      .add("schemes", counts(by_scheme))
      .add("between_sections", Report::number(between_sections));
}

Report pointsOf(const Scene& scene) {
  Report report = Report::list();
  for (const scene::Connection& point : scene.connections) {
    const scene::Grid& grid = scene.grids[static_cast<std::size_t>(point.grid)];
    Report entry = Report::map();
    entry.add("name", Report::text(matAt(scene, point.mat).name))
        .add("on", Report::text(grid.name))
        .add("along", Report::number(scene.valueOf(point.along)));
    if (grid.rows > 1) {
      entry.add("across", Report::number(scene.valueOf(point.across)));
    }
    if (point.along.parameter >= 0) {
      const auto moved_by = static_cast<std::size_t>(point.along.parameter);
      entry.add("parameter", Report::text(scene.parameters[moved_by].name));
    }
    if (point.guide >= 0) {
      entry.add("guide", Report::text(matAt(scene, point.guide).name));
    }
    report.add(std::move(entry));
  }
  return report;
}

/// Inputs or outputs.
template <class Tap>
Report tap(const Scene& scene, const Tap& tap, const scene::Mat& mat) {
  return Report::map()
      .add("name", Report::text(tap.name))
      .add("quantity", Report::text(nameOf(tap.quantity)))
      .add("module", Report::text(mat.name))
      .add("channel", Report::number(tap.channel + 1))
      .add("gain", Report::number(scene.valueOf(tap.gain)));
}

Report inputsOf(const Scene& scene) {
  Report report = Report::list();
  for (const scene::Input& input : scene.inputs) {
    report.add(tap(scene, input, matAt(scene, input.mat)));
  }
  return report;
}

Report outputsOf(const Scene& scene) {
  Report report = Report::list();
  for (const scene::Output& output : scene.outputs) {
    report.add(tap(scene, output, matAt(scene, output.point.mat)));
  }
  return report;
}

Report parametersOf(const Scene& scene) {
  Report report = Report::list();
  for (const scene::Parameter& parameter : scene.parameters) {
    report.add(Report::map()
                   .add("name", Report::text(parameter.name))
                   .add("value", Report::number(parameter.value))
                   .add("minimum", Report::number(parameter.minimum))
                   .add("maximum", Report::number(parameter.maximum)));
  }
  return report;
}

Report stringsOf(const Scene& scene, const physics::Rates& rates) {
  Report report = Report::list();
  for (const scene::StringInfo& string : scene.strings) {
    const int index = matAt(scene, string.first).section;
    const scene::Section& section = scene.sections[static_cast<std::size_t>(index)];
    const double rate_hz = rates.audio_hz / physics::divisorOf(section, rates);
    report.add(Report::map()
                   .add("name", Report::text(string.name))
                   .add("masses", Report::number(string.count - 2))
                   .add("pitch_hz", Report::number(scene::stringPitchHz(scene, string, rate_hz))));
  }
  return report;
}

/// For instruments that live shorter than it does.
std::shared_ptr<const Scene> shared(const Scene& scene) {
  return {std::shared_ptr<const Scene>(), &scene};
}

std::string sizeText(const Scene& scene) {
  return std::to_string(scene.mats.size() + scene.lias.size()) + " modules and links";
}

/// Ends with the program that `options` ask for, sharing the scene as in the station.
Report loadOf(const Scene& scene,
              const physics::Rates& rates,
              const physics::CompileOptions& options,
              LoadFigures& load) {
  load.begin("compile_s", "compile " + sizeText(scene));
  const auto instrument = physics::compile(shared(scene), rates, options);
  return load.finish(scene.mats.size() + scene.lias.size());
}

Report texts(const std::vector<std::string>& lines) {
  Report report = Report::list();
  for (const std::string& line : lines) {
    report.add(Report::text(line));
  }
  return report;
}

/// What `compile` made of the scene, and why.
Report programOf(const physics::Instrument& instrument) {
  const physics::CompileOptions& options = instrument.options();
  return Report::map()
      .add("precision", Report::text(nameOf(options.precision)))
      .add("isa", Report::text(nameOf(options.isa)))
      .add("threads", Report::number(options.threads))
      .add("parts", texts(instrument.describe()));
}

/// Adds the program that `options` ask for, and what both precisions cost.
void addProgram(const Scene& scene,
                const physics::Rates& rates,
                physics::CompileOptions options,
                Report& report) {
  const physics::Precision chosen = options.precision;
  Report costs = Report::map();
  for (const auto precision : {physics::Precision::kFloat, physics::Precision::kDouble}) {
    options.precision = precision;
    const auto instrument = physics::compile(shared(scene), rates, options);
    if (precision == chosen) {
      report.add("program", programOf(*instrument));
    }
    const Cost cost = measureCost(*instrument);
    costs.add(nameOf(precision),
              Report::map()
                  .add("state_bytes", Report::number(instrument->stateSize()))
                  .add("tick_ns", Report::number(cost.tick_ns))
                  .add("step_ns", Report::number(cost.frame_ns))
                  .add("real_time_factor", Report::number(cost.real_time_factor)));
  }
  report.add("cost", std::move(costs));
}

Report reportOn(const physics::Settled& settled,
                const physics::Rates& rates,
                const physics::Certificate& certificate,
                const physics::CompileOptions& options,
                const DeviceChoice& device,
                Report load) {
  const Scene& scene = settled.scene;
  std::vector<std::string> warnings = scene.warnings;
  const std::string note = conversionNote(scene, rates);
  if (!note.empty()) {
    warnings.push_back(note);
  }
  Report report = Report::map();
  report.add("scene", Report::text(scene.name))
      .add("modules", Report::number(scene.mats.size()))
      .add("audio_rate_hz", Report::number(rates.audio_hz))
      .add("gestural_rate_hz", Report::number(rates.gesturalHz()))
      .add("frames_per_tick", Report::number(rates.ratio))
      .add("stability", stabilityReport(scene, rates, certificate))
      .add("sections", sectionsReport(scene, rates, certificate))
      .add("links", linksOf(scene))
      .add("points", pointsOf(scene))
      .add("ports", portsReport(scene, rates, certificate, device.noise))
      .add("agents", agentsReport(scene))
      .add("inputs", inputsOf(scene))
      .add("outputs", outputsOf(scene))
      .add("parameters", parametersOf(scene))
      .add("strings", stringsOf(scene, rates))
      .add("filters", filtersReport(scene, rates))
      .add("load", std::move(load));
  addProgram(scene, rates, options, report);
  return report.add("notes", texts(settled.notes)).add("warnings", texts(warnings));
}

/// Adds what each slice meets and what is too much. \return what is refused
std::vector<std::string> addSlices(const tgr::EndEffectors& end_effectors,
                                   const Scene& scene,
                                   const physics::Rates& rates,
                                   const physics::Certificate& certificate,
                                   const physics::DeviceTraits& device,
                                   Report& report) {
  const auto rendered = renderedStiffness(scene, rates, certificate, device, end_effectors);
  const tgr::StiffnessFindings findings = tgr::judgeStiffness(end_effectors, rendered);
  std::vector<std::string> all = findings.refusals;
  all.insert(all.end(), findings.warnings.begin(), findings.warnings.end());
  report.add("slices", slicesReport(end_effectors, rendered)).add("slice_findings", texts(all));
  return findings.refusals;
}

/// Prints the report, then why the scene cannot be played. \return the exit code
int finish(const Report& report,
           bool json,
           const std::string& file,
           physics::Verdict verdict,
           const std::vector<std::string>& refusals) {
  if (json) {
    report.printJson(std::cout);
    std::cout << '\n';
  } else {
    report.printText(std::cout);
  }
  for (const std::string& line : refusals) {
    std::cerr << line << '\n';
  }
  if (verdict == physics::Verdict::kUnstable) {
    std::cerr << file << ": unstable at these rates\n";
    return kRefused;
  }
  return refusals.empty() ? kSuccess : kFailure;
}

void addOptions(CLI::App& app, DeviceChoice& choice) {
  app.add_option("--device-damping", choice.traits.damping,
                 "of a slice by itself, N s/m (default: 2)")
      ->check(CLI::PositiveNumber);
  app.add_option("--device-delay", choice.traits.delay_ticks,
                 "from a position to the force that answers it, ticks (default: 1)")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--sensor-noise", choice.noise.rms, "of a position, m rms (default: 0.5e-6)")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--sensor-quantum", choice.noise.quantum,
                 "to which a position is rounded, m (default: 1e-6)")
      ->check(CLI::NonNegativeNumber);
}

}  // namespace

void addOptions(CLI::App& app, CheckOptions& options) {
  app.add_option("scene", options.scene.scene, "scene file, .yaml or .mdl")
      ->type_name("SCENE")
      ->required();
  addOptions(app, options.scene);
  addOptions(app, options.compile);
  addTargetOption(app, options.target, "propose the cheapest setting that plays this accurately");
  addEndEffectorsOption(app, options.end_effectors);
  addOptions(app, options.device);
  app.add_flag("--json", options.json, "for a program to read");
  app.add_option("--filter-response", options.filter_response,
                 "write what the chaplets of the scene let through to this table")
      ->type_name("FILE.csv");
}

int check(const CheckOptions& options) {
  const tgr::EndEffectors end_effectors = readEndEffectors(options.end_effectors);
  LoadFigures load;
  load.begin("read_s", "read " + options.scene.scene);
  Scene scene = readScene(options.scene);
  const physics::Rates rates = chosenRates(scene, options.scene);
  load.begin("settle_s", "settle " + sizeText(scene));
  const physics::Settled settled = physics::settle(std::move(scene), rates);
  load.begin("certify_s", "certify " + sizeText(settled.scene));
  physics::DeviceTraits device = options.device.traits;
  device.taken_ports = tgr::takenPorts(settled.scene, end_effectors);
  const physics::Certificate certificate = physics::certify(settled.scene, rates, device);
  const physics::CompileOptions compile = chosenOptions(options.compile);
  Report report = reportOn(settled, rates, certificate, compile, options.device,
                           loadOf(settled.scene, rates, compile, load));
  if (!options.target.empty()) {
    report.add("target", targetReport(readScene(options.scene), rates, compile, options.target,
                                      freedomOf(options.scene, options.compile)));
  }
  std::vector<std::string> refusals = refusedPorts(settled.scene, certificate);
  if (!options.end_effectors.empty()) {
    const auto of_slices =
        addSlices(end_effectors, settled.scene, rates, certificate, device, report);
    refusals.insert(refusals.end(), of_slices.begin(), of_slices.end());
  }
  if (!options.filter_response.empty()) {
    writeFilterResponse(options.filter_response, settled.scene, rates);
  }
  return finish(report, options.json, settled.scene.file, certificate.verdict, refusals);
}

}  // namespace ergotic::tools
