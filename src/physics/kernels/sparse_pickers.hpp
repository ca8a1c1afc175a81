// SPDX-License-Identifier: BSD-3-Clause
// How the sparse kernels fetch neighbours at one level of vector instructions: part of
// sparse_kernels.cpp, under its rules.
#if defined(__AVX512F__)
#include <immintrin.h>
#if !defined(__clang__)
// GCC 12 takes the undefined parts of its own intrinsics for mistakes.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#endif

#define ERGOTIC_INLINE inline __attribute__((always_inline))

namespace ergotic::physics::kernels::ERGOTIC_LEVEL {
namespace {

constexpr int kSparseLanes = 16;
#if defined(__AVX512F__)
constexpr int kBytes = 64;
#else
constexpr int kBytes = 16;
#endif

template <class Real>
struct VectorOf;
template <>
struct VectorOf<float> {
  typedef float Type __attribute__((vector_size(kBytes), aligned(4), may_alias));
  typedef int Bits __attribute__((vector_size(kBytes)));
};
template <>
struct VectorOf<double> {
  typedef double Type __attribute__((vector_size(kBytes), aligned(8), may_alias));
  typedef long long Bits __attribute__((vector_size(kBytes)));
};
template <class Real>
using Vector = typename VectorOf<Real>::Type;
template <class Real>
using Bits = typename VectorOf<Real>::Bits;

template <class Real>
constexpr int kWidth = kBytes / static_cast<int>(sizeof(Real));
/// Vectors that one pass over the slots of a group takes: those of all lanes with AVX-512, else as
/// many as there are registers for.
template <class Real>
constexpr int kParts = kBytes == 64 ? kSparseLanes / kWidth<Real> : 4;

/// A part of the coefficients of a slot, which are aligned.
template <class Real>
struct Coefficients;
template <>
struct Coefficients<float> {
  typedef float Type __attribute__((vector_size(kBytes), aligned(16), may_alias));
};
template <>
struct Coefficients<double> {
  typedef double Type __attribute__((vector_size(kBytes), aligned(16), may_alias));
};

template <class Real>
ERGOTIC_INLINE Vector<Real> loadCoefficients(const Real* from) noexcept {
  return *reinterpret_cast<const typename Coefficients<Real>::Type*>(from);
}
template <class Real>
ERGOTIC_INLINE Vector<Real> load(const Real* from) noexcept {
  return *reinterpret_cast<const Vector<Real>*>(from);
}
template <class Real>
ERGOTIC_INLINE void store(Real* to, Vector<Real> value) noexcept {
  *reinterpret_cast<Vector<Real>*>(to) = value;
}

/// x and d of the lanes of one pass.
template <class Real>
struct Lanes {
  Vector<Real> x[kParts<Real>];
  Vector<Real> d[kParts<Real>];
};

#if defined(__AVX512F__)

/// Neighbours in a window of 32 nodes.
ERGOTIC_INLINE Vector<float> pickNear(const float* window, const std::uint8_t* lane) noexcept {
  const __m512i index =
      _mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(lane)));
  return _mm512_permutex2var_ps(_mm512_loadu_ps(window), index, _mm512_loadu_ps(window + 16));
}
ERGOTIC_INLINE Vector<double> pickNear(const double* window, const std::uint8_t* lane) noexcept {
  const __m512i index =
      _mm512_cvtepu8_epi64(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(lane)));
  const __m512d low =
      _mm512_permutex2var_pd(_mm512_loadu_pd(window), index, _mm512_loadu_pd(window + 8));
  const __m512d high =
      _mm512_permutex2var_pd(_mm512_loadu_pd(window + 16), index, _mm512_loadu_pd(window + 24));
  return _mm512_mask_blend_pd(_mm512_test_epi64_mask(index, _mm512_set1_epi64(16)), low, high);
}
template <class Real>
ERGOTIC_INLINE void pick(const SparseArguments<Real>& a,
                         std::size_t window,
                         const std::uint8_t* lane,
                         Vector<Real>& x,
                         Vector<Real>& d) noexcept {
  x = pickNear(a.x + window, lane);
  d = pickNear(a.d + window, lane);
}

