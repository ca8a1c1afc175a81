// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "ergotic/physics/options.hpp"
#include "ergotic/physics/rates.hpp"
#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

/// Permitted deviation of what is played from what the scene specifies.
struct Target {
  enum class Unit {
    kCents,     ///< for pitches and durations of contacts
    kDecibels,  ///< for forces and whole sounds
    kPercent,   ///< for all of these
  };
  double value = 0.0;
  Unit unit = Unit::kCents;

  double relative() const;  ///< the same as a share of the right value
};

/// Reads "1 cent", "0.1 dB", "0.5 %".
/// \throws Exception naming units and ranges that are allowed
Target targetOf(const std::string& text);

/// A relative error in a unit, "0.94 cents"; "out of reach" if it is not finite or 1 and more.
std::string inUnit(double error, Target::Unit unit);

/// Settings that may be changed to meet a target.
struct Freedom {
  bool audio_rate = true;
  bool gestural_rate = true;
  bool precision = true;
};

/// A part of a scene, or several that are treated alike: how they fare, and how they would.
struct Advice {
  std::string part;       ///< part with the largest error, "string 'a'"
  std::string figure;     ///< quantity that is judged, "worst of ten partials"
  int parts = 1;          ///< number of parts that this is about
  double present = 0.0;   ///< relative error as it is
  double proposed = 0.0;  ///< and as proposed
  std::string change;     ///< change to be made in the scene; empty: none
  std::string remark;     ///< why not more, or what else it means; may be empty
};

/// Proposed settings of a scene, and their reasons.
struct Proposal {
  scene::Scene scene;  ///< with all changes, not settled
  Rates rates;
  Precision precision = Precision::kFloat;
  std::vector<Advice> advice;
  std::vector<std::string> remarks;  ///< remarks on unchanged settings, and the reasons
  double present_cost = 0.0;  ///< plain steps of modules and links per second, others weighted
  double cost = 0.0;
  bool is_reached = false;  ///< every part that is judged is good enough
};

/// The cheapest setting that is good enough, by the errors of accuracy.hpp: audio rate, gestural
/// rate, precision, how strings are cut, schemes, chaplets. If none is, the best there is.
///
/// Judged are strings (ten partials), bows, other networks of up to 300 modules (ten lowest modes),
/// contacts (at 1 mm), hands (at 20 Hz) and masses that are held between slower steps; in dB and in
/// cents only those that the unit can be of. A hand may meet as stiff a wall as before, or half of
/// what is passive. The certificate on the proposal is no worse than on the scene as it is, or
/// bounded.
/// \param scene  not settled
/// \throws Exception if nothing in the scene can be judged in this unit, TextError as `settle`
/// Realtime: no. Cost: some settlings and certificates
Proposal propose(const scene::Scene& scene,
                 const Rates& rates,
                 Precision precision,
                 const Target& target,
                 const Freedom& freedom = {});

}  // namespace ergotic::physics
