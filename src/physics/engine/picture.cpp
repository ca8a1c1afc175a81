// SPDX-License-Identifier: BSD-3-Clause
#include "physics/engine/picture.hpp"

#include <utility>

#include "at.hpp"

namespace ergotic::physics {
namespace {

template <class Real>
float seenAt(const TapPoint& tap, int coordinate, const Real* x) noexcept {
  auto sum = static_cast<float>(coordinate == 0 ? tap.offset : 0.0);
  forEachShare(tap, [&](int slot, double weight) {
    sum += static_cast<float>(weight) * static_cast<float>(x[slot + coordinate * tap.stride]);
  });
  return sum;
}

}  // namespace

Picture::Picture(std::shared_ptr<const scene::Scene> played,
                 std::size_t shown,
                 const Layout& layout)
    : played_(std::move(played)), shown_(shown), layout_(layout) {}

template <class Real>
void Picture::read(const Real* x, float* to) const noexcept {
  auto seen = layout_.seen_taps.begin();
  for (int m = 0; m < static_cast<int>(shown_); ++m) {
    const int dimensions = layout_.sections[at(played_->mats[at(m)].section)].dimensions;
    const int slot = layout_.slot_of_mat[at(m)];
    const int stride = slot < 0 ? 0 : layout_.strideOf(*played_, m);
    for (int k = 0; k < dimensions; ++k) {
      *to++ = slot < 0 ? seenAt(*seen, k, x) : static_cast<float>(x[slot + k * stride]);
    }
    seen += slot < 0 ? 1 : 0;
  }
}

template void Picture::read<float>(const float*, float*) const noexcept;
template void Picture::read<double>(const double*, float*) const noexcept;

}  // namespace ergotic::physics