/// Neighbours anywhere. One by one is faster than the gather instruction.
ERGOTIC_INLINE void pick(const SparseArguments<float>& a,
                         std::size_t,
                         const std::uint32_t* node,
                         Vector<float>& x,
                         Vector<float>& d) noexcept {
  const auto two = [&](int i) noexcept {
    const double* pairs = reinterpret_cast<const double*>(a.pairs);
    return _mm_loadh_pd(_mm_load_sd(pairs + node[i]), pairs + node[i + 1]);
  };
  const auto eight = [&](int i) noexcept {
    const __m256d low = _mm256_insertf128_pd(_mm256_castpd128_pd256(two(i)), two(i + 2), 1);
    const __m256d high = _mm256_insertf128_pd(_mm256_castpd128_pd256(two(i + 4)), two(i + 6), 1);
    return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1));
  };
  const __m512 one = eight(0);
  const __m512 other = eight(8);
  const __m512i even = _mm512_set_epi32(30, 28, 26, 24, 22, 20, 18, 16, 14, 12, 10, 8, 6, 4, 2, 0);
  x = _mm512_permutex2var_ps(one, even, other);
  d = _mm512_permutex2var_ps(one, _mm512_add_epi32(even, _mm512_set1_epi32(1)), other);
}
ERGOTIC_INLINE void pick(const SparseArguments<double>& a,
                         std::size_t,
                         const std::uint32_t* node,
                         Vector<double>& x,
                         Vector<double>& d) noexcept {
  const auto one = [&](int i) noexcept {
    return _mm_loadu_pd(a.pairs + 2 * static_cast<std::size_t>(node[i]));
  };
  const auto four = [&](int i) noexcept {
    const __m256d low = _mm256_insertf128_pd(_mm256_castpd128_pd256(one(i)), one(i + 1), 1);
    const __m256d high = _mm256_insertf128_pd(_mm256_castpd128_pd256(one(i + 2)), one(i + 3), 1);
    return _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
  };
  const __m512d low = four(0);
  const __m512d high = four(4);
  x = _mm512_permutex2var_pd(low, _mm512_set_epi64(14, 12, 10, 8, 6, 4, 2, 0), high);
  d = _mm512_permutex2var_pd(low, _mm512_set_epi64(15, 13, 11, 9, 7, 5, 3, 1), high);
}

/// Lanes that are not present add nothing.
ERGOTIC_INLINE Vector<float> addPresent(Vector<float> sum,
                                        Vector<float> term,
                                        unsigned present) noexcept {
  const __m512 before = sum;
  return _mm512_mask_add_ps(before, static_cast<__mmask16>(present), before, term);
}
ERGOTIC_INLINE Vector<double> addPresent(Vector<double> sum,
                                         Vector<double> term,
                                         unsigned present) noexcept {
  const __m512d before = sum;
  return _mm512_mask_add_pd(before, static_cast<__mmask8>(present), before, term);
}

#else

/// Neighbours at `index` after `base`: pairs, taken apart.
template <class Index>
ERGOTIC_INLINE void pick(const SparseArguments<float>& a,
                         std::size_t base,
                         const Index* index,
                         Vector<float>& x,
                         Vector<float>& d) noexcept {
  typedef double Pair __attribute__((may_alias));
  typedef double Two __attribute__((vector_size(16)));
  const Pair* pairs = reinterpret_cast<const Pair*>(a.pairs) + base;
  const auto low = reinterpret_cast<Vector<float>>(Two{pairs[index[0]], pairs[index[1]]});
  const auto high = reinterpret_cast<Vector<float>>(Two{pairs[index[2]], pairs[index[3]]});
  x = __builtin_shufflevector(low, high, 0, 2, 4, 6);
  d = __builtin_shufflevector(low, high, 1, 3, 5, 7);
}
template <class Index>
ERGOTIC_INLINE void pick(const SparseArguments<double>& a,
                         std::size_t base,
                         const Index* index,
                         Vector<double>& x,
                         Vector<double>& d) noexcept {
  const Vector<double> low = load(a.pairs + 2 * (base + index[0]));
  const Vector<double> high = load(a.pairs + 2 * (base + index[1]));
  x = __builtin_shufflevector(low, high, 0, 2);
  d = __builtin_shufflevector(low, high, 1, 3);
}

/// `bits`: which lane of present each 4 bytes of a vector stand for.
template <class Real>
ERGOTIC_INLINE Vector<Real> addBits(Vector<Real> sum,
                                    Vector<Real> term,
                                    unsigned present,
                                    Bits<float> bits) noexcept {
  const int all = static_cast<int>(present);
  const Bits<float> on = (Bits<float>{all, all, all, all} & bits) != 0;
  return sum + reinterpret_cast<Vector<Real>>(reinterpret_cast<Bits<float>>(term) & on);
}
/// Lanes that are not present add nothing.
ERGOTIC_INLINE Vector<float> addPresent(Vector<float> sum,
                                        Vector<float> term,
                                        unsigned present) noexcept {
  return addBits<float>(sum, term, present, Bits<float>{1, 2, 4, 8});
}
ERGOTIC_INLINE Vector<double> addPresent(Vector<double> sum,
                                         Vector<double> term,
                                         unsigned present) noexcept {
  return addBits<double>(sum, term, present, Bits<float>{1, 1, 2, 2});
}

#endif

}  // namespace
}  // namespace ergotic::physics::kernels::ERGOTIC_LEVEL
