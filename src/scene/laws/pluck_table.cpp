// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/families.hpp"
#include "scene/laws/table_curves.hpp"

namespace ergotic::scene {
namespace {

/// f = table(e), 0 outside its points.
struct PluckTable {
  static constexpr Number kNumbers[] = {number::stiffness, number::damping, number::offset};
  static constexpr std::size_t kOffset = 2;

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    return {c.table.atOrZero(l, u + c(2, l)), c(1, l) * v};
  }
};

Slopes slopes(const Scene& scene, const Lia& lia) {
  return slopesUpTo(steepest(lia.law->table), largest(scene, lia.damping));
}

constexpr LawWord kWords[] = {{"pluck", "table", "rest_length"}};

}  // namespace

constexpr Law kPluckTableLaw =
    pluckLaw<PluckTable, TableCurve>({"pluck", kWords, {}, Law::Tables::kOne, false}, slopes);

}  // namespace ergotic::scene
