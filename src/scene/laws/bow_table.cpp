// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/bow_table.hpp"

#include "scene/laws/families.hpp"

namespace ergotic::scene {
namespace {

/// Friction f = table(v), 0 outside its points.
struct BowTable {
  static constexpr Number kNumbers[] = {number::perStep};
  static constexpr std::size_t kOffset = 0;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real, Real v) noexcept {
    return {Real(0), c.table.atOrZero(l, v * c(0, l))};
  }
};

FrictionSlopes friction(const Scene& /*scene*/, const Lia& lia) {
  return frictionSlopesOf(lia.law->table);
}

constexpr LawWord kWords[] = {{"bow", "table", ""}};

}  // namespace

constexpr Law kBowTableLaw =
    frictionLaw<BowTable, SlipTableCurve, friction>({"bow", kWords, {}, Law::Tables::kOne, false});

}  // namespace ergotic::scene
