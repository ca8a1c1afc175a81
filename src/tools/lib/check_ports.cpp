// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <utility>

#include "at.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "tools/lib/check_report.hpp"

namespace ergotic::tools {
namespace {

using scene::Scene;

/// Inputs or outputs.
template <class Channel>
Json channelOf(const Scene& scene, const Channel& channel, const scene::Mat& mat) {
  return {{"name", channel.name},
          {"quantity", channel.quantity},
          {"module", mat.name},
          {"channel", channel.channel + 1},
          {"gain", scene.valueOf(channel.gain)}};
}

std::string axisOf(const scene::Port& port) {
  constexpr char kAxes[] = {'x', 'y', 'z'};
  return {kAxes[port.axis]};
}

Json noiseOf(const scene::Port& port, const physics::NoiseFloor& floor) {
  Json report = {{"position_m", floor.position}, {"force_n", floor.force}};
  if (port.filter >= 0) {
    report["unfiltered_force_n"] = floor.unfiltered;
    report["behind_filter_m"] = floor.behind;
  }
  return report;
}

/// The spring and damper that the readers give every agent.
void addHand(const Scene& scene, const scene::Port& port, Json& entry) {
  const auto hand = std::find_if(scene.lias.begin(), scene.lias.end(), [&](const scene::Lia& lia) {
    return lia.a == port.mat || lia.b == port.mat;
  });
  if (hand != scene.lias.end()) {
    entry["module"] = scene.mats[at(hand->a == port.mat ? hand->b : hand->a)].name;
    entry["stiffness_n_per_m"] = scene.valueOf(hand->stiffness);
    entry["damping_n_s_per_m"] = scene.valueOf(hand->damping);
  }
}

}  // namespace

Json portsReport(const Scene& scene,
                 const physics::Rates& rates,
                 const physics::Certificate& certificate,
                 const physics::SensorNoise& noise) {
  Json report = Json::array();
  const std::vector<physics::NoiseFloor> floors = physics::noiseFloors(scene, rates, noise);
  for (std::size_t i = 0; i < certificate.ports.size(); ++i) {
    const physics::PortCertificate& met = certificate.ports[i];
    const scene::Port& port = scene.ports[static_cast<std::size_t>(met.port)];
    Json entry = {
        {"name", port.name}, {"module", scene.mats[at(port.mat)].name}, {"axis", axisOf(port)}};
    if (port.slice >= 0) {
      entry["slice"] = port.slice;
    }
    if (scene.mats[at(port.mat)].coupling == scene::Coupling::kSmooth) {
      entry["coupling"] = "smooth";
    }
    entry["offset_m"] = port.offset;
    entry["position_scale"] = port.position_scale;
    entry["force_scale"] = port.force_scale;
    entry["stiffness_n_per_m"] = met.stiffness;
    entry["passive_up_to_n_per_m"] = met.stiffness_limit;
    entry["damping_n_s_per_m"] = met.damping;
    entry["passive_up_to_n_s_per_m"] = met.damping_limit;
    entry["noise"] = noiseOf(port, floors[i]);
    report.push_back(std::move(entry));
  }
  return report;
}

Json agentsReport(const Scene& scene) {
  Json report = Json::array();
  for (const scene::Port& port : scene.ports) {
    if (port.agent < 0) {
      continue;
    }
    const scene::Agent& agent = scene.agents[static_cast<std::size_t>(port.agent)];
    Json entry = {{"name", agent.name}, {"axis", axisOf(port)}};
    addHand(scene, port, entry);
    entry["points"] = agent.knots.size();
    entry["ends_s"] = agent.knots.back().first;
    if (agent.period_s > 0.0) {
      entry["period_s"] = agent.period_s;
    }
    report.push_back(std::move(entry));
  }
  return report;
}

std::vector<std::string> refusedPorts(const physics::Certificate& certificate) {
  std::vector<std::string> refused;
  for (const physics::PortCertificate& met : certificate.ports) {
    if (met.is_judged && met.level == physics::HandLevel::kRefused) {
      refused.push_back(met.finding);
    }
  }
  return refused;
}

Json inputsReport(const Scene& scene) {
  Json report = Json::array();
  for (const scene::Input& input : scene.inputs) {
    report.push_back(channelOf(scene, input, scene.mats[at(input.mat)]));
  }
  return report;
}

Json outputsReport(const Scene& scene) {
  Json report = Json::array();
  for (const scene::Output& output : scene.outputs) {
    report.push_back(channelOf(scene, output, scene.mats[at(output.point.mat)]));
  }
  return report;
}

}  // namespace ergotic::tools
