// SPDX-License-Identifier: BSD-3-Clause
// The kernels of blocks, compiled once for each level of vector instructions: CMakeLists.txt sets
// ERGOTIC_LEVEL, the namespace, and ERGOTIC_VECTOR_BYTES. Nothing may be shared with other units,
// which run on other processors: no standard library but its types, all in that namespace.
#include "physics/kernels/block_kernels.hpp"

#include <utility>

#include "physics/kernels/levels.hpp"

#define ERGOTIC_INLINE inline __attribute__((always_inline))

namespace ergotic::physics::kernels::ERGOTIC_LEVEL {
namespace {

using Index = std::ptrdiff_t;

template <class Real>
struct VectorOf;
template <>
struct VectorOf<float> {
  typedef float Type __attribute__((vector_size(ERGOTIC_VECTOR_BYTES), aligned(4), may_alias));
};
template <>
struct VectorOf<double> {
  typedef double Type __attribute__((vector_size(ERGOTIC_VECTOR_BYTES), aligned(8), may_alias));
};
template <class Real>
using Vector = typename VectorOf<Real>::Type;

template <class Real>
constexpr int kWidth = ERGOTIC_VECTOR_BYTES / static_cast<int>(sizeof(Real));
template <class Real>
constexpr int kParts = kLanes / kWidth<Real>;  // vectors in a row of kLanes

template <class Real>
ERGOTIC_INLINE Vector<Real> load(const Real* from, Index at) noexcept {
  return *reinterpret_cast<const Vector<Real>*>(from + at);
}
template <class Real>
ERGOTIC_INLINE void store(Real* to, Index at, Vector<Real> value) noexcept {
  *reinterpret_cast<Vector<Real>*>(to + at) = value;
}

/// A sum kept in one part for each lane, whatever the width of vectors.
template <class Real>
struct LaneSums {
  Vector<Real> parts[kParts<Real>] = {};
  ERGOTIC_INLINE double total() const noexcept {
    double sum = 0.0;
    for (int p = 0; p < kParts<Real>; ++p) {
      for (int i = 0; i < kWidth<Real>; ++i) {
        sum += static_cast<double>(parts[p][i]);
      }
    }
    return sum;
  }
};

/// A module's step. \return d of this step; `before` is d of the last
template <bool kCells, class Real>
ERGOTIC_INLINE Vector<Real> nextStep(const MoveArguments<Real>& a,
                                     Index s,
                                     Vector<Real> x,
                                     Vector<Real> before,
                                     Vector<Real> f) noexcept {
  const Vector<Real> gain = load(a.inverse_mass, s) * f;
  if constexpr (kCells) {
    return before - (load(a.lose, s) * before + load(a.pull, s) * x) + (gain + load(a.drift, s));
  } else {
    return before + gain;
  }
}

template <bool kCells, bool kDrift, bool kY, bool kMetered, class Real>
double moveLoop(const MoveArguments<Real>& given, Index first, Index last) noexcept {
  const MoveArguments<Real> a = given;
  LaneSums<Real> lost;
#pragma GCC ivdep
  for (Index row = first; row < last; row += kLanes) {
#pragma GCC unroll 8
    for (int p = 0; p < kParts<Real>; ++p) {
      const Index s = row + p * kWidth<Real>;
      const Vector<Real> x = load(a.x, s);
      const Vector<Real> before = load(a.d, s);
      Vector<Real> now = nextStep<kCells>(a, s, x, before, load(a.f, s));
      if constexpr (kDrift && !kCells) {
        now += load(a.drift, s);
      }
      store(a.d, s, now);
      store(a.x, s, x + now);
      if constexpr (kY) {
        store(a.y, s, (x + now) + a.ratio * now);
      }
      if constexpr (kMetered) {
        store(a.d_last, s, before);
        if constexpr (kCells) {
          lost.parts[p] += load(a.loss, s) * now * (now + before);
        }
      }
    }
  }
  return kCells && kMetered ? lost.total() : 0.0;
}

template <bool kCells, bool kDrift, bool kY, class Real>
ERGOTIC_INLINE double moveMetered(const MoveArguments<Real>& a, Index first, Index last) noexcept {
  return a.d_last != nullptr ? moveLoop<kCells, kDrift, kY, true>(a, first, last)
                             : moveLoop<kCells, kDrift, kY, false>(a, first, last);
}
template <bool kCells, bool kDrift, class Real>
ERGOTIC_INLINE double moveMixed(const MoveArguments<Real>& a, Index first, Index last) noexcept {
  return a.y != nullptr ? moveMetered<kCells, kDrift, true>(a, first, last)
                        : moveMetered<kCells, kDrift, false>(a, first, last);
}
template <class Real>
double move(const MoveArguments<Real>& a, Index first, Index last) noexcept {
  if (a.lose != nullptr) {
    return moveMixed<true, true>(a, first, last);
  }
  return a.drift != nullptr ? moveMixed<false, true>(a, first, last)
                            : moveMixed<false, false>(a, first, last);
}

/// Sum over both neighbours on one diagonal, as differences: precise where positions are large.
template <bool kUniform, class Real>
ERGOTIC_INLINE Vector<Real> neighbours(
    const Real* u, Index s, Index offset, Vector<Real> here, Real k, const Real* ks) noexcept {
  const Vector<Real> up = load(u, s + offset) - here;
  const Vector<Real> down = load(u, s - offset) - here;
  if constexpr (kUniform) {
    return k * (up + down);
  } else {
    return load(ks, s) * up + load(ks, s - offset) * down;
  }
}

template <int kDiagonals, bool kUniform, bool kWhole, bool kAdds, class Real>
void latticeLoop(const LatticeArguments<Real>& given, Index first, Index last) noexcept {
  const LatticeArguments<Real> a = given;
#pragma GCC ivdep
  for (Index s = first; s < last; s += kWidth<Real>) {
    const Vector<Real> u = load(a.u, s);
    Vector<Real> elastic = neighbours<kUniform>(a.u, s, a.offset[0], u, a.k[0], a.ks[0]);
#pragma GCC unroll 4
    for (int i = 1; i < kDiagonals; ++i) {
      elastic += neighbours<kUniform>(a.u, s, a.offset[i], u, a.k[i], a.ks[i]);
    }
    if constexpr (!kWhole) {
      const Vector<Real> d = load(a.d, s);
      Vector<Real> viscous = neighbours<kUniform>(a.d, s, a.offset[0], d, a.z[0], a.zs[0]);
#pragma GCC unroll 4
      for (int i = 1; i < kDiagonals; ++i) {
        viscous += neighbours<kUniform>(a.d, s, a.offset[i], d, a.z[i], a.zs[i]);
      }
      elastic += viscous;
    }
    store(a.f, s, kAdds ? load(a.f, s) + elastic : elastic);
  }
}

template <int kDiagonals, bool kUniform, class Real>
double viscousLoop(const LatticeArguments<Real>& given, Index first, Index last) noexcept {
  const LatticeArguments<Real> a = given;
  LaneSums<Real> sums;
  for (Index row = first; row < last; row += kLanes) {
#pragma GCC unroll 8
    for (int p = 0; p < kParts<Real>; ++p) {
      const Index s = row + p * kWidth<Real>;
      const Vector<Real> d = load(a.d, s);
      Vector<Real> viscous = neighbours<kUniform>(a.d, s, a.offset[0], d, a.z[0], a.zs[0]);
#pragma GCC unroll 4
      for (int i = 1; i < kDiagonals; ++i) {
        viscous += neighbours<kUniform>(a.d, s, a.offset[i], d, a.z[i], a.zs[i]);
      }
      sums.parts[p] += viscous * (d + load(a.d_last, s));
    }
  }
  return -sums.total();
}

template <int kNumber>
struct Count {
  static constexpr int kCount = kNumber;
};

/// Calls `visit` with the number of diagonals as a constant.
template <class Visit>
ERGOTIC_INLINE auto withDiagonals(int diagonals, const Visit& visit) noexcept {
  switch (diagonals) {
    case 1:
      return visit(Count<1>{});
    case 2:
      return visit(Count<2>{});
    case 3:
      return visit(Count<3>{});
    default:
      return visit(Count<4>{});
  }
}

template <int kDiagonals, bool kUniform, class Real>
ERGOTIC_INLINE void latticePass(const LatticeArguments<Real>& a, Index first, Index last) noexcept {
  if (a.d == nullptr) {
    return a.adds ? latticeLoop<kDiagonals, kUniform, true, true>(a, first, last)
                  : latticeLoop<kDiagonals, kUniform, true, false>(a, first, last);
  }
  return a.adds ? latticeLoop<kDiagonals, kUniform, false, true>(a, first, last)
                : latticeLoop<kDiagonals, kUniform, false, false>(a, first, last);
}

template <class Real>
void lattice(const LatticeArguments<Real>& a, Index first, Index last) noexcept {
  withDiagonals(a.diagonals, [&](auto diagonals) {
    constexpr int kCount = decltype(diagonals)::kCount;
    a.ks[0] == nullptr ? latticePass<kCount, true>(a, first, last)
                       : latticePass<kCount, false>(a, first, last);
  });
}

template <class Real>
double viscous(const LatticeArguments<Real>& a, Index first, Index last) noexcept {
  return withDiagonals(a.diagonals, [&](auto diagonals) {
    constexpr int kCount = decltype(diagonals)::kCount;
    return a.zs[0] == nullptr ? viscousLoop<kCount, true>(a, first, last)
                              : viscousLoop<kCount, false>(a, first, last);
  });
}

/// The vector one element on: the last of `one` is the first of `other`.
template <int kFrom, class Real, int... kLane>
ERGOTIC_INLINE Real slide(Real one, Real other, std::integer_sequence<int, kLane...>) noexcept {
  return __builtin_shufflevector(one, other, (kFrom + kLane)...);
}
template <class Real, int kFrom>
ERGOTIC_INLINE Vector<Real> slide(Vector<Real> one, Vector<Real> other) noexcept {
  return slide<kFrom>(one, other, std::make_integer_sequence<int, kWidth<Real>>());
}

/// Differences of one array (x, d) along a plate's row and across its rows, as a pass along the row
/// sees them: what it has loaded is shifted, not loaded again.
template <class Real>
struct RowPass {
  const Real* u;
  Index pitch;
  Vector<Real> here;       // elements s...
  Vector<Real> step_back;  // next element less this one, one vector back

