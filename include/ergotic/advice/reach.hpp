// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/scene/scene.hpp"

/// Distance between a hand and what it can touch, before it moves.
///
/// Positions are m of the hand, through the scales and offsets of its port: 0 is its position at
/// the begin of the scene, and upwards is positive. The hand moves alone and quasi-statically:
/// modules held by springs are in equilibrium, by the linear part of their laws at the present
/// values of the parameters; modules that hang on the slice alone move as far as it does; links
/// that may let go exert no pull; free modules stay where they start. In planes and in space,
/// modules held by more than the slice stay, too. A module that the hand meets in a scalar section
/// may be pushed on to others: both give way by their springs and by a linear contact between them;
/// other laws count as rigid there. Realtime: no. Source: docs/tools.md, "Reach"
namespace ergotic::physics {

/// Contact of a module that the hand pushes ahead, or of one joined to it by springs.
struct PushedMeeting {
  std::string thing;
  std::string link;
  const char* law = "";
  double at_m = 0.0;
};

/// A friction whose normal force a contact is.
struct Rubbing {
  std::string link;
  std::string thing;  ///< the rubbed thing
  std::string on;     ///< and by what
};

/// A link that may let go or that begins somewhere, on one side of the hand.
struct Meeting {
  std::string thing;           ///< thing that is met
  std::string link;            ///< link by which it is met
  const char* law = "";        ///< name of the law in reports
  std::string by;              ///< the module that meets it: the slice or what goes with it
  bool touches = false;        ///< already at rest, for any force that it may have
  bool is_missed = false;      ///< however far the hand goes along its port
  double at_m = 0.0;           ///< begin of the contact; 0 if it touches or is missed
  std::vector<double> ends_m;  ///< ends of the contact: ahead, or on either side if it touches
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
  double fraction = 0.0;       ///< position on it at rest, 0...1
  double per_m = 0.0;          ///< fractions for a metre of the hand
  std::vector<double> ends_m;  ///< ends of its range, below and above; 0 if it is there
};

struct PortReach {
  int port = 0;
  std::vector<std::string> carries;  ///< modules that go with the slice
  std::vector<Meeting> meetings;     ///< contacts: touching, met by distance, or missed
  std::vector<Hold> holds;
  std::vector<Guide> guides;

  /// First contact within the stroke; nullptr: none.
  const Meeting* first(double stroke_m) const;
  /// Whether the hand has no effect within the stroke: nothing touches, holds or is led.
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

/// Warnings about slices that meet nothing within their stroke, or at all, which makers hardly
/// intend: `file:line:col: warning: ...`.
std::vector<std::string> reachWarnings(const scene::Scene& scene,
                                       const std::vector<PortReach>& found,
                                       double stroke_m);

}  // namespace ergotic::physics
