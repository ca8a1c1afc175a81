// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/settling/settle.hpp"
#include "tools/lib/check_report.hpp"

namespace ergotic::tools {
namespace {

Json listOf(const Eigen::Vector3d& place) {
  return {place.x(), place.y(), place.z()};
}

}  // namespace

Json aboutReport(const scene::About& about) {
  Json report = Json::object();
  const std::pair<const char*, const std::string&> words[] = {
      {"title", about.title},     {"author", about.author},
      {"licence", about.licence}, {"description", about.description},
      {"play", about.play},
  };
  for (const auto& [key, text] : words) {
    if (!text.empty()) {
      report[key] = text;
    }
  }
  for (const auto& [slices, what] : about.hands) {
    report["hands"][slices] = what;
  }
  if (!about.sources.empty()) {
    report["sources"] = about.sources;
  }
  if (about.picture) {
    report["picture"] = {{"from", listOf(about.picture->from)}, {"at", listOf(about.picture->at)}};
  }
  return report;
}

Json selectionsReport(const scene::Scene& scene) {
  Json report = Json::array();
  for (const scene::Selected& selected : scene.selections) {
    report.push_back({{"means", selected.text}, {"modules", selected.count}});
  }
  return report;
}

Json variantsReport(const std::vector<std::string>& variants,
                    const SceneOptions& options,
                    const physics::DeviceTraits& device,
                    std::vector<std::string>& unstable) {
  Json report = Json::array();
  for (const std::string& name : variants) {
    SceneOptions asked = options;
    asked.variant = name;
    const scene::Scene scene = readScene(asked);
    const physics::Rates rates = chosenRates(scene, asked);
    const physics::Settled settled = physics::settle(scene, rates);
    const physics::Certificate certificate = physics::certify(settled.scene, rates, device);
    report.push_back({{"name", name}, {"verdict", physics::toString(certificate.verdict)}});
    if (certificate.verdict == physics::Verdict::kUnstable) {
      unstable.push_back(name);
    }
  }
  return report;
}

}  // namespace ergotic::tools
