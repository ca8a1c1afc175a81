// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/tgr/rig.hpp"
#include "tools/lib/report.hpp"

namespace ergotic::tools {

/// \param file  path; empty: none
/// \throws TextError from the file, Exception if it cannot be read
tgr::EndEffectors readEndEffectors(const std::string& file);

/// What each slice meets of a scene through end-effectors. \throws TextError if these do not fit
std::vector<tgr::RenderedStiffness> renderedStiffness(const scene::Scene& scene,
                                                      const physics::Rates& rates,
                                                      const physics::Certificate& certificate,
                                                      const physics::DeviceTraits& device,
                                                      const tgr::EndEffectors& end_effectors);
Json slicesReport(const tgr::EndEffectors& end_effectors,
                  const std::vector<tgr::RenderedStiffness>& rendered);

}  // namespace ergotic::tools
