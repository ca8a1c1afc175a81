// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "at.hpp"
#include "physics/engine/energy_stable.hpp"

namespace ergotic::physics {
namespace {

template <class Real>
Real dot(const Real (&a)[3], const Real (&b)[3]) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Takes off what is along a unit vector, or nothing if that is 0.
template <class Real>
void removeAlong(const Real (&line)[3], Real (&from)[3]) noexcept {
  const Real along = dot(line, from);
  for (int k = 0; k < 3; ++k) {
    from[k] -= along * line[k];
  }
}

}  // namespace

/// Computes the slip of the step to come, with the forces of all other links and of the frictions
/// that stick before this one, which are in the loads of its modules.
template <class Real>
Slide<Real> EnergyStableLinks<Real>::slideOf(const EnergyStableView<Real>& view,
                                             const Pressure<Real>& pressed,
                                             const Link& link,
                                             Motion& m,
                                             EnergyStableState<Real>& state) const noexcept {
  const Course course = courseOf(view, link);
  Real next[3];
  Real now[3];
  Real moved = Real(0);
  for (int k = 0; k < 3; ++k) {
    next[k] = course.next[k];
    now[k] = course.now[k];
    moved -= state.gradient[k] * course.fixed_now[k];
  }
  payArrears(moved, state);
  for (std::size_t t = link.first; t < link.first + link.count; ++t) {
    const Term& term = terms_[t];
    for (int k = 0; k < link.dimensions && isFree(view, term); ++k) {
      const Real pushed = term.weight[k] * view.inverse_mass[term.module] *
                          modules_[at(term.module)].load[term.component];
      next[k] += pushed;
      now[k] += pushed;
    }
  }
  removeAlong(pressed.line, next);
  Slide<Real> slide;
  slide.free = std::sqrt(dot(next, next));
  for (int k = 0; k < 3; ++k) {
    m.gradient[k] = slide.free > Real(0) ? next[k] / slide.free : Real(0);
    m.foreseen -= m.gradient[k] * course.fixed_next[k];
  }
  yieldOf(view, link, m);
  slide.before = dot(m.gradient, now);
  slide.give = m.own_give;
  slide.normal = pressed.force;
  slide.goes_on = dot(m.gradient, state.gradient) > Real(0);
  return slide;
}

/// Visits the modules of a link, with the part that each has in how it gives way.
template <class Real>
template <class Visit>
void EnergyStableLinks<Real>::visitShares(const EnergyStableView<Real>& view,
                                          const Link& link,
                                          const Motion& m,
                                          const Visit& visit) noexcept {
  const std::size_t end = link.first + link.count;
  for (std::size_t t = link.first; t < end;) {
    const Term& first = terms_[t];
    Real square = Real(0);
    for (; t < end && terms_[t].module == first.module; ++t) {
      const Real lever = leverOf(terms_[t], m);
      square += lever * lever;
    }
    if (isFree(view, first) && square > Real(0)) {
      visit(modules_[at(first.module)], square * view.inverse_mass[first.module] / m.own_give);
    }
  }
}

/// Exerts the force of one friction that sticks. Energy that it gives comes from its tank, then
/// from what earlier frictions have taken from the same modules in this step.
template <class Real>
void EnergyStableLinks<Real>::rub(const EnergyStableView<Real>& view,
                                  const EnergyStableLaw<Real>& law,
                                  const Pressure<Real>& pressed,
                                  const Link& link,
                                  Motion& m,
                                  EnergyStableState<Real>& state) noexcept {
  m = Motion{};
  const Slide<Real> slide = slideOf(view, pressed, link, m, state);
  Real credit = Real(0);
  visitShares(view, link, m, [&credit](const Module& module, Real share) {
    credit += share * (module.heat - module.spent);
  });
  m.damper = exertDry(slide, state.tank + credit, law, state);
  m.heat = workOf(slide, m.damper);
  const Real paid = std::clamp(-m.heat, Real(0), state.tank);
  const Real missing = std::max(Real(0), -m.heat - paid);
  const Real part = credit > Real(0) ? std::min(Real(1), missing / credit) : Real(0);
  state.tank -= paid;
  m.heat = std::max(Real(0), m.heat);
  visitShares(view, link, m, [&](Module& module, Real share) {
    module.spent += part * share * (module.heat - module.spent);
  });
  visitShares(view, link, m, [&](Module& module, Real share) { module.heat += share * m.heat; });
  load(link, m);
  state.foreseen = m.foreseen;
  std::copy_n(m.gradient, 3, state.gradient);
}

/// Its tank keeps the rest of the energy that it took; if the friction sticks, the rest is lost.
template <class Real>
void EnergyStableLinks<Real>::closeRub(const EnergyStableView<Real>& view,
                                       const Link& link,
                                       const Motion& m,
                                       EnergyStableState<Real>& state) noexcept {
  Real left = m.heat;
  visitShares(view, link, m, [&](const Module& module, Real share) {
    left -= module.heat > Real(0) ? share * m.heat * module.spent / module.heat : Real(0);
  });
  state.tank += std::max(Real(0), left);
  if (state.phase == Real(0)) {
    state.lost += static_cast<double>(state.tank);
    state.tank = Real(0);
  }
}

template Slide<float> EnergyStableLinks<float>::slideOf(const EnergyStableView<float>&,
                                                        const Pressure<float>&,
                                                        const Link&,
                                                        Motion&,
                                                        EnergyStableState<float>&) const noexcept;
template Slide<double> EnergyStableLinks<double>::slideOf(
    const EnergyStableView<double>&,
    const Pressure<double>&,
    const Link&,
    Motion&,
    EnergyStableState<double>&) const noexcept;
template void EnergyStableLinks<float>::rub(const EnergyStableView<float>&,
                                            const EnergyStableLaw<float>&,
                                            const Pressure<float>&,
                                            const Link&,
                                            Motion&,
                                            EnergyStableState<float>&) noexcept;
template void EnergyStableLinks<double>::rub(const EnergyStableView<double>&,
                                             const EnergyStableLaw<double>&,
                                             const Pressure<double>&,
                                             const Link&,
                                             Motion&,
                                             EnergyStableState<double>&) noexcept;
template void EnergyStableLinks<float>::closeRub(const EnergyStableView<float>&,
                                                 const Link&,
                                                 const Motion&,
                                                 EnergyStableState<float>&) noexcept;
template void EnergyStableLinks<double>::closeRub(const EnergyStableView<double>&,
                                                  const Link&,
                                                  const Motion&,
                                                  EnergyStableState<double>&) noexcept;

}  // namespace ergotic::physics
