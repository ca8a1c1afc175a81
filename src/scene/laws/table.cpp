// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/families.hpp"
#include "scene/laws/table_curves.hpp"
#include "scene/laws/table_ends.hpp"

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

const char* explicitOnly(const Lia& lia) {
  return drive(lia.law->viscous_table) <= lia.damping.factor ? nullptr
                                                             : "a table that drives what moves";
}

/// Its last values hold beyond its ends: there it pushes away, or drives on what moves, whatever
/// constant force one part lends to the other.
bool pushesOutBeyondItsEnds(const Lia& lia) {
  const auto [low, high] = endsOf(lia.law->table);
  const auto [backwards, forwards] = endsOf(lia.law->viscous_table);
  return low > high || backwards > forwards || low + backwards > 0.0 || high + forwards < 0.0;
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

double forceAtRest(const Lia& lia) {
  const Table& lossy = lia.law->viscous_table;
  return lossy.empty() ? 0.0 : valueAt(interpolate(lossy), 0.0);
}

TableEnds endsOf(const Table& table) {
  return table.empty() ? TableEnds{}
                       : TableEnds{table.points.front().second, table.points.back().second};
}

constexpr Law kTableLaw = {
    {"table", kWords, {}, Law::Tables::kParts, false},
    Law::Kind::kElastic,
    explicitForm<ElasticViscousTable>(),
    springForms<TableCurve>,
    explicitOnly,
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
