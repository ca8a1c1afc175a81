// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <variant>

#include "scene/laws/energy_stable_form.hpp"
#include "scene/laws/explicit_form.hpp"
#include "scene/laws/slopes.hpp"
#include "scene/limits.hpp"

/// Laws of force, each defined once for all who use it: readers of scenes, `validate`, schemes,
/// certificate. A new law is a row of lia_type.hpp and a file of its own here.
namespace ergotic::scene {

/// A constant array.
template <class Item>
struct List {
  const Item* items = nullptr;
  std::size_t count = 0;

  constexpr List() = default;
  template <std::size_t N>
  constexpr List(const Item (&from)[N]) : items(from), count(N) {}
  constexpr const Item* begin() const { return items; }
  constexpr const Item* end() const { return items + count; }
};

/// A coefficient that all links have, or one that only some laws need.
using LiaMember = std::variant<Value Lia::*, Value LiaLaw::*>;
const Value& memberOf(const Lia& lia, LiaMember member);
void setMember(Lia& lia, LiaMember member, const Value& value);

/// One coefficient of a link.
struct LiaField {
  const char* key;  ///< key in YAML
  LiaMember member;
  Limits limits;
  bool is_fixed = false;  ///< worked out once: no parameter
};

/// A word for a law in YAML, and the keys it takes beside those of all links, in one string each.
struct LawWord {
  const char* word;
  const char* required;
  const char* optional;
  // With `release_force`: where it is largest
  double release_slope = 1.0;  ///< force per elongation, of K
  double release_share = 1.0;  ///< elongation, of the width
};

/// Slopes of a law that grow with amplitude: no bound holds for all motions.
struct Growth {
  /// Why the explicit scheme does not bear it, nullptr where its parameters leave it linear.
  struct Figure {
    const char* name;
    double value;
    double allowed;
  };
  Figure (*figure)(const Scene& scene, const Lia& lia);
  /// The steepest slopes up to an elongation, m.
  Slopes (*slopes)(const Scene& scene, const Lia& lia, double elongation);
  /// The elongation from which on the stiffness is above a limit, m; 0: always.
  double (*elongation)(const Scene& scene, const Lia& lia, double limit);
};

/// Name, words and keys of a law in scenes.
struct LawText {
  enum class Tables {
    kNone,
    kOne,          ///< `table`, 0 beyond its ends
    kParts,        ///< `elastic`, `viscous` or both, held beyond their ends
    kCoefficient,  ///< `table` of mu over |v|, held beyond its ends, or `steady` and `parts`
  };

  const char* name;  ///< name in reports
  List<LawWord> words;
  List<LiaField> fields;
  Tables tables;
  bool has_release;  ///< lets go at `release`, not at `width`
};

/// One law. Every entry is given by every law or by its family (families.hpp): none has a default
/// that could be wrong for it.
struct Law : LawText {
  /// Quantities on which the force depends, for geometries and energy accounts.
  enum class Kind {
    kLinear,    ///< elongation and velocity, linear
    kRelaxing,  ///< the same, and their past, which it remembers
    kElastic,   ///< elongation and velocity
    kGap,       ///< a distance that is too short
    kFriction,  ///< velocity alone
  };

  Kind kind;
  ExplicitForm explicit_form;
  const EnergyStableForms& (*energy_stable)(const Lia& lia);
  const char* (*explicitOnly)(
      const Lia& lia);  ///< reason why `scheme: energy_stable` is refused, or nullptr

  // Stability
  bool has_linear_part;             ///< K e + Z v is there at rest
  bool switches;                    ///< its stiffness comes and goes
  bool is_held;                     ///< it switches, but its force has an upper bound
  bool (*canGive)(const Lia& lia);  ///< energy, though no more than a bounded amount at a time
  /// True if it gives energy however far or fast its ends move: only what takes that energy bounds
  /// it.
  bool (*givesForEver)(const Lia& lia);
  Slopes (*slopes)(const Scene& scene, const Lia& lia);
  const Growth* growth;                                            ///< nullptr: slopes are bounded
  FrictionSlopes (*friction)(const Scene& scene, const Lia& lia);  ///< nullptr: no friction
  /// True if its friction is odd and never falls: any motion loses energy by it, step by step.
  bool (*onlyBrakes)(const Lia& lia);
  /// Stiffness of the spring that it is at least; 0 if it may let go.
  double (*leastStiffness)(const Scene& scene, const Lia& lia);
};

/// The row of a law.
const Law& lawOf(LiaType type);

/// True if it may hold two bodies together as if they were one, which only the energy-stable scheme
/// can do.
inline bool sticks(LiaType type) {
  return lawOf(type).explicit_form.single_forces == nullptr;
}

inline Slopes slopesOf(const Scene& scene, const Lia& lia) {
  return lawOf(lia.type).slopes(scene, lia);
}
/// Slopes of an explicit link in steps of that length, time units.
Slopes slopesInSteps(const Scene& scene, const Lia& lia, double step);
/// The steepest up to an elongation, m.
Slopes slopesAt(const Scene& scene, const Lia& lia, double elongation);

constexpr LiaField stiffnessField(double least = 0.0, const char* unit = "N/m") {
  return {"stiffness", &Lia::stiffness, {unit, least}};
}
constexpr LiaField dampingField(double least = 0.0, const char* unit = "N s/m") {
  return {"damping", &Lia::damping, {unit, least}};
}
constexpr LiaField thresholdField() {
  return {"threshold", &LiaLaw::width, kMetreLimits};
}
constexpr LiaField nonlinearityField(const char* unit) {
  return {"nonlinearity", &LiaLaw::nonlinearity, {unit}};
}
constexpr LiaField widthField(const char* key, const char* unit) {
  return {key, &LiaLaw::width, {unit, 0.0, kInfinity, true}};
}

#define ERGOTIC_DECLARATION(name) extern const Law k##name##Law;
ERGOTIC_LAWS(ERGOTIC_DECLARATION)
#undef ERGOTIC_DECLARATION

}  // namespace ergotic::scene
