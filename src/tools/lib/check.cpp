// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/check.hpp"

#include <algorithm>
#include <iostream>
#include <map>
#include <utility>

#include "ergotic/physics/certify.hpp"
#include "ergotic/physics/instrument.hpp"
#include "ergotic/physics/settle.hpp"
#include "ergotic/scene/pitch.hpp"
#include "tools/lib/check_filters.hpp"
#include "tools/lib/cost.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {
namespace {

using scene::Scene;

const char* nameOf(scene::MatType type) {
  switch (type) {
    case scene::MatType::kMass:
      return "mass";
    case scene::MatType::kGround:
      return "ground";
    case scene::MatType::kCell:
      return "cell";
    case scene::MatType::kDriven:
      return "driven";
    case scene::MatType::kSlice:
      return "slice";
    case scene::MatType::kPoint:
      return "point";
  }
  return "";
}

const char* nameOf(scene::LiaType type) {
  switch (type) {
    case scene::LiaType::kSpringDamper:
      return "spring-damper";
    case scene::LiaType::kContact:
      return "contact";
    case scene::LiaType::kQuadratic:
      return "quadratic spring";
    case scene::LiaType::kCubic:
      return "cubic spring";
    case scene::LiaType::kClippedCubic:
      return "clipped cubic spring";
    case scene::LiaType::kCubicContact:
      return "cubic contact";
    case scene::LiaType::kPluck:
      return "pluck";
    case scene::LiaType::kBow:
      return "bow";
    case scene::LiaType::kSmoothBow:
      return "smooth bow";
    case scene::LiaType::kPowerContact:
      return "power-law contact";
    case scene::LiaType::kTable:
      return "table";
    case scene::LiaType::kConditional:
      return "conditional spring-damper";
  }
  return "";
}

const char* nameOf(scene::Quantity quantity) {
  switch (quantity) {
    case scene::Quantity::kPosition:
      return "position";
    case scene::Quantity::kVelocity:
      return "velocity";
    case scene::Quantity::kForce:
      return "force";
  }
  return "";
}

const char* nameOf(scene::Geometry geometry) {
  switch (geometry) {
    case scene::Geometry::kScalar:
      return "scalar";
    case scene::Geometry::kLine:
      return "1D";
    case scene::Geometry::kPlane:
      return "2D";
    case scene::Geometry::kSpace:
      return "3D";
  }
  return "";
}

const scene::Mat& matAt(const Scene& scene, int index) {
  return scene.mats[static_cast<std::size_t>(index)];
}

Report counts(const std::map<std::string, std::size_t>& by_name) {
  Report report = Report::map();
  for (const auto& [name, count] : by_name) {
    report.add(name, Report::count(count));
  }
  return report;
}

Report vectorOf(const Eigen::Vector3d& v) {
  Report report = Report::list();
  for (const double component : {v.x(), v.y(), v.z()}) {
    report.add(Report::number(component));
  }
  return report;
}

Report modulesOf(const Scene& scene, int section) {
  std::map<std::string, std::size_t> by_type;
  for (const scene::Mat& mat : scene.mats) {
    by_type[nameOf(mat.type)] += mat.section == section ? 1 : 0;
  }
  for (auto type = by_type.begin(); type != by_type.end();) {
    type = type->second == 0 ? by_type.erase(type) : std::next(type);
  }
  return counts(by_type);
}

std::string steppingOf(const scene::Section& section) {
  if (section.gestural) {
    return "once a tick";
  }
  return section.divisor == 1 ? "at audio rate"
                              : "every " + std::to_string(section.divisor) + " audio frames";
}

Report sectionReport(const Scene& scene,
                     const physics::Rates& rates,
                     const physics::Certificate& certificate,
                     int index) {
  const scene::Section& section = scene.sections[static_cast<std::size_t>(index)];
  Report report = Report::map();
  report.add("name", Report::text(section.name))
      .add("rate_hz", Report::number(rates.audio_hz / physics::divisorOf(section, rates)))
      .add("stepped", Report::text(steppingOf(section)))
      .add("geometry", Report::text(nameOf(section.geometry)))
      .add("axis", vectorOf(section.pose.linear().col(0)))
      .add("origin_m", vectorOf(section.pose.translation()))
      .add("modules", modulesOf(scene, index));
  for (const physics::SectionCertificate& c : certificate.sections) {
    if (c.section == index) {
      report.add("lambda", Report::number(c.lambda))
          .add("link_bound", Report::number(c.link_bound))
          .add("lowest_stable_rate_hz", Report::number(c.stable_rate_hz));
    }
  }
  return report;
}

Report linksOf(const Scene& scene) {
  std::map<std::string, std::size_t> by_type;
  std::size_t between_sections = 0;
  std::size_t guarded = 0;
  for (const scene::Lia& lia : scene.lias) {
    ++by_type[nameOf(lia.type)];
    const bool across = matAt(scene, lia.a).section != matAt(scene, lia.b).section;
    between_sections += across ? 1 : 0;
    guarded += lia.scheme == scene::Scheme::kGuarded ? 1 : 0;
  }
  Report report = counts(by_type);
  if (between_sections > 0) {
    report.add("of them between sections", Report::count(between_sections));
  }
  if (guarded > 0) {
    report.add("of them guarded", Report::count(guarded));
  }
  return report;
}

Report portsOf(const Scene& scene) {
  Report report = Report::list();
  for (const scene::Port& port : scene.ports) {
    report.add(Report::map()
                   .add("name", Report::text(port.name))
                   .add("slice", Report::number(port.slice))
                   .add("module", Report::text(matAt(scene, port.mat).name))
                   .add("offset_m", Report::number(port.offset))
                   .add("position_scale", Report::number(port.position_scale))
                   .add("force_scale", Report::number(port.force_scale)));
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

Report costOf(const Scene& scene, const physics::Rates& rates) {
  Report report = Report::map();
  for (const auto precision : {physics::Precision::kFloat, physics::Precision::kDouble}) {
    const auto instrument = physics::compile(scene, rates, precision);
    const Cost cost = measureCost(*instrument);
    report.add(precision == physics::Precision::kFloat ? "float" : "double",
               Report::map()
                   .add("state_bytes", Report::count(instrument->stateSize()))
                   .add("tick_ns", Report::number(cost.tick_ns))
                   .add("step_ns", Report::number(cost.frame_ns))
                   .add("real_time_factor", Report::number(cost.real_time_factor)));
  }
  return report;
}

Report texts(const std::vector<std::string>& lines) {
  Report report = Report::list();
  for (const std::string& line : lines) {
    report.add(Report::text(line));
  }
  return report;
}

Report verdictOf(const physics::Certificate& certificate) {
  return Report::map()
      .add("verdict", Report::text(physics::toString(certificate.verdict)))
      .add("margin", Report::number(certificate.margin()))
      .add("findings", texts(certificate.findings));
}

double lowestStableAudioRate(const Scene& scene,
                             const physics::Rates& rates,
                             const physics::Certificate& certificate) {
  double lowest = 0.0;
  for (const physics::SectionCertificate& c : certificate.sections) {
    const scene::Section& section = scene.sections[static_cast<std::size_t>(c.section)];
    lowest = std::max(lowest, c.stable_rate_hz * physics::divisorOf(section, rates));
  }
  return lowest;
}

Report reportOn(const physics::Settled& settled,
                const physics::Rates& rates,
                const physics::Certificate& certificate) {
  const Scene& scene = settled.scene;
  Report sections = Report::list();
  for (std::size_t i = 0; i < scene.sections.size(); ++i) {
    sections.add(sectionReport(scene, rates, certificate, static_cast<int>(i)));
  }
  std::vector<std::string> warnings = scene.warnings;
  const std::string note = conversionNote(scene, rates);
  if (!note.empty()) {
    warnings.push_back(note);
  }
  return Report::map()
      .add("scene", Report::text(scene.name))
      .add("modules", Report::count(scene.mats.size()))
      .add("links", Report::count(scene.lias.size()))
      .add("audio_rate_hz", Report::number(rates.audio_hz))
      .add("gestural_rate_hz", Report::number(rates.gesturalHz()))
      .add("frames_per_tick", Report::number(rates.ratio))
      .add("stability", verdictOf(certificate))
      .add("lowest_stable_audio_rate_hz",
           Report::number(lowestStableAudioRate(scene, rates, certificate)))
      .add("sections", std::move(sections))
      .add("link_types", linksOf(scene))
      .add("ports", portsOf(scene))
      .add("inputs", inputsOf(scene))
      .add("outputs", outputsOf(scene))
      .add("parameters", parametersOf(scene))
      .add("strings", stringsOf(scene, rates))
      .add("filters", filtersReport(scene, rates))
      .add("cost", costOf(scene, rates))
      .add("notes", texts(settled.notes))
      .add("warnings", texts(warnings));
}

}  // namespace

void addOptions(CLI::App& app, CheckOptions& options) {
  app.add_option("scene", options.scene.scene, "scene file, .yaml or .mdl")
      ->type_name("SCENE")
      ->required();
  addOptions(app, options.scene);
  app.add_flag("--json", options.json, "for a program to read");
  app.add_option("--filter-response", options.filter_response,
                 "write what the chaplets of the scene let through to this table")
      ->type_name("FILE.csv");
}

int check(const CheckOptions& options) {
  Scene scene = readScene(options.scene);
  const physics::Rates rates = chosenRates(scene, options.scene);
  const physics::Settled settled = physics::settle(std::move(scene), rates);
  const physics::Certificate certificate = physics::certify(settled.scene, rates);
  const Report report = reportOn(settled, rates, certificate);
  if (!options.filter_response.empty()) {
    writeFilterResponse(options.filter_response, settled.scene, rates);
  }
  if (options.json) {
    report.printJson(std::cout);
    std::cout << '\n';
  } else {
    report.printText(std::cout);
  }
  if (certificate.verdict != physics::Verdict::kUnstable) {
    return kSuccess;
  }
  std::cerr << settled.scene.file << ": unstable at these rates\n";
  return kRefused;
}

}  // namespace ergotic::tools
