// SPDX-License-Identifier: BSD-3-Clause
#include "physics/engine/sweeper.hpp"

#include <algorithm>

#include "at.hpp"
#include "physics/kernels/levels.hpp"
#include "physics/kernels/sparse_arguments.hpp"

namespace ergotic::physics {
template <class Real>
struct Sweeper<Real>::Arrays {
  kernels::MoveArguments<Real> move{};
  Real* f = nullptr;
  const Real* u = nullptr;  // x, or x + ratio d
  const Real* d = nullptr;  // null: u has it all
  Real* pairs = nullptr;
};

template <class Real>
Sweeper<Real>::Sweeper(const Layout& layout, const CompileOptions& options)
    : layout_(layout),
      kernels_(kernels::kernelsOf<kernels::BlockKernels<Real>>(options.isa)),
      sparse_kernels_(kernels::kernelsOf<kernels::SparseKernels<Real>>(options.isa)),
      isa_(options.isa),
      metered_(options.metered) {
  const bool any = std::any_of(layout.blocks.begin(), layout.blocks.end(),
                               [](const Block& block) { return block.one_ratio; });
  sums_.assign(any ? at(layout.slots()) : 0, Real(0));
  const bool pairs =
      std::any_of(layout.blocks.begin(), layout.blocks.end(), [&](const Block& block) {
        return block.kind == Block::Kind::kSparse &&
               kernels::sparseNeedsPairs(isa_, block.program->pick.size());
      });
  pairs_.assign(pairs ? 2 * at(layout.slots()) : 0, Real(0));
}

template <class Real>
typename Sweeper<Real>::Arrays Sweeper<Real>::arraysOf(std::size_t b,
                                                       const CoefficientsOf<Real>& c,
                                                       State<Real>& state) const noexcept {
  const Block& block = layout_.blocks[b];
  const std::size_t first = at(block.first);
  Arrays a;
  a.f = state.f() + first;
  a.move.x = state.x() + first;
  a.move.d = state.d() + first;
  a.move.d_last = metered_ ? state.dLast() + first : nullptr;
  a.move.f = a.f;
  a.move.inverse_mass = c.masses.inverse_mass.data() + first;
  if (block.has_drift || block.has_cells) {
    a.move.drift = c.masses.drift.data() + first;
  }
  if (block.has_cells) {
    a.move.lose = c.masses.lose.data() + first;
    a.move.pull = c.masses.pull.data() + first;
    a.move.loss = c.masses.loss.data() + first;
  }
  a.pairs = pairs_.empty() ? nullptr : pairs_.data() + 2 * first;
  a.u = a.move.x;
  a.d = a.move.d;
  if (block.one_ratio) {
    a.d = nullptr;
    a.move.ratio = c.blocks[b].ratio;
    if (a.move.ratio != Real(0)) {
      a.move.y = sums_.data() + first;
      a.u = a.move.y;
    }
  }
  return a;
}

template <class Real>
double Sweeper<Real>::sweep(std::size_t b,
                            const CoefficientsOf<Real>& c,
                            State<Real>& state) const noexcept {
  const Block& block = layout_.blocks[b];
  const Arrays a = arraysOf(b, c, state);
  switch (block.kind) {
    case Block::Kind::kChains:
      return 0.5 * chains(block, c.blocks[b], a);
    case Block::Kind::kSparse:
      return 0.5 * sparse(block, c.blocks[b], a);
    default:
      return 0.5 * lattice(block, c.blocks[b], a);
  }
}

template <class Real>
double Sweeper<Real>::sparse(const Block& block,
                             const BlockCoefficients<Real>& c,
                             const Arrays& a) const noexcept {
  double twice = kernels_.move(a.move, 0, block.elements);
  kernels::SparseArguments<Real> links = kernels::sparseArguments<Real>(*block.program);
  links.ks = c.k.data();
  links.zs = c.z.data();
  links.x = a.move.x;
  links.d = a.move.d;
  links.d_last = a.move.d_last;
  links.f = a.f;
  if (kernels::sparseNeedsPairs(isa_, block.program->pick.size())) {
    sparse_kernels_.pair(links, a.pairs, 0, block.program->groups);
    links.pairs = a.pairs;
  }
  twice += sparse_kernels_.forces(links, 0, block.program->groups);
  for (std::size_t i = 0; i < c.bias.size(); ++i) {
    a.f[i] += c.bias[i];
  }
  return twice;
}

template <class Real>
double Sweeper<Real>::chains(const Block& block,
                             const BlockCoefficients<Real>& c,
                             const Arrays& a) const noexcept {
  const kernels::ChainArguments<Real> chains{a.move, a.f, c.k.data(), c.z.data(),
                                             block.per_lane ? 0 : kLanes};
  return kernels_.chains(chains, 0, block.elements);
}

/// Band by band: forces of what has moved, as far as all neighbours have.
template <class Real>
double Sweeper<Real>::lattice(const Block& block,
                              const BlockCoefficients<Real>& c,
                              const Arrays& a) const noexcept {
  const int band = bandOf(block, kBand);
  double twice = 0.0;
  for (int index = 0; index * band < block.elements; ++index) {
    twice += stepBand(block, c, a, band, index);
  }
  return twice;
}

/// True for a lattice whose numbers do not fit into the second-level cache.
template <class Real>
bool Sweeper<Real>::goesInWaves(const Block& block) noexcept {
  const auto different = [](const Block::Segment& segment) { return !segment.uniform; };
  if (block.kind != Block::Kind::kLattice) {
    return false;
  }
  std::size_t numbers = 6;  // x, d, d_last, x + ratio d, f, inverse mass
  if (std::any_of(block.segments.begin(), block.segments.end(), different)) {
    numbers += block.offsets.size() * (block.one_ratio ? 1 : 2);
  }
  return numbers * sizeof(Real) * at(block.elements) > kFitsBytes;
}

template <class Real>
Block::Segment Sweeper<Real>::knownAfter(const Block& block, int band, int index) noexcept {
  const int begin = index * band;
  const int end = begin + band;
  return {index == 0 ? 0 : begin - block.guard,
          end >= block.elements ? block.elements : end - block.guard, false};
}

template <class Real>
double Sweeper<Real>::sweepBand(std::size_t b,
                                int band,
                                int index,
                                const CoefficientsOf<Real>& c,
                                State<Real>& state) const noexcept {
  return 0.5 * stepBand(layout_.blocks[b], c.blocks[b], arraysOf(b, c, state), band, index);
}

template <class Real>
double Sweeper<Real>::stepBand(const Block& block,
                               const BlockCoefficients<Real>& c,
                               const Arrays& a,
                               int band,
                               int index) const noexcept {
  const int begin = index * band;
  const int end = std::min(begin + band, block.elements);
  const double twice = kernels_.move(a.move, std::max(begin, block.segments.front().begin),
                                     std::min(end, block.segments.back().end));
  const Block::Segment known = knownAfter(block, band, index);
  return twice + links(block, c, a, known.begin, known.end);
}

template <class Real>
double Sweeper<Real>::links(const Block& block,
                            const BlockCoefficients<Real>& c,
                            const Arrays& a,
                            int begin,
                            int end) const noexcept {
  if (block.has_bias) {
    std::copy(c.bias.data() + begin, c.bias.data() + end, a.f + begin);
  }
  double twice = 0.0;
  for (const Block::Segment& segment : block.segments) {
    const int from = std::max(begin, segment.begin);
    const int to = std::min(end, segment.end);
    if (from < to) {
      twice += forces(block, c, a, {from, to, segment.uniform});
    }
  }
  return twice;
}

/// The next diagonals of a block, up to as many as a pass takes.
template <class Real>
kernels::LatticeArguments<Real> Sweeper<Real>::diagonalsOf(const Block& block,
                                                           const BlockCoefficients<Real>& c,
                                                           const Arrays& a,
                                                           std::size_t from,
                                                           bool uniform) const noexcept {
  kernels::LatticeArguments<Real> links{};
  links.u = a.u;
  links.d = a.d;
  links.d_last = a.move.d_last;
  links.f = a.f;
  links.adds = from > 0 || block.has_bias;
  const std::size_t count = std::min(at(kMaxDiagonals), block.offsets.size() - from);
  links.diagonals = static_cast<int>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = from + i;
    links.offset[i] = block.offsets[k];
    if (uniform) {
      links.k[i] = c.uniform_k[k];
      links.z[i] = c.uniform_z[k];
    } else {
      const std::size_t first = k * at(block.guard + block.elements) + at(block.guard);
      links.ks[i] = c.k.data() + first;
      links.zs[i] = c.z.empty() ? links.ks[i] : c.z.data() + first;
    }
  }
  return links;
}

