// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/families.hpp"
#include "scene/laws/table_curves.hpp"

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

/// Whether it drives what swings far: that spends equal times at all of the table's velocities, so
/// the integral of v f over them decides.
bool drives(const Lia& lia) {
  double work = 0.0;
  const auto& points = lia.law->table.points;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto [v, f] = points[i];
    const auto [w, g] = points[i + 1];
    work += (w - v) * (v * f + w * g + (v + w) * (f + g)) / 6.0;  // of straight lines
  }
  return work < 0.0;
}

constexpr LawWord kWords[] = {{"bow", "table", ""}};

}  // namespace

constexpr Law kBowTableLaw = frictionLaw<BowTable, SlipTableCurve, friction>(
    {"bow", kWords, {}, Law::Tables::kOne, false}, drives);

}  // namespace ergotic::scene
