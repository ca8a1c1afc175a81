// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>

#include "tools/lib/check_report.hpp"
#include "tools/lib/report_names.hpp"

namespace ergotic::tools {
namespace {

using physics::SectionCertificate;
using physics::Verdict;
using scene::Scene;

constexpr double kStableLambda = 4.0;

Json vectorOf(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json modulesOf(const Scene& scene, int section) {
  std::map<std::string, std::size_t> by_type;
  for (const scene::Mat& mat : scene.mats) {
    if (mat.section == section) {
      ++by_type[Json(mat.type).get<std::string>()];
    }
  }
  return by_type;
}

std::string steppingOf(const scene::Section& section) {
  if (section.gestural) {
    return "once a tick";
  }
  return section.divisor == 1 ? "at audio rate"
                              : "every " + std::to_string(section.divisor) + " audio frames";
}

Json stabilityOf(const Scene& scene, const SectionCertificate& certificate) {
  Json report = {{"lambda", certificate.lambda},
                 {"margin", 1.0 - certificate.lambda / kStableLambda},
                 {"lowest_stable_rate_hz", certificate.stable_rate_hz}};
  if (certificate.worst_lia >= 0) {
    const auto link = static_cast<std::size_t>(certificate.worst_lia);
    report["worst_link"] = scene.lias[link].name;
  }
  if (certificate.worst_mat >= 0) {
    const auto module = static_cast<std::size_t>(certificate.worst_mat);
    report["worst_module"] = scene.mats[module].name;
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

/// Turning one in time with what swings works on it like a hand, and nothing bounds that.
std::string whileStill(const Scene& scene) {
  return scene.parameters.empty() ? "" : ", as long as its parameters stand still";
}

std::string adviceOnSection(const Scene& scene, Verdict verdict, double lowest_rate_hz) {
  const auto whole = std::to_string(std::llround(std::ceil(lowest_rate_hz)));
  switch (verdict) {
    case Verdict::kPassive:
      return "it cannot blow up, whatever the hands do" + whileStill(scene);
    case Verdict::kBounded:
      return "it cannot blow up: what plucks, bows or moves gives energy, but only so much" +
             whileStill(scene);
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

Json sectionsReport(const Scene& scene,
                    const physics::Rates& rates,
                    const physics::Certificate& certificate) {
  Json sections = Json::array();
  for (std::size_t s = 0; s < scene.sections.size(); ++s) {
    const scene::Section& section = scene.sections[s];
    Json report = {{"name", section.name},
                   {"geometry", section.geometry},
                   {"rate_hz", rates.audio_hz / physics::divisorOf(section, rates)},
                   {"stepped", steppingOf(section)},
                   {"axis", vectorOf(section.pose.linear().col(0))},
                   {"origin_m", vectorOf(section.pose.translation())},
                   {"modules", modulesOf(scene, static_cast<int>(s))}};
    for (const SectionCertificate& c : certificate.sections) {
      if (c.section == static_cast<int>(s)) {
        report["stability"] = stabilityOf(scene, c);
      }
    }
    sections.push_back(std::move(report));
  }
  return sections;
}

Json stabilityReport(const Scene& scene,
                     const physics::Rates& rates,
                     const physics::Certificate& certificate) {
  const double lowest_rate_hz = lowestStableAudioRate(scene, rates, certificate);
  return {{"verdict", physics::toString(certificate.verdict)},
          {"advice", adviceOnSection(scene, certificate.verdict, lowest_rate_hz)},
          {"margin", certificate.margin()},
          {"lowest_stable_audio_rate_hz", lowest_rate_hz},
          {"findings", certificate.findings}};
}

}  // namespace ergotic::tools