/// Forces of all diagonals: a plate's pass where there is one, passes over the others.
template <class Real>
double Sweeper<Real>::forces(const Block& block,
                             const BlockCoefficients<Real>& c,
                             const Arrays& a,
                             const Block::Segment& range) const noexcept {
  double twice = 0.0;
  for (std::size_t k = 0; k < block.offsets.size(); k += at(kMaxDiagonals)) {
    kernels::LatticeArguments<Real> links = diagonalsOf(block, c, a, k, range.uniform);
    if (k == 0 && range.uniform && block.pitch > 0) {
      kernels_.plate(plateOf(block, c, a), range.begin, range.end);
    } else {
      kernels_.lattice(links, range.begin, range.end);
    }
    if (metered_) {
      links.d = a.move.d;
      const bool scaled = !range.uniform && c.z.empty();
      twice += (scaled ? static_cast<double>(c.ratio) : 1.0) *
               kernels_.viscous(links, range.begin, range.end);
    }
  }
  return twice;
}

template <class Real>
kernels::PlateArguments<Real> Sweeper<Real>::plateOf(const Block& block,
                                                     const BlockCoefficients<Real>& c,
                                                     const Arrays& a) const noexcept {
  const bool corners = block.offsets.size() > 2;
  const std::size_t across = corners ? 2 : 1;
  kernels::PlateArguments<Real> plate{};
  plate.u = a.u;
  plate.d = a.d;
  plate.f = a.f;
  plate.pitch = block.pitch;
  plate.corners = corners;
  plate.k_along = c.uniform_k[0];
  plate.z_along = c.uniform_z[0];
  plate.k_across = c.uniform_k[across];
  plate.z_across = c.uniform_z[across];
  plate.k_corner = corners ? c.uniform_k[1] : Real(0);
  plate.z_corner = corners ? c.uniform_z[1] : Real(0);
  return plate;
}

template class Sweeper<float>;
template class Sweeper<double>;

}  // namespace ergotic::physics
