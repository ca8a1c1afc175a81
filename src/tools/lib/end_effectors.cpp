// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/end_effectors.hpp"

#include <algorithm>

#include "files/read_file.hpp"
#include "scene/limits.hpp"

namespace ergotic::tools {

tgr::EndEffectors readEndEffectors(const std::string& file) {
  if (file.empty()) {
    return {};
  }
  return tgr::readEndEffectors(files::readFile(file, scene::kMaxTextBytes), file);
}

Json slicesReport(const tgr::EndEffectors& end_effectors,
                  const std::vector<station::SliceLoad>& slices) {
  Json report = Json::array();
  for (const station::SliceLoad& slice : slices) {
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
    entry["passive_up_to_n_per_m"] = slice.stiffness_limit;
    entry["damping_n_s_per_m"] = slice.damping;
    entry["passive_up_to_n_s_per_m"] = slice.damping_limit;
    report.push_back(std::move(entry));
  }
  return report;
}

}  // namespace ergotic::tools
