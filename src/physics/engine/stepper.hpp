// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "physics/engine/sweeper.hpp"
#include "physics/kernels/levels.hpp"
#include "physics/kernels/link_kernels.hpp"
#include "physics/kernels/modal_kernels.hpp"
#include "physics/kernels/spatial_kernels.hpp"
#include "physics/layout/layout.hpp"
#include "physics/state/coefficients.hpp"
#include "physics/state/state.hpp"

namespace ergotic::physics {

/// Moves modules and works out explicit links, section by section and run by run.
template <class Real>
class Stepper {
 public:
  Stepper(const Layout& layout, const CompileOptions& options)
      : layout_(layout),
        sweeper_(layout, options),
        cells_(kernels::kernelsOf<kernels::ModalKernels<Real>>(options.isa)),
        spatial_kernels_(kernels::kernelsOf<kernels::SpatialKernels<Real>>(options.isa)),
        metered_(options.metered) {
    for (const Block& block : layout.blocks) {
      blocks_end_.resize(static_cast<std::size_t>(block.section) + 1, blocks());
      ++blocks_end_.back();
    }
    blocks_end_.resize(layout.sections.size(), blocks());
  }

  /// Steps the modules of a section, and the links in its blocks, once; blocks that go through a
  /// tick alone are left out.
  /// \return energy that cells, medium and the dampers of blocks dissipated in it
  double moveMasses(int section, const CoefficientsOf<Real>& c, State<Real>& state) const noexcept {
    const SectionRange& range = layout_.sections[static_cast<std::size_t>(section)];
    double lost = 0.0;
    for (std::size_t b = firstBlock(section); b < blocks_end_[static_cast<std::size_t>(section)];
         ++b) {
      if (!layout_.blocks[b].is_alone) {
        lost += sweeper_.sweep(b, c, state);
      }
    }
    for (int k = 0; k < range.dimensions; ++k) {
      const int by = k * range.stride;
      lost += moveCells(range.cells + by, range.masses + by, c.masses, state);
      moveFree(range.masses + by, range.fixed + by, c.masses, state);
      std::fill(state.f() + range.cells + by, state.f() + range.end + by, Real(0));
    }
    return lost;
  }

  /// Several steps of a block that nothing else touches; see Sweeper.
  template <class Visit>
  double advance(std::size_t block,
                 int steps,
                 const CoefficientsOf<Real>& c,
                 State<Real>& state,
                 const Visit& visit) const noexcept {
    return sweeper_.advance(block, steps, c, state, visit);
  }

  /// The step of a run of explicit links that begins with frame `now`.
  void stepLinks(std::size_t r,
                 const RunCoefficients<Real>& c,
                 std::int64_t now,
                 State<Real>& state) const noexcept {
    const LinkRun& run = layout_.runs[r];
    if (!run.spans.empty()) {
      return stepSpans(r, c, state);
    }
    const kernels::RunStep<Real> at = stepOfRun(r, now, state);
    kernels::step(run, numbersOf(run, c, state.lawState(r)), c.rests.data(), at);
  }

  /// How the ends of a run count in a step that begins with frame `now`.
  kernels::RunStep<Real> stepOfRun(std::size_t r,
                                   std::int64_t now,
                                   State<Real>& state) const noexcept {
    const LinkRun& run = layout_.runs[r];
    const bool across = run.slow_section >= 0;
    const Real fresh = !across || layout_.isDue(run.slow_section, now) ? Real(1) : Real(0);
    const Real share = static_cast<Real>(run.share);
    kernels::RunStep<Real> at{};
    at.x = state.x();
    at.d = state.d();
    at.moved = state.moved();
    at.d_last = state.dLast();
    at.f = state.f();
    at.gate_a = run.slow_is_a ? fresh : Real(1);
    at.gate_b = run.slow_is_a ? Real(1) : fresh;
    at.share_a = across && run.slow_is_a ? share : Real(1);
    at.share_b = across && !run.slow_is_a ? share : Real(1);
    at.slow_ends = layout_.endsSlowStep(run, now);
    at.memory = state.memory(r);
    at.work = metered_ ? state.work() + r : nullptr;
    return at;
  }

  /// Describes how each section is stepped, some lines for each. Realtime: no
  std::vector<std::string> describe(const scene::Scene& scene) const;

  /// Counts what remembering links hold before anything moves. Realtime: no.
  void storeAtStart(std::size_t r, const RunCoefficients<Real>& c, State<Real>& state) const {
    const LinkRun& run = layout_.runs[r];
    const scene::Law& law = scene::lawOf(run.law);
    // Nothing changes state by this.
    std::vector<Real> trial(law.explicit_form.states * run.ends.size(), Real(0));
    const scene::RunNumbers<Real> numbers = numbersOf(run, c, trial.data());
    const bool is_gap = run.dimensions > 0 && law.kind == scene::Law::Kind::kGap;
    for (std::size_t l = 0; l < run.ends.size(); ++l) {
      const Real sign = is_gap ? Real(-1) : Real(1);
      const Real u = sign * apartAtStart(run, l, c.rests, Real(1), state);
      const Real before = sign * apartAtStart(run, l, c.rests, Real(0), state);
      state.work()[r].initial += kernels::storedAtStart(law, numbers, l, u, u - before);
    }
  }

