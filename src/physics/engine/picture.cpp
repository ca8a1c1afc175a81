// SPDX-License-Identifier: BSD-3-Clause
#include "physics/engine/picture.hpp"

#include <utility>

#include "at.hpp"

namespace ergotic::physics {
Picture::Picture(std::shared_ptr<const scene::Scene> written,
                 std::shared_ptr<const scene::Scene> played,
                 const Layout& layout,
                 std::optional<AsWritten> as_written)
    : written_(std::move(written)),
      played_(std::move(played)),
      layout_(layout),
      as_written_(std::move(as_written)) {}

template <class Real>
void Picture::read(const Real* x, float* to) const noexcept {
  std::size_t picture = 0;
  for (std::size_t written = 0; written < written_->mats.size(); ++written) {
    const int m = as_written_ ? as_written_->mats[written] : static_cast<int>(written);
    if (m < 0) {
      *to++ = sumOf(as_written_->pictures[picture++], x);
      continue;
    }
    const SectionRange& range = layout_.sections[at(played_->mats[at(m)].section)];
    const int stride = layout_.strideOf(*played_, m);
    for (int k = 0; k < range.dimensions; ++k) {
      *to++ = static_cast<float>(x[layout_.slot_of_mat[at(m)] + k * stride]);
    }
  }
}

template <class Real>
float Picture::sumOf(const ModalPicture& picture, const Real* x) const noexcept {
  const Real* modes = x + layout_.slot_of_mat[at(picture.first)];
  float sum = 0.0F;
  for (std::size_t k = 0; k < picture.weights.size(); ++k) {
    sum += picture.weights[k] * static_cast<float>(modes[k]);
  }
  return sum;
}

int Picture::liaAsWritten(int lia) const {
  return as_written_ ? as_written_->lias[at(lia)] : lia;
}

template void Picture::read<float>(const float*, float*) const noexcept;
template void Picture::read<double>(const double*, float*) const noexcept;

}  // namespace ergotic::physics