  ERGOTIC_INLINE RowPass(const Real* from, Index s, Index rows) noexcept
      : u(from), pitch(rows), here(load(from, s)) {
    step_back = slide<Real, 1>(load(from, s - kWidth<Real>), here) - load(from, s - kWidth<Real>);
  }
  /// Second difference across the rows at s.
  ERGOTIC_INLINE Vector<Real> across(Index s) const noexcept {
    const Vector<Real> middle = load(u, s);
    return (load(u, s - pitch) - middle) + (load(u, s + pitch) - middle);
  }
  /// Second difference along the row at s, then on to the next vector.
  ERGOTIC_INLINE Vector<Real> along(Index s) noexcept {
    const Vector<Real> next = load(u, s + kWidth<Real>);
    const Vector<Real> step = slide<Real, 1>(here, next) - here;
    const Vector<Real> second = step - slide<Real, kWidth<Real> - 1>(step_back, step);
    here = next;
    step_back = step;
    return second;
  }
};

/// The corners' second differences are those across the rows of both neighbours and twice that
/// along the row.
template <bool kCorners, bool kWhole, class Real>
void plateLoop(const PlateArguments<Real>& given, Index first, Index last) noexcept {
  const PlateArguments<Real> a = given;
  const Real k_along = kCorners ? a.k_along + 2 * a.k_corner : a.k_along;
  const Real z_along = kCorners ? a.z_along + 2 * a.z_corner : a.z_along;
  RowPass<Real> u(a.u, first, a.pitch);
  RowPass<Real> d(kWhole ? a.u : a.d, first, a.pitch);
  Vector<Real> corner_back = {};
  Vector<Real> corner = {};
  Vector<Real> straight = {};
  // What the vector at s gives: to itself, and by its corners to both neighbours.
  const auto look = [&](Index s) noexcept {
    const Vector<Real> across = u.across(s);
    straight = a.k_across * across;
    corner_back = corner;
    corner = a.k_corner * across;
    if constexpr (!kWhole) {
      const Vector<Real> viscous = d.across(s);
      straight += a.z_across * viscous;
      corner += a.z_corner * viscous;
    }
  };
  if constexpr (kCorners) {
    look(first - kWidth<Real>);
  }
  look(first);
  for (Index s = first; s < last; s += kWidth<Real>) {
    Vector<Real> force = k_along * u.along(s) + straight;
    if constexpr (!kWhole) {
      force += z_along * d.along(s);
    }
    const Vector<Real> one = corner_back;
    const Vector<Real> two = corner;
    look(s + kWidth<Real>);
    if constexpr (kCorners) {
      force += slide<Real, kWidth<Real> - 1>(one, two) + slide<Real, 1>(two, corner);
    }
    store(a.f, s, force);
  }
}

template <class Real>
void plate(const PlateArguments<Real>& a, Index first, Index last) noexcept {
  if (a.corners) {
    return a.d == nullptr ? plateLoop<true, true>(a, first, last)
                          : plateLoop<true, false>(a, first, last);
  }
  return a.d == nullptr ? plateLoop<false, true>(a, first, last)
                        : plateLoop<false, false>(a, first, last);
}

/// One row of chains, with the values that the next row needs.
template <class Real>
struct ChainRow {
  Vector<Real> x[kParts<Real>];
  Vector<Real> d[kParts<Real>];
  Vector<Real> before[kParts<Real>];
  Vector<Real> force[kParts<Real>];  // of the links from the row above
};

template <bool kCells, bool kMetered, class Real>
double chainLoop(const ChainArguments<Real>& given, Index first, Index last) noexcept {
  const ChainArguments<Real> a = given;
  LaneSums<Real> lost;
  ChainRow<Real> above{};
  Index link = -a.stride;  // its coefficients: none before the first row
  for (Index row = first; row < last; row += kLanes, link += a.stride) {
#pragma GCC unroll 8
    for (int p = 0; p < kParts<Real>; ++p) {
      const Index s = row + p * kWidth<Real>;
      const Vector<Real> before = load(a.modules.d, s);
      const Vector<Real> was = load(a.modules.x, s);
      const Vector<Real> now = nextStep<kCells>(a.modules, s, was, before, load(a.f, s));
      const Vector<Real> x = was + now;
      store(a.modules.d, s, now);
      store(a.modules.x, s, x);
      if constexpr (kMetered) {
        store(a.modules.d_last, s, before);
        if constexpr (kCells) {
          lost.parts[p] += load(a.modules.loss, s) * now * (now + before);
        }
      }
      Vector<Real> force = {};
      if (row != first) {
        const Vector<Real> v = now - above.d[p];
        const Vector<Real> viscous = load(a.z, link + p * kWidth<Real>) * v;
        force = load(a.k, link + p * kWidth<Real>) * (x - above.x[p]) + viscous;
        if constexpr (kMetered) {
          lost.parts[p] += viscous * (v + (before - above.before[p]));
        }
        store(a.f, s - kLanes, force - above.force[p]);
      }
      above.x[p] = x;
      above.d[p] = now;
      above.before[p] = before;
      above.force[p] = force;
    }
  }
#pragma GCC unroll 8
  for (int p = 0; p < kParts<Real>; ++p) {
    store(a.f, last - kLanes + p * kWidth<Real>, -above.force[p]);
  }
  return kMetered ? lost.total() : 0.0;
}

template <class Real>
double chains(const ChainArguments<Real>& a, Index first, Index last) noexcept {
  const bool metered = a.modules.d_last != nullptr;
  if (a.modules.lose != nullptr) {
    return metered ? chainLoop<true, true>(a, first, last) : chainLoop<true, false>(a, first, last);
  }
  return metered ? chainLoop<false, true>(a, first, last) : chainLoop<false, false>(a, first, last);
}

template <class Real>
constexpr BlockKernels<Real> kKernels{move<Real>, lattice<Real>, plate<Real>, viscous<Real>,
                                      chains<Real>};

}  // namespace

template <>
const BlockKernels<float>& kernels() noexcept {
  return kKernels<float>;
}
template <>
const BlockKernels<double>& kernels() noexcept {
  return kKernels<double>;
}

}  // namespace ergotic::physics::kernels::ERGOTIC_LEVEL
