// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "physics/layout/blocks/link_ends.hpp"

/// Kernels of links between points in the plane or in space, inside one section. One translation
/// unit per level of vector instructions compiles the same source (spatial_kernels.cpp); all give
/// the same bits, as nothing is contracted and sums of work keep one part for each of 16 lanes.
namespace ergotic::physics::kernels {

/// Forces -K (|u| + offset) u / |u| - Z v along the same line, u = x_a - x_b + rest; contacts push,
/// and only while |u| < offset. Coordinate c of a slot lies in slot + c * stride, of a link in
/// c * links + link.
template <class Real>
struct SpatialArguments {
  const LinkSpan* spans;
  std::size_t span_count;
  const LinkEnds* ends;  ///< [links]
  std::ptrdiff_t links;
  std::ptrdiff_t stride;
  const Real* k;  ///< [links]
  const Real* z;
  const Real* offset;
  const Real* rests;  ///< [coordinates][links]
  const Real* x;
  const Real* d;
  const Real* moved;  ///< d, and for points the change of their place too; for work alone
  Real* f;            ///< added to
  Real* elastic;      ///< [coordinates][links] force of the last step; null: nobody asks for work
  Real* viscous;
};

/// Twice the work done over the last step against elastic and viscous forces.
struct SpatialWork {
  double elastic = 0.0;
  double viscous = 0.0;
};

/// The kernels of one level, [coordinates - 1]. All are real-time. \return 0 if nobody asks
template <class Real>
struct SpatialKernels {
  SpatialWork (*springs[3])(const SpatialArguments<Real>&) noexcept;
  SpatialWork (*contacts[3])(const SpatialArguments<Real>&) noexcept;
};

}  // namespace ergotic::physics::kernels
