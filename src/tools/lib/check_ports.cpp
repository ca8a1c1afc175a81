// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/check_ports.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "scene/limits.hpp"
#include "scene/names.hpp"

namespace ergotic::tools {
namespace {

using scene::Scene;

const scene::Mat& matAt(const Scene& scene, int index) {
  return scene.mats[static_cast<std::size_t>(index)];
}

std::string axisOf(const scene::Port& port) {
  constexpr char kAxes[] = {'x', 'y', 'z'};
  return {kAxes[port.axis]};
}

Report noiseOf(const scene::Port& port, const physics::NoiseFloor& floor) {
  Report report = Report::map();
  report.add("position_m", Report::number(floor.position))
      .add("force_n", Report::number(floor.force));
  if (port.filter >= 0) {
    report.add("unfiltered_force_n", Report::number(floor.unfiltered))
        .add("behind_filter_m", Report::number(floor.behind));
  }
  return report;
}

/// The spring and damper that the readers give every agent.
void addHand(const Scene& scene, const scene::Port& port, Report& entry) {
  const auto hand = std::find_if(scene.lias.begin(), scene.lias.end(), [&](const scene::Lia& lia) {
    return lia.a == port.mat || lia.b == port.mat;
  });
  if (hand != scene.lias.end()) {
    entry.add("module", Report::text(matAt(scene, hand->a == port.mat ? hand->b : hand->a).name))
        .add("stiffness_n_per_m", Report::number(scene.valueOf(hand->stiffness)))
        .add("damping_n_s_per_m", Report::number(scene.valueOf(hand->damping)));
  }
}

}  // namespace

Report portsReport(const Scene& scene,
                   const physics::Rates& rates,
                   const physics::Certificate& certificate,
                   const physics::SensorNoise& noise) {
  Report report = Report::list();
  const std::vector<physics::NoiseFloor> floors = physics::noiseFloors(scene, rates, noise);
  for (std::size_t i = 0; i < certificate.ports.size(); ++i) {
    const physics::PortCertificate& met = certificate.ports[i];
    const scene::Port& port = scene.ports[static_cast<std::size_t>(met.port)];
    Report entry = Report::map();
    entry.add("name", Report::text(port.name))
        .add("module", Report::text(matAt(scene, port.mat).name))
        .add("axis", Report::text(axisOf(port)));
    if (port.slice >= 0) {
      entry.add("slice", Report::number(port.slice));
    }
    report.add(std::move(entry.add("offset_m", Report::number(port.offset))
                             .add("position_scale", Report::number(port.position_scale))
                             .add("force_scale", Report::number(port.force_scale))
                             .add("stiffness_n_per_m", Report::number(met.stiffness))
                             .add("passive_up_to_n_per_m", Report::number(met.limit))
                             .add("noise", noiseOf(port, floors[i]))));
  }
  return report;
}

Report agentsReport(const Scene& scene) {
  Report report = Report::list();
  for (const scene::Port& port : scene.ports) {
    if (port.agent < 0) {
      continue;
    }
    const scene::Agent& agent = scene.agents[static_cast<std::size_t>(port.agent)];
    Report entry = Report::map();
    entry.add("name", Report::text(agent.name)).add("axis", Report::text(axisOf(port)));
    addHand(scene, port, entry);
    entry.add("points", Report::number(agent.knots.size()))
        .add("ends_s", Report::number(agent.knots.back().first));
    if (agent.period_s > 0.0) {
      entry.add("period_s", Report::number(agent.period_s));
    }
    report.add(std::move(entry));
  }
  return report;
}

std::vector<std::string> refusedPorts(const Scene& scene, const physics::Certificate& certificate) {
  std::vector<std::string> refused;
  for (const physics::PortCertificate& met : certificate.ports) {
    const scene::Port& port = scene.ports[static_cast<std::size_t>(met.port)];
    if (met.is_refused) {
      refused.push_back(
          scene.file + ":" + std::to_string(port.place.line) + ":" +
          std::to_string(port.place.column) + ": error: port " + scene::quoted(port.name) +
          " renders up to " + scene::numberText(met.stiffness) +
          " N/m at its slice, which is passive up to " + scene::numberText(met.limit) +
          " N/m: it will buzz or jump. Soften what it touches, lower its "
          "force_scale, or raise the gestural rate");
    }
  }
  return refused;
}

}  // namespace ergotic::tools
