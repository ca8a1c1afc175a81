// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/station/performer.hpp"
#include "ergotic/tgr/rig.hpp"

namespace ergotic::station {

/// What a slice in use meets of a model through what stands on it.
struct SliceLoad {
  int slice = 0;
  double stiffness = 0.0;        ///< when it moves and the others rest, N/m
  double together = 0.0;         ///< with the slices of its end-effector, in the worst way, N/m
  double damping = 0.0;          ///< with them, N s/m
  double stiffness_limit = 0.0;  ///< no hand sets off less by itself, N/m
  double damping_limit = 0.0;    ///< no hand sets off less by itself, N s/m
  physics::HandLevel level = physics::HandLevel::kSilent;
};

/// A model and end-effectors that are about to play together.
struct HandFindings {
  std::vector<SliceLoad> slices;
  std::vector<std::string> warnings;  ///< `file:line:col: warning: ...`
  std::vector<std::string> refusals;  ///< `file:line:col: error: ...`: it will buzz or jump
};

/// Judges what end-effectors make of the ports of a model, and the ports that a slice moves by
/// itself beside them although the certificate took them for taken.
/// \param certificate  of the scene at these rates
/// \param device       damping, delay and mass of its slices
/// Realtime: no. Source: docs/tgr.md, "Stiffness".
HandFindings judgeHands(const scene::Scene& scene,
                        const physics::Rates& rates,
                        const physics::Certificate& certificate,
                        const physics::DeviceTraits& device,
                        const tgr::EndEffectors& end_effectors);

/// What stands between a device and a performer, and what is to be said of it.
struct FittedHands {
  std::unique_ptr<tgr::Rig> rig;
  std::vector<std::string> warnings;
};

/// Puts end-effectors between a device and a performer: whenever either of them changes.
/// \param slices  of the device
/// \throws TextError as tgr::makeRig, Exception with what judgeHands refuses, unless the performer
///         allows what is unproven
FittedHands fitHands(const Performer& performer,
                     const tgr::EndEffectors& end_effectors,
                     int slices,
                     const physics::DeviceTraits& device);

/// The same for a performer that does not play yet: it gets the rig, and the warnings.
void giveHands(Performer& performer,
               const tgr::EndEffectors& end_effectors,
               int slices,
               const physics::DeviceTraits& device);

}  // namespace ergotic::station
