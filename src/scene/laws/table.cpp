// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/families.hpp"
#include "scene/laws/table_curves.hpp"

namespace ergotic::scene {
namespace {

/// (LNL) f = table(e) + viscous_table(v), both held beyond their last points.
struct ElasticViscousTable {
  static constexpr Number kNumbers[] = {number::offset, number::perStep};
  static constexpr std::size_t kOffset = 0;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    return {c.table.at(l, u + c(0, l)), c.viscous.at(l, v * c(1, l))};
  }
};

/// One that only has a viscous table is a friction.
const GuardedForms& forms(const Lia& lia) {
  return lia.law->table.empty() ? frictionForms<SlipTableCurve>(lia) : springForms<TableCurve>(lia);
}

const char* unguarded(const Lia& lia) {
  return lia.law->viscous_table.empty() ? nullptr : "a table with a viscous part";
}

/// Its last values hold beyond its ends: there it pushes away, or drives on what moves.
bool pushesOut(const Table& table) {
  return !table.empty() && (table.points.front().second > 0.0 || table.points.back().second < 0.0);
}

bool pushesOutBeyondItsEnds(const Lia& lia) {
  return pushesOut(lia.law->table) || pushesOut(lia.law->viscous_table);
}

bool falls(const Lia& lia) {
  return !rises(lia.law->table) || !rises(lia.law->viscous_table);
}

bool onlyBrakes(const Lia& lia) {
  return rises(lia.law->viscous_table) && isOdd(lia.law->viscous_table);
}

Slopes slopes(const Scene& /*scene*/, const Lia& lia) {
  return slopesUpTo(steepest(lia.law->table), steepest(lia.law->viscous_table));
}

FrictionSlopes friction(const Scene& /*scene*/, const Lia& lia) {
  return frictionSlopesOf(lia.law->viscous_table);
}

constexpr LawWord kWords[] = {{"table", "", "elastic viscous rest_length"}};

}  // namespace

constexpr Law kTableLaw = {
    {"table", kWords, {}, Law::Tables::kParts, false},
    Law::Kind::kElastic,
    explicitForm<ElasticViscousTable>(),
    forms,
    unguarded,
    false,  // has_linear_part
    true,   // switches
    true,   // is_held
    falls,  // canGive
    pushesOutBeyondItsEnds,
    slopes,
    nullptr,  // growth
    friction,
    onlyBrakes,
    noStiffness,
};

}  // namespace ergotic::scene
