// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/check.hpp"

#include <algorithm>
#include <ctime>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>

#include "at.hpp"
#include "ergotic/advice/ranges.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/certificate/precision.hpp"
#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "ergotic/scene/generate/pitch.hpp"
#include "physics/certificate/rounding_noise.hpp"
#include "physics/note.hpp"
#include "scene/laws/law.hpp"
#include "tools/lib/check_report.hpp"
#include "tools/lib/cost.hpp"
#include "tools/lib/end_effectors.hpp"
#include "tools/lib/explain.hpp"
#include "tools/lib/load_times.hpp"
#include "tools/lib/report.hpp"
#include "tools/lib/report_names.hpp"
#include "tools/lib/shipped.hpp"
#include "tools/lib/target.hpp"
#include "tools/lib/truths.hpp"

namespace ergotic::tools {
namespace {

using scene::Scene;

constexpr double kQuicklyJudgedS = 0.3;  // CPU time of one verdict, times parameters

Json linksOf(const Scene& scene) {
  std::map<std::string, std::size_t> by_type;
  std::map<std::string, std::size_t> by_scheme;
  std::size_t between_sections = 0;
  std::size_t parts = 0;  // of links of many ends
  for (const scene::Lia& lia : scene.lias) {
    if (lia.bend >= 0) {
      ++parts;
      continue;
    }
    const bool is_stretch =
        lia.tank >= 0 && scene.tanks[static_cast<std::size_t>(lia.tank)].is_mean;
    ++by_type[is_stretch ? "stretch" : scene::lawOf(lia.type).name];
    ++by_scheme[lia.scheme == scene::Scheme::kEnergyStable ? "energy_stable" : "explicit"];
    const bool across = scene.mats[at(lia.a)].section != scene.mats[at(lia.b)].section;
    between_sections += across ? 1 : 0;
  }
  if (!scene.bends.empty()) {
    by_type["bend"] = scene.bends.size();
    by_scheme["explicit"] += scene.bends.size();
  }
  return {{"count", scene.lias.size() - parts + scene.bends.size()},
          {"types", by_type},
          {"schemes", by_scheme},
          {"between_sections", between_sections}};
}

Json parametersOf(const Scene& scene) {
  Json report = Json::array();
  for (const scene::Parameter& parameter : scene.parameters) {
    report.push_back({{"name", parameter.name},
                      {"value", parameter.value},
                      {"unit", parameter.unit.empty() ? "not said" : parameter.unit},
                      {"minimum", parameter.minimum},
                      {"maximum", parameter.maximum}});
  }
  return report;
}

Json stringsOf(const Scene& scene, const physics::Rates& rates) {
  Json report = Json::array();
  for (const scene::StringInfo& string : scene.strings) {
    const int index = scene.mats[at(string.first)].section;
    const scene::Section& section = scene.sections[static_cast<std::size_t>(index)];
    const double rate_hz = rates.audio_hz / physics::divisorOf(section, rates);
    report.push_back({{"name", string.name},
                      {"masses", string.count - 2},
                      {"pitch_hz", scene::stringPitchHz(scene, string, rate_hz)}});
  }
  return report;
}

/// Generated bodies that were asked for a pitch: they are tuned to it by their modes.
Json bodiesOf(const Scene& scene) {
  Json report = Json::array();
  for (const scene::Tuning& body : scene.tunings) {
    if (body.pitch_hz > 0.0) {
      report.push_back({{"name", body.name}, {"pitch_hz", body.pitch_hz}});
    }
  }
  return report;
}

/// Pointer without ownership, for instruments that do not outlive the scene.
std::shared_ptr<const Scene> shared(const Scene& scene) {
  return {std::shared_ptr<const Scene>(), &scene};
}

std::string sizeText(const Scene& scene) {
  return std::to_string(scene.mats.size() + scene.lias.size()) + " modules and links";
}

const char* endName(physics::JudgedRange::End end) {
  return end == physics::JudgedRange::End::kNone      ? "neither end"
         : end == physics::JudgedRange::End::kMinimum ? "minimum"
                                                      : "maximum";
}

/// Adds to each parameter which end of its range decides, and the range that the verdict bears.
void addRanges(const Scene& scene,
               const physics::Rates& rates,
               const physics::DeviceTraits& device,
               Json& report) {
  const auto judged = physics::judgeRanges(scene, rates, device);
  for (std::size_t p = 0; p < judged.size(); ++p) {
    Json& entry = report["parameters"][p];
    entry["decides"] = endName(judged[p].decides);
    if (judged[p].holds) {
      entry["largest_range"] = {judged[p].lowest, judged[p].highest};
    } else {
      entry["largest_range"] = "none: the verdict does not depend on it alone";
    }
  }
}

/// Ends with the program that `options` ask for, sharing the scene as in the station.
Json loadOf(const Scene& scene,
            const physics::Rates& rates,
            const physics::CompileOptions& options,
            LoadTimes& load) {
  load.begin("compile_s", "compile " + sizeText(scene));
  const auto instrument = physics::compile(shared(scene), rates, options);
  return load.finish(scene.mats.size() + scene.lias.size());
}

/// Reports the program that `compile` made of the scene, and why.
Json programOf(const physics::Instrument& instrument) {
  const physics::CompileOptions& options = instrument.options();
  return {{"precision", nameOf(options.precision)},
          {"isa", nameOf(options.isa)},
          {"threads", options.threads},
          {"parts", instrument.describe()}};
}

/// Adds the program that `options` ask for, and what both precisions cost.
void addProgram(const Scene& scene,
                const physics::Rates& rates,
                physics::CompileOptions options,
                Json& report) {
  const physics::Precision chosen = options.precision;
  Json costs = Json::object();
  for (const auto precision : {physics::Precision::kFloat, physics::Precision::kDouble}) {
    options.precision = precision;
    const auto instrument = physics::compile(shared(scene), rates, options);
    if (precision == chosen) {
      report["program"] = programOf(*instrument);
    }
    const Cost cost = measureCost(*instrument);
    costs[nameOf(precision)] = Json{{"state_bytes", instrument->stateSize()},
                                    {"tick_ns", cost.tick_ns},
                                    {"step_ns", cost.frame_ns},
                                    {"real_time_factor", cost.real_time_factor}};
  }
  report["cost"] = std::move(costs);
}

Json reportOn(const Scene& read,
              const physics::Settled& settled,
              const physics::Rates& rates,
              const physics::Certificate& certificate,
              const physics::CompileOptions& options,
              const DeviceChoice& device,
              Json load) {
  const Scene& scene = settled.scene;
  std::vector<std::string> warnings = scene.warnings;
  std::copy_if(
      certificate.findings.begin(), certificate.findings.end(), std::back_inserter(warnings),
      [](const std::string& finding) { return finding.find(": warning: ") != std::string::npos; });
  const std::string note = conversionNote(scene, rates);
  if (!note.empty()) {
    warnings.push_back(note);
  }
  Json report = {{"scene", scene.name},
                 {"about", aboutReport(scene.about)},
                 {"modules", scene.mats.size()},
                 {"audio_rate_hz", rates.audio_hz},
                 {"gestural_rate_hz", rates.gesturalHz()},
                 {"frames_per_tick", rates.ratio},
                 {"stability", stabilityReport(scene, rates, certificate)},
                 {"sections", sectionsReport(scene, rates, certificate)},
                 {"links", linksOf(scene)},
                 {"points", pointsOf(scene)},
                 {"selections", selectionsReport(scene)},
                 {"ports", portsReport(scene, rates, certificate, device.noise)},
                 {"agents", agentsReport(scene)},
                 {"inputs", inputsReport(scene)},
                 {"outputs", outputsReport(scene)},
                 {"parameters", parametersOf(scene)},
                 {"strings", stringsOf(scene, rates)},
                 {"bodies", bodiesOf(read)},
                 {"filters", filtersReport(scene, rates)},
                 {"load", std::move(load)}};
  addProgram(scene, rates, options, report);
  std::vector<std::string> notes = settled.notes;
  if (options.precision == physics::Precision::kFloat) {
    const std::vector<std::string> rounding = physics::notesOnRounding(scene, rates);
    notes.insert(notes.end(), rounding.begin(), rounding.end());
  } else {
    const std::vector<std::string> why = physics::notesOnPrecision(scene);
    notes.insert(notes.end(), why.begin(), why.end());
    report["program"]["a_body_moves_freely"] = !why.empty();
  }
  report["notes"] = std::move(notes);
  report["warnings"] = std::move(warnings);
  return report;
}

/// Adds what each slice meets and what is too much. \return what is refused
std::vector<std::string> addSlices(const tgr::EndEffectors& end_effectors,
                                   const Scene& scene,
                                   const physics::Rates& rates,
                                   const physics::Certificate& certificate,
                                   const physics::DeviceTraits& device,
                                   Json& report) {
  const station::HandFindings findings =
      station::judgeHands(scene, rates, certificate, device, end_effectors);
  std::vector<std::string> all = findings.refusals;
  all.insert(all.end(), findings.warnings.begin(), findings.warnings.end());
  report["slices"] = slicesReport(end_effectors, findings.slices);
  report["slice_findings"] = std::move(all);
  return findings.refusals;
}

/// Prints the report, then why the scene cannot be played. \return the exit code
int finish(const Json& report,
           bool is_brief,
           bool json,
           const std::string& file,
           physics::Verdict verdict,
           const std::vector<std::string>& refusals,
           const std::vector<std::string>& unstable_variants) {
  if (is_brief) {
    printBrief(report, std::cout);
  } else {
    tell(report, json);
  }
  for (const std::string& line : refusals) {
    std::cerr << line << '\n';
  }
  if (verdict == physics::Verdict::kUnstable) {
    std::cerr << file << ": unstable at these rates\n";
    return kRefused;
  }
  for (const std::string& variant : unstable_variants) {
    std::cerr << file << ": variant " << variant << " is unstable at these rates\n";
  }
  if (!unstable_variants.empty()) {
    return kRefused;
  }
  return refusals.empty() ? kSuccess : kFailure;
}

/// \return kFailure if one of them does not hold, or cannot be measured
int checkTruths(const CheckOptions& options) {
  const scene::ClaimingScene claims =
      scene::readTruthsFile(options.scene.scene, overridesOf(options.scene.set));
  if (claims.truths.empty()) {
    throw Exception(options.scene.scene + ": the scene has no 'truths'");
  }
  const physics::Rates rates = chosenRates(claims.scene, options.scene);
  const std::vector<JudgedTruth> judged =
      judgeTruths(claims, rates, chosenOptions(options.compile));
  return tellTruths(claims, judged, options.json) ? kSuccess : kFailure;
}

void addOptions(CLI::App& app, DeviceChoice& choice) {
  app.add_option("--device-damping", choice.traits.damping,
                 "of a slice by itself, N s/m (default: 2)")
      ->check(CLI::PositiveNumber);
  app.add_option("--device-delay", choice.traits.delay_ticks,
                 "from a position to the force that answers it, ticks (default: 1)")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--device-mass", choice.traits.mass, "of a slice, kg (default: 0.3)")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--sensor-noise", choice.noise.rms, "of a position, m rms (default: 0.5e-6)")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--sensor-quantum", choice.noise.quantum,
                 "to which a position is rounded, m (default: 1e-6)")
      ->check(CLI::NonNegativeNumber);
}

}  // namespace

