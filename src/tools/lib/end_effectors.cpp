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

Report slicesReport(const tgr::EndEffectors& end_effectors,
                    const std::vector<tgr::RenderedStiffness>& rendered) {
  Report report = Report::list();
  for (const tgr::RenderedStiffness& slice : rendered) {
    const auto above = std::find_if(end_effectors.list.begin(), end_effectors.list.end(),
                                    [&slice](const tgr::EndEffectorConfig& config) {
                                      return std::find(config.slices.begin(), config.slices.end(),
                                                       slice.slice) != config.slices.end();
                                    });
    Report entry = Report::map();
    entry.add("slice", Report::number(slice.slice));
    if (above != end_effectors.list.end()) {
      entry.add("end_effector", Report::text(above->name));
    }
    report.add(std::move(entry.add("stiffness_n_per_m", Report::number(slice.stiffness))
                             .add("together_n_per_m", Report::number(slice.together))
                             .add("passive_up_to_n_per_m", Report::number(slice.limit))));
  }
  return report;
}

}  // namespace ergotic::tools
