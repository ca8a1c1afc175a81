// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/scene/scene.hpp"

/// How far a hand is from what it can touch, before it moves.
///
/// Positions are m of the hand, through the scales and offsets of its port: 0 is where it lies as
/// the scene begins, and what is above is positive. The hand moves alone and so slowly that nothing
/// swings: what springs hold is where they hold it, by the linear part of their laws at the present
/// values of the parameters, what hangs on the slice alone goes as far as it does, what may let go
/// pulls at nothing, and what is not held stays where it starts. In planes and in space what is
/// held by more than the slice stays, too. What it meets in a scalar section it may push on to
/// other things: both give way by their springs and by a linear contact between them, other laws
/// count as hard there. Realtime: no. Source: docs/tools.md, "Reach"
namespace ergotic::physics {

/// What is met by something that the hand pushes ahead, or by what springs join to that.
struct PushedMeeting {
  std::string thing;
  std::string link;
  const char* law = "";
  double at_m = 0.0;
};

/// A friction whose normal force a contact is.
struct Rubbing {
  std::string link;
  std::string thing;  ///< what is rubbed,
  std::string on;     ///< and by what
};

/// A link that may let go or that begins somewhere, on one side of the hand.
struct Meeting {
  std::string thing;           ///< what is met
  std::string link;            ///< by which
  const char* law = "";        ///< as reports call it
  std::string by;              ///< the module that meets it: the slice or what goes with it
  bool touches = false;        ///< already at rest, for any force that it may have
  bool is_missed = false;      ///< however far the hand goes along its port
  double at_m = 0.0;           ///< where it begins; 0 if it touches or is missed
  std::vector<double> ends_m;  ///< where it ends again: ahead, or on either side if it touches
  double missed_by_m = 0.0;    ///< m of the model
  std::string waits_for;       ///< the contact that would have to press, and that other hands move
  std::vector<Rubbing> presses;
  std::vector<PushedMeeting> then;  ///< nearest first
};

/// A spring from the slice to what other things hold as well: it is felt from the start.
struct Hold {
  std::string thing;
  std::string link;
  double stiffness = 0.0;  ///< N/m, of this link, in the model
  double follows = 0.0;    ///< m that the thing goes for a metre of the slice
};

/// A place along a string or mesh that the slice leads.
struct Guide {
  std::string point;
  std::string along;           ///< the string or mesh
  double fraction = 0.0;       ///< of it, at rest
  double per_m = 0.0;          ///< fractions for a metre of the hand
  std::vector<double> ends_m;  ///< where its range ends, below and above; 0 where it is there
};

struct PortReach {
  int port = 0;
  std::vector<std::string> carries;  ///< modules that go with the slice
  std::vector<Meeting> meetings;     ///< what touches, what is met by distance, what is missed
  std::vector<Hold> holds;
  std::vector<Guide> guides;

  /// What is met first within the stroke; nullptr: nothing.
  const Meeting* first(double stroke_m) const;
  /// It is felt or heard nowhere within the stroke: nothing touches, holds or is led.
  bool isIdle(double stroke_m) const;
};

/// \param scene  settled
/// \param ports  indices in Scene::ports
/// \param pushes  look for what is met by what is pushed, too
/// \param[out] notes  what was not worked out, in full sentences
std::vector<PortReach> reachOf(const scene::Scene& scene,
                               const std::vector<int>& ports,
                               bool pushes,
                               std::vector<std::string>& notes);

/// Ports that a slice moves by itself.
std::vector<int> portsOfSlices(const scene::Scene& scene);

/// What makers hardly mean, `file:line:col: warning: ...`: slices that meet nothing within their
/// stroke, or at all.
std::vector<std::string> reachWarnings(const scene::Scene& scene,
                                       const std::vector<PortReach>& found,
                                       double stroke_m);

}  // namespace ergotic::physics
