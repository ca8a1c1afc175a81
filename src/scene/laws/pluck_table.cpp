// SPDX-License-Identifier: BSD-3-Clause
#include "scene/laws/law.hpp"

namespace ergotic::scene {
namespace {

/// f = table(e), 0 outside its points.
struct PluckTable {
  static constexpr std::size_t kNumbers = 3;  // unused K, Z, offset
  static constexpr std::size_t kOffset = 2;

  static void convert(
      const Scene& scene, const Lia& lia, const Units& units, double rest, double* to) {
    const CommonNumbers n = commonNumbers(scene, lia, units, rest);
    to[0] = n.stiffness;
    to[1] = n.damping;
    to[2] = n.offset;
  }

  template <class Real>
  static Force<Real> force(const RunNumbers<Real>& c, std::size_t l, Real u, Real v) noexcept {
    return {c.table.atOrZero(l, u + c(2, l)), c(1, l) * v};
  }
};

const char* unguarded(const Lia& /*lia*/) {
  return "a pluck";
}

Slopes slopes(const Scene& scene, const Lia& lia) {
  return slopesUpTo(steepest(lia.law->table), largest(scene, lia.damping));
}

constexpr LawWord kWords[] = {{"pluck", "table", "rest_length"}};

}  // namespace

constexpr Law kPluckTableLaw = {
    "pluck",
    kWords,
    {},  // fields
    Law::Tables::kOne,
    false,  // tables_hold
    false,  // has_release
    Law::Kind::kElastic,
    explicitFormOf<PluckTable>(),
    nullptr,  // guarded
    unguarded,
    false,  // has_linear_part
    false,  // switches
    false,  // is_held
    always,
    slopes,
    nullptr,  // growth
    nullptr,  // friction
    noStiffness,
};

}  // namespace ergotic::scene
