// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/check_sections.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>

#include "tools/lib/check_names.hpp"

namespace ergotic::tools {
namespace {

using physics::SectionCertificate;
using physics::Verdict;
using scene::Scene;

constexpr double kStableLambda = 4.0;

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
    if (mat.section == section) {
      ++by_type[nameOf(mat.type)];
    }
  }
  Report report = Report::map();
  for (const auto& [type, count] : by_type) {
    report.add(type, Report::number(count));
  }
  return report;
}

std::string steppingOf(const scene::Section& section) {
  if (section.gestural) {
    return "once a tick";
  }
  return section.divisor == 1 ? "at audio rate"
                              : "every " + std::to_string(section.divisor) + " audio frames";
}

Report stabilityOf(const Scene& scene, const SectionCertificate& certificate) {
  Report report = Report::map();
  report.add("lambda", Report::number(certificate.lambda))
      .add("margin", Report::number(1.0 - certificate.lambda / kStableLambda))
      .add("lowest_stable_rate_hz", Report::number(certificate.stable_rate_hz));
  if (certificate.worst_lia >= 0) {
    const auto link = static_cast<std::size_t>(certificate.worst_lia);
    report.add("worst_link", Report::text(scene.lias[link].name));
  }
  if (certificate.worst_mat >= 0) {
    const auto module = static_cast<std::size_t>(certificate.worst_mat);
    report.add("worst_module", Report::text(scene.mats[module].name));
  }
  return report;
}

double lowestStableAudioRate(const Scene& scene,
                             const physics::Rates& rates,
                             const physics::Certificate& certificate) {
  double lowest = 0.0;
  for (const SectionCertificate& c : certificate.sections) {
    const scene::Section& section = scene.sections[static_cast<std::size_t>(c.section)];
    lowest = std::max(lowest, c.stable_rate_hz * physics::divisorOf(section, rates));
  }
  return lowest;
}

/// Soft contacts and the like, worked out explicitly: passive but for a little at every hit.
bool switchesExplicitly(const Scene& scene) {
  return std::any_of(scene.lias.begin(), scene.lias.end(), [](const scene::Lia& lia) {
    return lia.scheme == scene::Scheme::kExplicit && lia.type != scene::LiaType::kSpringDamper;
  });
}

std::string adviceOn(const Scene& scene, Verdict verdict, double lowest_rate_hz) {
  const auto whole = std::to_string(std::llround(std::ceil(lowest_rate_hz)));
  switch (verdict) {
    case Verdict::kPassive:
      return switchesExplicitly(scene)
                 ? "stable: its explicit contacts are so soft that a hit gives hardly anything"
                 : "it cannot blow up, whatever the hands do";
    case Verdict::kBounded:
      return "it cannot blow up: what plucks or bows gives energy, but only so much";
    case Verdict::kUnproven:
      return "nothing bounds it: see the findings, or play it with allow_unproven at your own risk";
    case Verdict::kUnstable:
      return "it blows up: see the findings, soften what they name" +
             (lowest_rate_hz > 0.0 ? ", or take an audio rate of " + whole + " Hz or more"
                                   : std::string());
  }
  return "";
}

}  // namespace

Report sectionsReport(const Scene& scene,
                      const physics::Rates& rates,
                      const physics::Certificate& certificate) {
  Report sections = Report::list();
  for (std::size_t s = 0; s < scene.sections.size(); ++s) {
    const scene::Section& section = scene.sections[s];
    Report report = Report::map();
    report.add("name", Report::text(section.name))
        .add("geometry", Report::text(nameOf(section.geometry)))
        .add("rate_hz", Report::number(rates.audio_hz / physics::divisorOf(section, rates)))
        .add("stepped", Report::text(steppingOf(section)))
        .add("axis", vectorOf(section.pose.linear().col(0)))
        .add("origin_m", vectorOf(section.pose.translation()))
        .add("modules", modulesOf(scene, static_cast<int>(s)));
    for (const SectionCertificate& c : certificate.sections) {
      if (c.section == static_cast<int>(s)) {
        report.add("stability", stabilityOf(scene, c));
      }
    }
    sections.add(std::move(report));
  }
  return sections;
}

Report stabilityReport(const Scene& scene,
                       const physics::Rates& rates,
                       const physics::Certificate& certificate) {
  const double lowest_rate_hz = lowestStableAudioRate(scene, rates, certificate);
  Report findings = Report::list();
  for (const std::string& finding : certificate.findings) {
    findings.add(Report::text(finding));
  }
  return Report::map()
      .add("verdict", Report::text(physics::toString(certificate.verdict)))
      .add("advice", Report::text(adviceOn(scene, certificate.verdict, lowest_rate_hz)))
      .add("margin", Report::number(certificate.margin()))
      .add("lowest_stable_audio_rate_hz", Report::number(lowest_rate_hz))
      .add("findings", std::move(findings));
}

}  // namespace ergotic::tools
