// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include "at.hpp"
#include "tools/lib/check_report.hpp"

namespace ergotic::tools {
namespace {

using scene::Scene;

/// Reports the mover of a point, along or across.
void tellWay(const Scene& scene,
             const scene::Connection::Way& way,
             const std::string& suffix,
             Json& entry) {
  if (way.at.parameter >= 0) {
    const auto moved_by = static_cast<std::size_t>(way.at.parameter);
    entry["parameter" + suffix] = scene.parameters[moved_by].name;
  }
  if (way.guide >= 0) {
    entry["guide" + suffix] = scene.mats[at(way.guide)].name;
  }
}

}  // namespace

Json pointsOf(const Scene& scene) {
  Json report = Json::array();
  for (const scene::Connection& point : scene.connections) {
    const scene::Grid& grid = scene.grids[static_cast<std::size_t>(point.grid)];
    Json entry = {{"name", scene.mats[at(point.mat)].name},
                  {"on", grid.name},
                  {"along", scene.valueOf(point.along.at)}};
    if (grid.rows > 1) {
      entry["across"] = scene.valueOf(point.across.at);
    }
    tellWay(scene, point.along, "", entry);
    tellWay(scene, point.across, "_across", entry);
    report.push_back(std::move(entry));
  }
  for (const scene::Tap& tap : scene.taps) {
    Json entry = {{"name", scene.mats[at(tap.mat)].name}};
    double mobility = 0.0;
    for (const scene::Tap::Share& share : tap.shares) {
      const scene::Mat& mat = scene.mats[at(share.mat)];
      const bool is_ground = mat.type == scene::MatType::kGround;
      mobility += is_ground ? 0.0 : share.weight * share.weight / scene.valueOf(mat.mass);
      entry["of"].push_back(mat.name);
      entry["weights"].push_back(share.weight);
    }
    if (mobility > 0.0) {
      entry["mass"] = 1.0 / mobility;
    }
    report.push_back(std::move(entry));
  }
  return report;
}

}  // namespace ergotic::tools
