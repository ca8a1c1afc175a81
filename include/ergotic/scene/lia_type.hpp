// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

/// The table of laws of force, one row each. What a row stands for (its name, numbers and ranges,
/// force, slopes, how it may be worked out) is told in one place: `kFeltLaw` of src/scene/laws for
/// `Felt`. Laws written out: docs/physics/elements.md, "Links". New ones come last: recordings
/// number them.
#define ERGOTIC_LAWS(ROW)                                                                    \
  ROW(SpringDamper) /* (RES, FRO, REF) f = K e + Z v */                                      \
  ROW(Contact)      /* (BUT) f = K e + Z v while e > 0, e = x_a - x_b + threshold */         \
  ROW(Quadratic)    /* f = K e + Q sgn(e) e^2 + Z v */                                       \
  ROW(Cubic)        /* f = K e + Q e^3 + Z v */                                              \
  ROW(ClippedCubic) /* cubic up to the tipping point, slope K_limit beyond */                \
  ROW(CubicContact) /* the clipped cubic law, gated like a contact */                        \
  ROW(Pluck)        /* plectrum */                                                           \
  ROW(Bow)          /* piecewise linear friction */                                          \
  ROW(SmoothBow)    /* f = 0.63 Z v exp(-4 (v/width)^2 + 0.5) */                             \
  ROW(PowerContact) /* f = K e^exponent + Z v while e > 0 */                                 \
  ROW(Table)        /* (LNL) f = table(e) + viscous_table(v), held beyond the last points */ \
  ROW(Conditional)  /* f = K e + Z v from when |e| < width until |e| > release */            \
  ROW(PluckTable)   /* f = table(e), 0 outside */                                            \
  ROW(BowTable)     /* friction f = table(v), 0 outside */                                   \
  ROW(Felt)         /* f = K e^exponent (1 + damping v) while e > 0, never pulls */          \
  ROW(Relaxing)     /* f = K e + Z v + sum K_r q_r, each q_r follows e and fades */          \
  ROW(Friction)     /* f = N mu(|v|) against the slip, or as much as it takes to stick */    \
  ROW(OneWayPluck)  /* f = K e + Z v while 0 < e <= width, on the way out only */

namespace ergotic::scene {

#define ERGOTIC_ENUMERATOR(name) k##name,
enum class LiaType : std::uint8_t { ERGOTIC_LAWS(ERGOTIC_ENUMERATOR) };
#undef ERGOTIC_ENUMERATOR

#define ERGOTIC_COUNT(name) +1
constexpr std::size_t kLiaTypes = ERGOTIC_LAWS(ERGOTIC_COUNT);
#undef ERGOTIC_COUNT

}  // namespace ergotic::scene