void addOptions(CLI::App& app, CheckOptions& options) {
  addScene(app, options.scene.scene)->required();
  addOptions(app, options.scene);
  addOptions(app, options.compile);
  addTargetOption(app, options.target, "propose the cheapest setting that plays this accurately");
  addEndEffectorsOption(app, options.end_effectors);
  addOptions(app, options.device);
  app.add_flag("--verbose", options.verbose,
               "say all that is known of the scene, as YAML, not only what a musician asks first");
  app.add_flag(
      "--ranges", options.ranges,
      "as --verbose, with the ranges of the parameters also of a scene that is not quickly "
      "judged");
  app.add_flag("--json", options.json, "for a program to read");
  app.add_option("--filter-response", options.filter_response,
                 "write what the chaplets of the scene let through to this table")
      ->type_name("FILE.csv");
  app.add_option("--explain", options.explain,
                 "say where this module, link or other part comes from, and nothing else")
      ->type_name("NAME");
  addOptions(app, options.modes);
  addOptions(app, options.reach);
  addOptions(app, options.advice);
  app.add_flag("--truths", options.truths,
               "play and measure what the scene claims of itself, and nothing else");
}

int check(const CheckOptions& options) {
  if (options.truths) {
    return checkTruths(options);
  }
  const tgr::EndEffectors end_effectors = readEndEffectors(options.end_effectors);
  LoadTimes load;
  load.begin("read_s", "read " + options.scene.scene);
  const Scene scene = readScene(options.scene);
  if (!options.explain.empty()) {
    std::cout << explain(scene, options.explain);
    return kSuccess;
  }
  const physics::Rates rates = chosenRates(scene, options.scene);
  if (options.advice.is_wanted) {
    checkAdvice(scene, rates, options.device.traits, options.advice, options.json);
    return kSuccess;
  }
  load.begin("settle_s", "settle " + sizeText(scene));
  const std::clock_t begun = std::clock();
  const physics::Settled settled = physics::settle(scene, rates);
  if (options.modes.are_wanted) {
    checkModes(scene, settled.scene, rates, options.modes, options.json);
    return kSuccess;
  }
  if (options.reach.is_wanted) {
    checkReach(settled.scene, end_effectors, options.reach, options.json);
    return kSuccess;
  }
  load.begin("certify_s", "certify " + sizeText(settled.scene));
  physics::DeviceTraits device = options.device.traits;
  device.taken_ports = tgr::takenPorts(settled.scene, end_effectors);
  const physics::CompileOptions compile =
      withPrecision(chosenOptions(options.compile), settled.scene);
  const physics::Certificate certificate =
      inPrecision(physics::certify(settled.scene, rates, device), settled.scene, compile);
  const double cpu_s = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  Json report = reportOn(scene, settled, rates, certificate, compile, options.device,
                         loadOf(settled.scene, rates, compile, load));
  for (std::string& line : reachFindings(settled.scene, device.taken_ports, options.reach)) {
    report["warnings"].push_back(std::move(line));
  }
  const bool is_brief = !options.json && !options.verbose && !options.ranges;
  const bool is_quick = static_cast<double>(scene.parameters.size()) * cpu_s <= kQuicklyJudgedS;
  if (options.ranges || (!is_brief && is_quick)) {
    addRanges(scene, rates, device, report);
  } else if (!is_brief) {
    report["ranges"] = "not judged: some hundred verdicts for each parameter, of " +
                       physics::shortly(cpu_s) + " s each; ask with --ranges";
  }
  if (!options.target.empty()) {
    report["target"] = targetReport(readScene(options.scene), rates, compile, options.target,
                                    freedomOf(options.scene, options.compile));
  }
  std::vector<std::string> refusals = refusedPorts(certificate);
  if (!options.end_effectors.empty()) {
    const auto of_slices =
        addSlices(end_effectors, settled.scene, rates, certificate, device, report);
    refusals.insert(refusals.end(), of_slices.begin(), of_slices.end());
  }
  if (!options.filter_response.empty()) {
    writeFilterResponse(options.filter_response, settled.scene, rates);
  }
  std::vector<std::string> unstable;
  if (options.scene.variant.empty() && !scene.variants.empty()) {
    report["variants"] = variantsReport(scene.variants, options.scene, device, unstable);
  }
  return finish(report, is_brief, options.json, settled.scene.file, certificate.verdict, refusals,
                unstable);
}

}  // namespace ergotic::tools
