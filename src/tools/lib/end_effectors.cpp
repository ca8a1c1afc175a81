// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/end_effectors.hpp"

#include <algorithm>

#include "ergotic/exception.hpp"
#include "scene/text/source_text.hpp"

namespace ergotic::tools {

tgr::EndEffectors readEndEffectors(const std::string& file) {
  if (file.empty()) {
    return {};
  }
  const auto text = scene::readBytes(file);
  if (!text) {
    throw Exception(file + ": cannot be read");
  }
  return tgr::readEndEffectors(*text, file);
}

std::vector<tgr::RenderedStiffness> renderedStiffness(const scene::Scene& scene,
                                                      const physics::Rates& rates,
                                                      const physics::Certificate& certificate,
                                                      const physics::DeviceTraits& device,
                                                      const tgr::EndEffectors& end_effectors) {
  std::vector<double> stiffness(scene.ports.size());
  for (const physics::PortCertificate& port : certificate.ports) {
    stiffness[static_cast<std::size_t>(port.port)] = port.stiffness;
  }
  return tgr::renderedStiffness(scene, end_effectors, stiffness, device.damping, rates.gesturalHz(),
                                device.delay_ticks);
}

Json slicesReport(const tgr::EndEffectors& end_effectors,
                  const std::vector<tgr::RenderedStiffness>& rendered) {
  Json report = Json::array();
  for (const tgr::RenderedStiffness& slice : rendered) {
    const auto above = std::find_if(end_effectors.list.begin(), end_effectors.list.end(),
                                    [&slice](const tgr::EndEffectorConfig& config) {
                                      return std::find(config.slices.begin(), config.slices.end(),
                                                       slice.slice) != config.slices.end();
                                    });
    Json entry = {{"slice", slice.slice}};
    if (above != end_effectors.list.end()) {
      entry["end_effector"] = above->name;
    }
    entry["stiffness_n_per_m"] = slice.stiffness;
    entry["together_n_per_m"] = slice.together;
    entry["passive_up_to_n_per_m"] = slice.limit;
    report.push_back(std::move(entry));
  }
  return report;
}

}  // namespace ergotic::tools
