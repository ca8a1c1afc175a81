// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/station/performer.hpp"
#include "ergotic/tgr/rig.hpp"

namespace ergotic::station {

/// Load that a slice in use gets from a model through its end-effector.
struct SliceLoad {
  int slice = 0;
  double stiffness = 0.0;        ///< when this slice moves and the others rest, N/m
  double together = 0.0;         ///< largest eigenvalue over the slices of its end-effector, N/m
  double damping = 0.0;          ///< as `together`, of the damping, N s/m
  double stiffness_limit = 0.0;  ///< the hand loop is passive up to here, N/m
  double damping_limit = 0.0;    ///< the hand loop is passive up to here, N s/m
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

/// Rig between a device and a performer, and the warnings about it.
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

/// Fits end-effectors, as fitHands, and stores rig and warnings in a performer that does not play
/// yet.
void giveHands(Performer& performer,
               const tgr::EndEffectors& end_effectors,
               int slices,
               const physics::DeviceTraits& device);

}  // namespace ergotic::station
