// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/laws/contact.hpp"
#include "scene/laws/law.hpp"

/// Laws of a family share all entries but those that are asked for here. Explicit forms and
/// energy-stable curves are those of explicit_form.hpp and energy_stable_form.hpp.
namespace ergotic::scene {

inline bool never(const Lia& /*lia*/) {
  return false;
}
inline bool always(const Lia& /*lia*/) {
  return true;
}
inline double noStiffness(const Scene& /*scene*/, const Lia& /*lia*/) {
  return 0.0;
}
inline const char* guardable(const Lia& /*lia*/) {
  return nullptr;
}

/// Pushes while a distance is too short.
template <class Explicit, template <class> class Curve>
constexpr Law contactLaw(LawText text, decltype(Law::slopes) slopes, const Growth* growth) {
  return {text,       Law::Kind::kGap, explicitForm<Explicit>(), contactForms<Curve>, guardable,
          false,  // has_linear_part
          true,   // switches
          false,  // is_held
          never,  // canGive
          never,  // givesForEver
          slopes,     growth,
          nullptr,  // friction
          never,    // onlyBrakes
          noStiffness};
}

/// Two-sided, with a nonlinearity beside K e.
template <class Explicit, template <class> class Curve>
constexpr Law springLaw(LawText text,
                        bool switches,
                        decltype(Law::slopes) slopes,
                        const Growth* growth,
                        decltype(Law::leastStiffness) least_stiffness) {
  return {text,
          Law::Kind::kElastic,
          explicitForm<Explicit>(),
          springForms<Curve>,
          guardable,
          true,  // has_linear_part
          switches,
          false,  // is_held
          never,  // canGive
          never,  // givesForEver
          slopes,
          growth,
          nullptr,  // friction
          never,    // onlyBrakes
          least_stiffness};
}

/// Slopes of a friction law that falls somewhere: at most as steep as it rises.
template <FrictionSlopes (*kFriction)(const Scene&, const Lia&)>
Slopes frictionRise(const Scene& scene, const Lia& lia) {
  return slopesUpTo(0.0, kFriction(scene, lia).rise);
}

/// A friction law: its force depends on velocity alone.
template <class Explicit,
          template <class>
          class Curve,
          FrictionSlopes (*kFriction)(const Scene&, const Lia&)>
constexpr Law frictionLaw(LawText text, decltype(Law::givesForEver) gives_for_ever) {
  return {text,           Law::Kind::kFriction,    explicitForm<Explicit>(), frictionForms<Curve>,
          guardable,
          false,   // has_linear_part
          false,   // switches
          false,   // is_held
          always,  // canGive
          gives_for_ever, frictionRise<kFriction>,
          nullptr,  // growth
          kFriction,
          never,  // onlyBrakes
          noStiffness};
}

/// Holds, slips and gives what it stored.
template <class Explicit, template <class> class Curve>
constexpr Law pluckLaw(LawText text, decltype(Law::slopes) slopes) {
  return {text,       Law::Kind::kElastic, explicitForm<Explicit>(), springForms<Curve>, guardable,
          false,   // has_linear_part
          true,    // switches
          true,    // is_held
          always,  // canGive
          never,   // givesForEver
          slopes,
          nullptr,  // growth
          nullptr,  // friction
          never,    // onlyBrakes
          noStiffness};
}

/// A spring that comes and goes, and remembers whether it holds.
template <class Explicit, template <class> class Curve>
constexpr Law snappingLaw(LawText text) {
  return {text,           Law::Kind::kElastic, explicitForm<Explicit>(1), snappingForms<Curve>,
          guardable,
          false,   // has_linear_part
          true,    // switches
          true,    // is_held
          always,  // canGive
          never,   // givesForEver
          slopesFromZero,
          nullptr,  // growth
          nullptr,  // friction
          never,    // onlyBrakes
          noStiffness};
}

}  // namespace ergotic::scene
