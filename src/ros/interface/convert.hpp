// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ergotic/Cuts.h>
#include <ergotic/Event.h>
#include <ergotic/Hold.h>
#include <ergotic/Keyframe.h>
#include <ergotic/ModelEnergy.h>
#include <ergotic/ModelStructure.h>
#include <ergotic/Parameters.h>
#include <ergotic/Status.h>
#include <sensor_msgs/JointState.h>

#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/station/messages.hpp"
#include "ergotic/station/station.hpp"
#include "ros/display/display.hpp"

/// Conversion of plain structs to messages. The caller sets the stamps.
namespace ergotic::node {

/// Name of the message; `Parameters` are those of the node.
using ParametersMessage = ::ergotic::Parameters;

ModelStructure toModelStructure(const scene::Scene& scene, const physics::Rates& rates);

/// Makes the picture of an instrument. \param zoom  of Markers
std::shared_ptr<Picture> toPicture(const physics::Instrument& instrument, double zoom);

/// Names, ranges and units of the parameters that can be changed while the scene plays.
/// \param values  now in force, one for each
ParametersMessage toParameters(const scene::Scene& scene, const std::vector<double>& values);

/// \param scene  the one that plays, for names of parameters; null: none
Event toEvent(const station::Event& event, const scene::Scene* scene);

/// \pre the event is a kHold. \param scene  the one that plays, for names of modules
Hold toHold(const station::Event& event, const scene::Scene& scene);

/// Joints `slice_<i>`: m, m/s, N.
sensor_msgs::JointState toJointState(const station::Snapshot& snapshot);

/// Fills state and fault of `status`, in numbers and words.
void fillStatus(station::ForceState state, tgr::FaultReason fault, Status& status);

/// Fills state, fault and counters of `status`.
void fillStatus(const station::Snapshot& snapshot, Status& status);

/// Fills the list of slices without calibration. \param uncalibrated  a bit each
void fillStatus(std::uint64_t uncalibrated, Status& status);

/// Fills name, rates, sizes and compile options of `status`.
void fillStatus(const physics::Instrument& instrument, Status& status);

/// Fills energies and the warning on energy-stable links of `status`.
void fillStatus(const station::MotionFrame& motion, const scene::Scene& scene, Status& status);

ModelEnergy toModelEnergy(const station::MotionFrame& motion);

/// Energy-stable links whose force was cut, and in how many steps, those cut in most steps first;
/// at most 100. \param scene  the one that plays, for names of links
Cuts toCuts(const station::MotionFrame& motion, const scene::Scene& scene);

Keyframe toKeyframe(const station::Keyframe& keyframe,
                    const physics::Instrument& instrument,
                    std::uint32_t slices);

}  // namespace ergotic::node
