// SPDX-License-Identifier: BSD-3-Clause
// The kernels of links in the plane and in space, compiled once for each level of vector
// instructions: CMakeLists.txt sets ERGOTIC_LEVEL, the namespace, and ERGOTIC_VECTOR_BYTES. Nothing
// here may be shared with other translation units, which run on other processors: no standard
// library, everything in that namespace.
#include "physics/kernels/spatial_kernels.hpp"

#include "physics/kernels/levels.hpp"

#define ERGOTIC_INLINE inline __attribute__((always_inline))

namespace ergotic::physics::kernels::ERGOTIC_LEVEL {
namespace {

using Index = std::ptrdiff_t;
constexpr int kRow = 16;     // links that are worked out together
constexpr int kChunk = 128;  // whose forces are handed out together

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
ERGOTIC_INLINE Vector<Real> load(const Real* from) noexcept {
  return *reinterpret_cast<const Vector<Real>*>(from);
}
template <class Real>
ERGOTIC_INLINE void store(Real* to, Vector<Real> value) noexcept {
  *reinterpret_cast<Vector<Real>*>(to) = value;
}

ERGOTIC_INLINE float rootOf(float square) noexcept {
  return __builtin_sqrtf(square);
}
ERGOTIC_INLINE double rootOf(double square) noexcept {
  return __builtin_sqrt(square);
}
template <class Real>
ERGOTIC_INLINE Vector<Real> roots(Vector<Real> squares) noexcept {
  Real root[kWidth<Real>];
  for (int i = 0; i < kWidth<Real>; ++i) {
    root[i] = rootOf(squares[i]);
  }
  return load(root);
}

/// Pointers to all numbers of a row of links, in the arrays themselves or in a copy of the row.
template <class Real, int D>
struct Row {
  const Real* k;
  const Real* z;
  const Real* offset;
  const Real* rest[D];
  const Real* xa[D];
  const Real* xb[D];
  const Real* da[D];
  const Real* db[D];
  const Real* moved_a[D];
  const Real* moved_b[D];
  Real* elastic[D];
  Real* viscous[D];
};

/// Room for a row that is not whole, or whose ends lie apart. What is no link has K = Z = 0.
template <class Real, int D>
struct Copy {
  Real link[3][kRow];
  Real rest[D][kRow];
  Real end[6][D][kRow];
  Real memory[2][D][kRow];
};

/// A sum of work kept in one part for each lane of a row, whatever the width of vectors.
struct LaneSums {
  double lane[kRow] = {};
  template <class Real>
  ERGOTIC_INLINE void add(int first, Vector<Real> work) noexcept {
    for (int i = 0; i < kWidth<Real>; ++i) {
      lane[first + i] += static_cast<double>(work[i]);
    }
  }
  double total() const noexcept {
    double sum = 0.0;
    for (const double part : lane) {
      sum += part;
    }
    return sum;
  }
};

/// Works a row out, with `force` on end b. Sums are twice the work.
template <class Real, int D, bool kGap, bool kMetered>
ERGOTIC_INLINE void stepRow(const Row<Real, D>& row,
                            Real (*force)[kChunk],
                            Index to,
                            LaneSums& stored,
                            LaneSums& lost) noexcept {
  constexpr Vector<Real> kNone{};
  for (int i = 0; i < kRow; i += kWidth<Real>) {
    Vector<Real> apart[D];
    Vector<Real> square = kNone;
    Vector<Real> along = kNone;
    for (int c = 0; c < D; ++c) {
      apart[c] = load(row.xa[c] + i) - load(row.xb[c] + i) + load(row.rest[c] + i);
      square += apart[c] * apart[c];
      along += apart[c] * (load(row.da[c] + i) - load(row.db[c] + i));
    }
    const Vector<Real> length = roots<Real>(square);
    // Without a direction there is no force.
    const Vector<Real> scale = length > kNone ? Real(1) / length : kNone;
    const Vector<Real> u = kGap ? load(row.offset + i) - length : length + load(row.offset + i);
    Vector<Real> elastic = scale * (load(row.k + i) * u);
    Vector<Real> viscous = scale * (load(row.z + i) * (scale * along));
    if constexpr (kGap) {
      elastic = u > kNone ? -elastic : kNone;
      viscous = u > kNone ? viscous : kNone;
    }
    Vector<Real> work_elastic = kNone;
    Vector<Real> work_viscous = kNone;
    for (int c = 0; c < D; ++c) {
      const Vector<Real> e = elastic * apart[c];
      const Vector<Real> v = viscous * apart[c];
      store(&force[c][to + i], e + v);
      if constexpr (kMetered) {
        const Vector<Real> moved = load(row.moved_a[c] + i) - load(row.moved_b[c] + i);
        work_elastic += moved * (e + load(row.elastic[c] + i));
        work_viscous += moved * (v + load(row.viscous[c] + i));
        store(row.elastic[c] + i, e);
        store(row.viscous[c] + i, v);
      }
    }
    if constexpr (kMetered) {
      stored.add<Real>(i, work_elastic);
      lost.add<Real>(i, work_viscous);
    }
  }
}

/// A row of consecutive ends lies in the arrays as it is.
template <class Real, int D, bool kMetered>
ERGOTIC_INLINE Row<Real, D> rowAt(const SpatialArguments<Real>& a,
                                  Index link,
                                  Index slot_a,
                                  Index slot_b) noexcept {
  Row<Real, D> row{};
  row.k = a.k + link;
  row.z = a.z + link;
  row.offset = a.offset + link;
  for (int c = 0; c < D; ++c) {
    const Index on_a = slot_a + c * a.stride;
    const Index on_b = slot_b + c * a.stride;
    row.rest[c] = a.rests + c * a.links + link;
    row.xa[c] = a.x + on_a;
    row.xb[c] = a.x + on_b;
    row.da[c] = a.d + on_a;
    row.db[c] = a.d + on_b;
    if constexpr (kMetered) {
      row.moved_a[c] = a.moved + on_a;
      row.moved_b[c] = a.moved + on_b;
      row.elastic[c] = a.elastic + c * a.links + link;
      row.viscous[c] = a.viscous + c * a.links + link;
    }
  }
  return row;
}

template <class Real, int D, bool kMetered>
ERGOTIC_INLINE Row<Real, D> rowOf(Copy<Real, D>& copy) noexcept {
  Row<Real, D> row{};
  row.k = copy.link[0];
  row.z = copy.link[1];
  row.offset = copy.link[2];
  for (int c = 0; c < D; ++c) {
    row.rest[c] = copy.rest[c];
    row.xa[c] = copy.end[0][c];
    row.xb[c] = copy.end[1][c];
    row.da[c] = copy.end[2][c];
    row.db[c] = copy.end[3][c];
    if constexpr (kMetered) {
      row.moved_a[c] = copy.end[4][c];
      row.moved_b[c] = copy.end[5][c];
      row.elastic[c] = copy.memory[0][c];
      row.viscous[c] = copy.memory[1][c];
    }
  }
  return row;
}

/// Slots of the ends of the links of a span.
struct EndsOf {
  LinkSpan span;
  const LinkEnds* ends;
  ERGOTIC_INLINE Index a(Index link) const noexcept {
    return span.a < 0 ? ends[link].a : span.a + (link - span.first);
  }
  ERGOTIC_INLINE Index b(Index link) const noexcept {
    return span.a < 0 ? ends[link].b : span.b + (link - span.first);
  }
};

template <class Real, int D, bool kMetered>
ERGOTIC_INLINE void copyIn(const SpatialArguments<Real>& a,
                           const EndsOf& ends,
                           Index link,
                           int count,
                           Copy<Real, D>& copy) noexcept {
  if (count < kRow) {
    copy = {};
  }
  for (int i = 0; i < count; ++i) {
    const Index l = link + i;
    copy.link[0][i] = a.k[l];
    copy.link[1][i] = a.z[l];
    copy.link[2][i] = a.offset[l];
    for (int c = 0; c < D; ++c) {
      const Index on_a = ends.a(l) + c * a.stride;
      const Index on_b = ends.b(l) + c * a.stride;
      copy.rest[c][i] = a.rests[c * a.links + l];
      copy.end[0][c][i] = a.x[on_a];
      copy.end[1][c][i] = a.x[on_b];
      copy.end[2][c][i] = a.d[on_a];
      copy.end[3][c][i] = a.d[on_b];
      if constexpr (kMetered) {
        copy.end[4][c][i] = a.moved[on_a];
        copy.end[5][c][i] = a.moved[on_b];
        copy.memory[0][c][i] = a.elastic[c * a.links + l];
        copy.memory[1][c][i] = a.viscous[c * a.links + l];
      }
    }
  }
}

/// Copies the memory of a row back to the arrays.
template <class Real, int D>
ERGOTIC_INLINE void copyOut(const SpatialArguments<Real>& a,
                            Index link,
                            int count,
                            const Copy<Real, D>& copy) noexcept {
  for (int c = 0; c < D; ++c) {
    for (int i = 0; i < count; ++i) {
      a.elastic[c * a.links + link + i] = copy.memory[0][c][i];
      a.viscous[c * a.links + link + i] = copy.memory[1][c][i];
    }
  }
}

/// Adds the forces to one end after the other: a force just written is read again only much later.
template <class Real, int D>
ERGOTIC_INLINE void handOut(const SpatialArguments<Real>& a,
                            const EndsOf& ends,
                            Index link,
                            Index count,
                            const Real (*force)[kChunk]) noexcept {
  for (int c = 0; c < D; ++c) {
    Real* f = a.f + c * a.stride;
    if (ends.span.a >= 0) {
      Real* on_a = f + ends.a(link);
      Real* on_b = f + ends.b(link);
#pragma GCC ivdep
      for (Index i = 0; i < count; ++i) {
        on_a[i] -= force[c][i];
      }
#pragma GCC ivdep
      for (Index i = 0; i < count; ++i) {
        on_b[i] += force[c][i];
      }
    } else {
      for (Index i = 0; i < count; ++i) {
        f[ends.ends[link + i].a] -= force[c][i];
        f[ends.ends[link + i].b] += force[c][i];
      }
    }
  }
}

template <class Real, int D, bool kGap, bool kMetered>
SpatialWork stepSpans(const SpatialArguments<Real>& given) noexcept {
  const SpatialArguments<Real> a = given;
  Real force[D][kChunk];
  Copy<Real, D> copy;
  LaneSums stored;
  LaneSums lost;
  for (const LinkSpan* span = a.spans; span != a.spans + a.span_count; ++span) {
    const EndsOf ends{*span, a.ends};
    const Index past = Index{span->first} + span->count;
    for (Index chunk = span->first; chunk < past; chunk += kChunk) {
      const Index chunk_end = chunk + kChunk < past ? chunk + kChunk : past;
      for (Index l = chunk; l < chunk_end; l += kRow) {
        const int count = static_cast<int>(l + kRow < chunk_end ? kRow : chunk_end - l);
        if (span->a >= 0 && count == kRow) {
          stepRow<Real, D, kGap, kMetered>(rowAt<Real, D, kMetered>(a, l, ends.a(l), ends.b(l)),
                                           force, l - chunk, stored, lost);
          continue;
        }
        copyIn<Real, D, kMetered>(a, ends, l, count, copy);
        stepRow<Real, D, kGap, kMetered>(rowOf<Real, D, kMetered>(copy), force, l - chunk, stored,
                                         lost);
        if constexpr (kMetered) {
          copyOut(a, l, count, copy);
        }
      }
      handOut<Real, D>(a, ends, chunk, chunk_end - chunk, force);
    }
  }
  return {stored.total(), lost.total()};
}

template <class Real, int D, bool kGap>
SpatialWork step(const SpatialArguments<Real>& a) noexcept {
  return a.elastic != nullptr ? stepSpans<Real, D, kGap, true>(a)
                              : stepSpans<Real, D, kGap, false>(a);
}

template <class Real>
constexpr SpatialKernels<Real> kKernels{
    {step<Real, 1, false>, step<Real, 2, false>, step<Real, 3, false>},
    {step<Real, 1, true>, step<Real, 2, true>, step<Real, 3, true>}};

}  // namespace

template <>
const SpatialKernels<float>& kernels() noexcept {
  return kKernels<float>;
}
template <>
const SpatialKernels<double>& kernels() noexcept {
  return kKernels<double>;
}

}  // namespace ergotic::physics::kernels::ERGOTIC_LEVEL
