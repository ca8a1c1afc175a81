// SPDX-License-Identifier: BSD-3-Clause
// The kernels of irregular networks, compiled once for each level of vector instructions:
// CMakeLists.txt sets ERGOTIC_LEVEL, the namespace, and ERGOTIC_VECTOR_BYTES. Nothing here may be
// shared with other translation units, which run on other processors: no standard library,
// everything in that namespace.
#include "physics/kernels/sparse_kernels.hpp"

#include "physics/kernels/levels.hpp"
#include "physics/kernels/sparse_pickers.hpp"

namespace ergotic::physics::kernels::ERGOTIC_LEVEL {
namespace {

/// Position of a pass in the program.
template <class Real>
struct Cursor {
  const std::uint32_t* window;
  const std::uint8_t* lane;
  const std::uint32_t* node;
  const std::uint16_t* present;
  const Real* ks;
  const Real* zs;

  ERGOTIC_INLINE Cursor(const SparseArguments<Real>& a, int group) noexcept {
    const std::size_t windows = a.first_window[group];
    const std::size_t picks = a.first_pick[group];
    const std::size_t coefficients = (windows + picks) * kSparseLanes;
    window = a.window + windows;
    lane = a.lane + windows * kSparseLanes;
    node = a.pick + picks * kSparseLanes;
    present = a.present + windows + picks;
    ks = a.ks + (a.ks == nullptr ? 0 : coefficients);
    zs = a.zs + (a.zs == nullptr ? 0 : coefficients);
  }
};

/// Adds one slot to the sums of a pass, of lanes first... of its group.
template <bool kUniform, class Real, class Index>
ERGOTIC_INLINE void addSlot(const SparseArguments<Real>& a,
                            Cursor<Real>& at,
                            std::size_t base,
                            const Index* index,
                            int first,
                            const Lanes<Real>& here,
                            Lanes<Real>& sums) noexcept {
#pragma GCC unroll 4
  for (int p = 0; p < kParts<Real>; ++p) {
    const int lane = first + p * kWidth<Real>;
    Vector<Real> x;
    Vector<Real> d;
    pick(a, base, index + lane, x, d);
    x -= here.x[p];
    d -= here.d[p];
    if constexpr (kUniform) {
      const unsigned present = static_cast<unsigned>(*at.present) >> lane;
      sums.x[p] = addPresent(sums.x[p], x, present);
      sums.d[p] = addPresent(sums.d[p], d, present);
    } else {
      sums.x[p] += loadCoefficients(at.ks + lane) * x;
      sums.d[p] += loadCoefficients(at.zs + lane) * d;
    }
  }
  if constexpr (kUniform) {
    ++at.present;
  } else {
    at.ks += kSparseLanes;
    at.zs += kSparseLanes;
  }
}

/// Sums over the neighbours of the nodes of one pass: forces of springs in x, of dampers in d.
template <bool kUniform, class Real>
ERGOTIC_INLINE Lanes<Real> sumNeighbours(const SparseArguments<Real>& a,
                                         Cursor<Real>& at,
                                         int group,
                                         int first,
                                         const Lanes<Real>& here) noexcept {
  Lanes<Real> sums{};
  const std::uint32_t* last_window = a.window + a.first_window[group + 1];
  for (; at.window != last_window; ++at.window, at.lane += kSparseLanes) {
    addSlot<kUniform>(a, at, *at.window, at.lane, first, here, sums);
  }
  const std::uint32_t* last_node = a.pick + std::size_t{a.first_pick[group + 1]} * kSparseLanes;
  for (; at.node != last_node; at.node += kSparseLanes) {
    addSlot<kUniform>(a, at, 0, at.node, first, here, sums);
  }
  if constexpr (kUniform) {
#pragma GCC unroll 4
    for (int p = 0; p < kParts<Real>; ++p) {
      sums.x[p] *= a.k;
      sums.d[p] *= a.z;
    }
  }
  return sums;
}

/// A sum kept in one part for each lane, whatever the width of vectors.
template <class Real>
struct LaneSums {
  Vector<Real> parts[kSparseLanes / kWidth<Real>] = {};

  double total() const noexcept {
    double sum = 0.0;
    for (int lane = 0; lane < kSparseLanes; ++lane) {
      sum += static_cast<double>(parts[lane / kWidth<Real>][lane % kWidth<Real>]);
    }
    return sum;
  }
};

template <bool kUniform, bool kMetered, class Real>
double forceLoop(const SparseArguments<Real>& given, int first, int last) noexcept {
  constexpr int kPassLanes = kParts<Real> * kWidth<Real>;
  const SparseArguments<Real> a = given;
  LaneSums<Real> lost;
  Cursor<Real> begin(a, first);
  for (int group = first; group < last; ++group) {
    Cursor<Real> end = begin;
#pragma GCC unroll 2
    for (int lane = 0; lane < kSparseLanes; lane += kPassLanes) {
      end = begin;
      const std::ptrdiff_t node = std::ptrdiff_t{group} * kSparseLanes + lane;
      Lanes<Real> here;
#pragma GCC unroll 4
      for (int p = 0; p < kParts<Real>; ++p) {
        here.x[p] = load(a.x + node + p * kWidth<Real>);
        here.d[p] = load(a.d + node + p * kWidth<Real>);
      }
      const Lanes<Real> sums = sumNeighbours<kUniform>(a, end, group, lane, here);
#pragma GCC unroll 4
      for (int p = 0; p < kParts<Real>; ++p) {
        store(a.f + node + p * kWidth<Real>, sums.x[p] + sums.d[p]);
        if constexpr (kMetered) {
          lost.parts[lane / kWidth<Real> + p] +=
              sums.d[p] * (here.d[p] + load(a.d_last + node + p * kWidth<Real>));
        }
      }
    }
    begin = end;
  }
  return kMetered ? -lost.total() : 0.0;
}

template <class Real>
double forces(const SparseArguments<Real>& a, int first, int last) noexcept {
  if (a.ks == nullptr) {
    return a.d_last != nullptr ? forceLoop<true, true>(a, first, last)
                               : forceLoop<true, false>(a, first, last);
  }
  return a.d_last != nullptr ? forceLoop<false, true>(a, first, last)
                             : forceLoop<false, false>(a, first, last);
}

template <class Real>
void pair(const SparseArguments<Real>& a, Real* pairs, int first, int last) noexcept {
  const Real* __restrict x = a.x;
  const Real* __restrict d = a.d;
  Real* __restrict to = pairs;
  const std::ptrdiff_t end = std::ptrdiff_t{last} * kSparseLanes;
#pragma GCC ivdep
  for (std::ptrdiff_t s = std::ptrdiff_t{first} * kSparseLanes; s < end; ++s) {
    to[2 * s] = x[s];
    to[2 * s + 1] = d[s];
  }
}

template <class Real>
constexpr SparseKernels<Real> kKernels{forces<Real>, pair<Real>};

}  // namespace

template <>
const SparseKernels<float>& kernels() noexcept {
  return kKernels<float>;
}
template <>
const SparseKernels<double>& kernels() noexcept {
  return kKernels<double>;
}

}  // namespace ergotic::physics::kernels::ERGOTIC_LEVEL
