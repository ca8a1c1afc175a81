// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/bow_table.hpp"

namespace ergotic::scene {
namespace {

/// Friction f = table(v), 0 outside its points.
struct BowTable {
  static constexpr std::size_t kNumbers = 1;  // m/time_unit per step difference
  static constexpr std::size_t kOffset = 0;

  static void convert(
      const Scene& /*scene*/, const Lia& /*lia*/, const Units& units, double, double* to) {
    to[0] = 1.0 / units.step;
  }

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real, Real v) noexcept {
    return {Real(0), c.table.atOrZero(l, v * c(0, l))};
  }
};

template <class Real>
struct SlipTableCurve {
  ERGOTIC_REALTIME static GuardedForce<Real> slip(const GuardedLaw<Real>& n, Real v) noexcept {
    const GuardedForce<Real> at = n.viscous.at(v * n.per_step);
    return {at.force, at.slope * n.per_step};
  }
};

FrictionSlopes friction(const Scene& /*scene*/, const Lia& lia) {
  return frictionSlopesOf(lia.law->table);
}

Slopes slopes(const Scene& /*scene*/, const Lia& lia) {
  return slopesUpTo(0.0, frictionSlopesOf(lia.law->table).rise);
}

constexpr LawWord kWords[] = {{"bow", "table", ""}};

}  // namespace

const GuardedForms& slipTableForms(const Lia& /*lia*/) {
  static constexpr GuardedForms kForms = frictionForms<SlipTableCurve>();
  return kForms;
}

constexpr Law kBowTableLaw = {
    "bow",
    kWords,
    {},  // fields
    Law::Tables::kOne,
    false,  // tables_hold
    false,  // has_release
    Law::Kind::kFriction,
    explicitFormOf<BowTable>(),
    slipTableForms,
    guardable,
    false,  // has_linear_part
    false,  // switches
    false,  // is_held
    always,
    slopes,
    nullptr,  // growth
    friction,
    noStiffness,
};

}  // namespace ergotic::scene