 private:
  void stepSpans(std::size_t r, const RunCoefficients<Real>& c, State<Real>& state) const noexcept {
    const LinkRun& run = layout_.runs[r];
    const LinkMemory<Real> memory = state.memory(r);
    const std::size_t links = run.ends.size();
    const Real* fields = c.fields.data();
    const kernels::SpatialArguments<Real> arguments{
        run.spans.data(), run.spans.size(), run.ends.data(), static_cast<std::ptrdiff_t>(links),
        run.stride_a,     fields,           fields + links,  fields + 2 * links,
        c.rests.data(),   state.x(),        state.d(),       state.moved(),
        state.f(),        memory.elastic,   memory.viscous};
    const auto& step =
        run.law == scene::LiaType::kContact ? spatial_kernels_.contacts : spatial_kernels_.springs;
    const kernels::SpatialWork twice = step[run.dimensions - 1](arguments);
    if (metered_) {
      state.work()[r].stored += 0.5 * twice.elastic;
      state.work()[r].dissipated += 0.5 * twice.viscous;
    }
  }

  /// \param steps  1: where the first step brings the ends, 0: before
  Real apartAtStart(const LinkRun& run,
                    std::size_t l,
                    const std::vector<Real>& rests,
                    Real steps,
                    State<Real>& state) const {
    const auto position = [&](int slot) { return state.x()[slot] + steps * state.d()[slot]; };
    if (run.dimensions == 0) {
      return position(run.ends[l].a) - position(run.ends[l].b);
    }
    Real sum(0);
    for (int k = 0; k < run.dimensions; ++k) {
      const Real u = position(run.ends[l].a + k * run.stride_a) -
                     position(run.ends[l].b + k * run.stride_b) +
                     rests[static_cast<std::size_t>(k) * run.ends.size() + l];
      sum += u * u;
    }
    return std::sqrt(sum);
  }

  double moveCells(int first,
                   int last,
                   const MassCoefficients<Real>& c,
                   State<Real>& state) const noexcept {
    kernels::CellArguments<Real> cells{};
    cells.count = last - first;
    cells.x = state.x() + first;
    cells.d = state.d() + first;
    cells.d_last = state.dLast() + first;
    cells.f = state.f() + first;
    cells.lose = c.lose.data() + first;
    cells.pull = c.pull.data() + first;
    cells.inverse_mass = c.inverse_mass.data() + first;
    cells.drift = c.drift.data() + first;
    cells.loss = metered_ ? c.loss.data() + first : nullptr;
    return 0.5 * cells_.step(cells);
  }

  void moveFree(int first,
                int last,
                const MassCoefficients<Real>& c,
                State<Real>& state) const noexcept {
    Real* x = state.x();
    Real* d = state.d();
    Real* d_last = state.dLast();
    const Real* f = state.f();
    const Real* inverse = c.inverse_mass.data();
    const Real* drift = c.drift.data();
#pragma GCC ivdep  // the arrays do not overlap
    for (int s = first; s < last; ++s) {
      const Real before = d[s];
      const Real now = before + (inverse[s] * f[s] + drift[s]);
      d_last[s] = before;
      d[s] = now;
      x[s] += now;
    }
  }

  static scene::Tables<Real> tablesOf(const TableCoefficients<Real>& c) noexcept {
    return {c.x.data(), c.cubic.data(), c.first.data(), c.count.data()};
  }

  static scene::RunNumbers<Real> numbersOf(const LinkRun& run,
                                           const RunCoefficients<Real>& c,
                                           Real* law_state) noexcept {
    return {c.fields.data(), run.ends.size(), tablesOf(c.table), tablesOf(c.viscous_table),
            law_state};
  }

  std::size_t blocks() const noexcept {
    return blocks_end_.empty() ? 0 : blocks_end_.back();
  }
  std::size_t firstBlock(int section) const noexcept {
    return section == 0 ? 0 : blocks_end_[static_cast<std::size_t>(section) - 1];
  }

  const Layout& layout_;
  Sweeper<Real> sweeper_;
  const kernels::ModalKernels<Real>& cells_;
  const kernels::SpatialKernels<Real>& spatial_kernels_;
  bool metered_;
  std::vector<std::size_t> blocks_end_;  // [sections] one past its last block
};

template <class Real>
std::vector<std::string> Stepper<Real>::describe(const scene::Scene& scene) const {
  std::vector<std::string> lines;
  for (int s = 0; s < static_cast<int>(layout_.sections.size()); ++s) {
    const auto index = static_cast<std::size_t>(s);
    const std::string section = "section '" + scene.sections[index].name + "': ";
    for (std::size_t b = firstBlock(s); b < blocks_end_[index];) {
      const std::string text = describeBlock(layout_.blocks[b]);
      const std::size_t first = b;
      while (b < blocks_end_[index] && describeBlock(layout_.blocks[b]) == text) {
        ++b;
      }
      const std::string times = b - first > 1 ? std::to_string(b - first) + " times " : "";
      lines.push_back(section + times + text);
    }
    std::size_t links = 0;
    for (const LinkRun& run : layout_.runs) {
      links += run.section == s && run.block < 0 ? run.ends.size() : 0;
    }
    const SectionRange& range = layout_.sections[index];
    if (range.end > range.cells || links > 0) {
      lines.push_back(section + std::to_string(range.end - range.cells) + " modules and " +
                      std::to_string(links) + " links one by one");
    }
  }
  return lines;
}

}  // namespace ergotic::physics
