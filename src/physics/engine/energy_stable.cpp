// SPDX-License-Identifier: BSD-3-Clause
#include "physics/engine/energy_stable.hpp"

#include <algorithm>
#include <cmath>

#include "at.hpp"
#include "physics/engine/near_links.hpp"

namespace ergotic::physics {
namespace {

/// Sets the direction of a link along u. Without a length it has none, and no force.
/// \return the length, with the sign `sense`
template <class Real>
Real direct(const Real (&u)[3], Real sense, EnergyStableMotion<Real>& m) noexcept {
  const Real length = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
  for (int k = 0; k < 3; ++k) {
    m.gradient[k] = length > Real(0) ? sense * u[k] / length : Real(0);
  }
  return sense * length;
}

}  // namespace

template <class Real>
EnergyStableLinks<Real>::EnergyStableLinks(const std::vector<EnergyStableLink>& links,
                                           std::vector<EnergyStableModule<Real>>& modules)
    : motions_(links.size()), clusters_(links.size()), modules_(modules) {
  for (const EnergyStableLink& link : links) {
    const bool euclidean = link.dimensions > 0;
    if (link.sticks) {
      sticking_.push_back(links_.size());
    }
    links_.push_back({euclidean,
                      link.sticks,
                      std::max(1, link.dimensions),
                      static_cast<Real>(link.share),
                      terms_.size(),
                      0,
                      {}});
    terms_.resize(terms_.size() + link.terms.size());
    setTerms(links_.size() - 1, link.terms.data(), link.terms.size(), link.offset);
  }
}

/// Terms of one module lie side by side; a coordinate that both ends reach becomes one term.
template <class Real>
ERGOTIC_REALTIME void EnergyStableLinks<Real>::setTerms(std::size_t link,
                                                        const EnergyStableTerm* terms,
                                                        std::size_t count,
                                                        const double (&offset)[3]) noexcept {
  Link& to = links_[link];
  Term* const first = terms_.data() + to.first;
  Term* last = first;
  for (const EnergyStableTerm* t = terms; t != terms + count; ++t) {
    Term* same = std::find_if(first, last, [t](const Term& k) { return k.slot == t->slot; });
    if (same == last) {
      Term* after = first;
      while (after != last && after->module != t->module) {
        ++after;
      }
      const bool opens = after == last;
      after += opens ? 0 : 1;
      std::move_backward(after, last, last + 1);
      *after = {t->slot, t->module, t->component, t->slow_section, t->is_tap, opens, {}};
      same = after;
      ++last;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      same->weight[k] += static_cast<Real>(t->weight[k]);
    }
  }
  to.count = static_cast<std::size_t>(last - first);
  std::transform(offset, offset + 3, to.offset, [](double o) { return static_cast<Real>(o); });
}

template <class Real>
bool isIdle(const EnergyStableView<Real>& view, std::size_t link) noexcept {
  return view.idle != nullptr && view.idle[link] != 0;
}

template <class Real>
bool EnergyStableLinks<Real>::isFree(const EnergyStableView<Real>& view,
                                     const Term& term) const noexcept {
  return term.slow_section < 0 && view.inverse_mass[term.module] > Real(0);
}

/// Elongation or compression and its direction.
template <class Real>
void EnergyStableLinks<Real>::place(const EnergyStableView<Real>& view,
                                    const EnergyStableLaw<Real>& law,
                                    const Link& link,
                                    Motion& m) const noexcept {
  Real u[3] = {link.offset[0], link.offset[1], link.offset[2]};
  for (std::size_t t = link.first; t < link.first + link.count; ++t) {
    const Term& term = terms_[t];
    for (int k = 0; k < link.dimensions; ++k) {
      u[k] += term.weight[k] * view.x[term.slot];
    }
  }
  const Real length = law.isContact() ? -law.length : law.length;
  if (!link.euclidean) {
    m.p = u[0] - length;
    m.gradient[0] = Real(1);
    return;
  }
  const Real sense = law.isContact() ? Real(-1) : Real(1);
  m.p = direct(u, sense, m) - length;
}

/// The step of a module to come.
template <class Real>
Real stepOf(const EnergyStableView<Real>& v, int i, Real now) noexcept {
  return now - (v.lose[i] * now + v.pull[i] * v.x[i]) + (v.inverse_mass[i] * v.f[i] + v.drift[i]);
}

/// How far a module of a slower section goes in this step of the link: in the step that this began
/// with, all of its way. Friction that sticks takes it to go evenly, or it would stick to leaps.
template <class Real, class Link>
Real heldStepOf(const EnergyStableView<Real>& v, const Link& link, int section, Real d) noexcept {
  return link.sticks ? link.share * d : v.due[section] == 0 ? Real(0) : d;
}

/// How far the module of a term moves.
template <class Real>
struct Moves {
  Real now;   // in the step just made
  Real next;  // in the step to come, if nothing energy-stable pushes
};

template <class Real, class Link, class Term>
Moves<Real> movesOf(const EnergyStableView<Real>& v, const Link& link, const Term& term) noexcept {
  const int i = term.slot;
  if (term.slow_section >= 0) {
    // A held module stays until its section is stepped again.
    const Real now = heldStepOf(v, link, term.slow_section, v.d[i]);
    return {now, link.sticks ? now : Real(0)};
  }
  return {v.d[i], term.is_tap ? v.ahead[i] : stepOf(v, i, v.d[i])};
}

template <class Real>
typename EnergyStableLinks<Real>::Course EnergyStableLinks<Real>::courseOf(
    const EnergyStableView<Real>& v, const Link& link) const noexcept {
  Course c;
  for (std::size_t t = link.first; t < link.first + link.count; ++t) {
    const Term& term = terms_[t];
    const Moves<Real> moves = movesOf(v, link, term);
    const Real fixed = isFree(v, term) ? Real(0) : Real(1);
    for (int k = 0; k < link.dimensions; ++k) {
      c.now[k] += term.weight[k] * moves.now;
      c.next[k] += term.weight[k] * moves.next;
      c.fixed_now[k] += fixed * term.weight[k] * moves.now;
      c.fixed_next[k] += fixed * term.weight[k] * moves.next;
    }
  }
  return c;
}

/// A contact that closes within this step begins to push in it.
template <class Real>
bool pushes(const EnergyStableMotion<Real>& m,
            const EnergyStableLaw<Real>& law,
            EnergyStableState<Real>& state) noexcept {
  if (law.isContact()) {
    return m.p - std::min(Real(0), m.coasting / Real(2)) > Real(0);
  }
  return law.form->phase == nullptr || holdsAt(m.p, law, state);
}

template <class Real>
Real EnergyStableLinks<Real>::measureSpatial(const EnergyStableView<Real>& view,
                                             const EnergyStableLaw<Real>& law,
                                             const Link& link,
                                             EnergyStableState<Real>& state,
                                             Motion& m) const noexcept {
  const Course c = courseOf(view, link);
  if (m.is_friction) {  // it is along the slip
    const Real u[3] = {c.now[0] + c.next[0], c.now[1] + c.next[1], c.now[2] + c.next[2]};
    direct(u, Real(1), m);
  } else {
    place(view, law, link, m);
  }
  Real now = Real(0);
  Real moved = Real(0);
  for (int k = 0; k < link.dimensions; ++k) {
    now += m.gradient[k] * c.now[k];
    m.opening -= m.gradient[k] * c.next[k];
    m.foreseen -= m.gradient[k] * c.fixed_next[k];
    moved -= state.gradient[k] * c.fixed_now[k];
  }
  payArrears(moved, state);
  return now;
}

/// The same in one pass: most links are scalar.
template <class Real>
Real EnergyStableLinks<Real>::measureScalar(const EnergyStableView<Real>& view,
                                            const EnergyStableLaw<Real>& law,
                                            const Link& link,
                                            EnergyStableState<Real>& state,
                                            Motion& m) const noexcept {
  Real u = link.offset[0];
  Real now = Real(0);
  Real next = Real(0);
  Real fixed_now = Real(0);
  Real fixed_next = Real(0);
  for (std::size_t t = link.first; t < link.first + link.count; ++t) {
    const Term& term = terms_[t];
    const Moves<Real> moves = movesOf(view, link, term);
    const Real weight = term.weight[0];
    u += weight * view.x[term.slot];
    now += weight * moves.now;
    next += weight * moves.next;
    if (!isFree(view, term)) {
      fixed_now += weight * moves.now;
      fixed_next += weight * moves.next;
    }
  }
  m.p = u - (law.isContact() ? -law.length : law.length);
  m.gradient[0] = Real(1);
  m.opening = -next;
  m.foreseen = -fixed_next;
  payArrears(-state.gradient[0] * fixed_now, state);
  return now;
}

/// Measures the position of the link, its opening without its own force, and whether it is active.
template <class Real>
void EnergyStableLinks<Real>::measure(const EnergyStableView<Real>& view,
                                      const EnergyStableLaw<Real>& law,
                                      const Link& link,
                                      EnergyStableState<Real>& state,
                                      Motion& m) const noexcept {
  m.is_friction = law.isFriction();
  const Real now = link.euclidean ? measureSpatial(view, law, link, state, m)
                                  : measureScalar(view, law, link, state, m);
  m.opening -= now;
  m.coasting = Real(-2) * now;
  m.is_pushing = !m.is_friction && pushes(m, law, state);
  m.is_active = m.is_friction || m.is_pushing || (law.isContact() && state.tank > Real(0));
}

/// Force on a coordinate per force of the link.
template <class Real>
Real EnergyStableLinks<Real>::leverOf(const Term& term, const Motion& m) noexcept {
  return -(term.weight[0] * m.gradient[0] + term.weight[1] * m.gradient[1] +
           term.weight[2] * m.gradient[2]);
}

/// Counts it, with its force of the last step, on each module.
template <class Real>
void EnergyStableLinks<Real>::countActive(const EnergyStableView<Real>& view,
                                          const Link& link,
                                          const Motion& m,
                                          Real last) noexcept {
  for (std::size_t t = link.first; t < link.first + link.count; ++t) {
    const Term& term = terms_[t];
    if (m.is_active && isFree(view, term)) {
      Module& module = modules_[at(term.module)];
      module.links += term.opens_module ? Real(1) : Real(0);
      module.last[term.component] += leverOf(term, m) * last;
    }
  }
}

/// How far a force opens the link, alone and if all links of its modules act as it does.
template <class Real>
void EnergyStableLinks<Real>::yieldOf(const EnergyStableView<Real>& view,
                                      const Link& link,
                                      Motion& m) const noexcept {
  for (std::size_t t = link.first; t < link.first + link.count; ++t) {
    const Term& term = terms_[t];
    if (isFree(view, term)) {
      const Real lever = leverOf(term, m);
      const Real own = lever * lever * view.inverse_mass[term.module];
      m.own_give += own;
      m.give += modules_[at(term.module)].links * own;
    }
  }
}

template <class Real>
void EnergyStableLinks<Real>::load(const Link& link, const Motion& m) noexcept {
  for (std::size_t t = link.first; t < link.first + link.count; ++t) {
    const Term& term = terms_[t];
    modules_[at(term.module)].load[term.component] += leverOf(term, m) * m.total();
  }
}

/// The others on its masses are expected to do what they did in the last step, and as much more as
/// this one does: at rest that is exact, and on an impact each of c links stops its part.
template <class Real>
void EnergyStableLinks<Real>::expectOthers(const EnergyStableView<Real>& view,
                                           const Link& link,
                                           bool is_contact,
                                           Real last,
                                           Motion& m) const noexcept {
  for (std::size_t t = link.first; t < link.first + link.count; ++t) {
    const Term& term = terms_[t];
    const Module& module = modules_[at(term.module)];
    if (module.links > Real(1) && isFree(view, term)) {
      const Real lever = leverOf(term, m);
      const Real others = module.last[term.component] - module.links * lever * last;
      m.expected += is_contact ? lever * view.inverse_mass[term.module] * others : Real(0);
      m.is_shared = true;
    }
  }
  m.opening += m.expected;
}

/// Now that all forces are known it pays for what they really do, not for what was expected.
template <class Real>
void EnergyStableLinks<Real>::correctCharge(const EnergyStableView<Real>& view,
                                            const Link& link,
                                            Motion& m,
                                            EnergyStableState<Real>& state) const noexcept {
  Real real = Real(0);
  for (std::size_t t = link.first; t < link.first + link.count; ++t) {
    const Term& term = terms_[t];
    const Module& module = modules_[at(term.module)];
    if (module.links > Real(1) && isFree(view, term)) {
      const Real lever = leverOf(term, m);
      const Real others = module.load[term.component] - module.links * lever * m.total();
      real += lever * view.inverse_mass[term.module] * others;
    }
  }
  takeBack(m.expected - real, m, state);
}

/// Exerts the forces of all links except frictions that stick.
template <class Real>
void EnergyStableLinks<Real>::exertOthers(const NearLinks<Real>& near,
                                          const EnergyStableView<Real>& view,
                                          const EnergyStableLaw<Real>* laws,
                                          EnergyStableState<Real>* states) noexcept {
  const auto forEachOther = [&](const auto& visit) {
    for (const std::size_t l : near) {
      if (!links_[l].sticks) {
        visit(l);
      }
    }
  };
  const auto lastOf = [states](std::size_t l) { return states[l].force + states[l].damper; };
  forEachOther([&](std::size_t l) {
    motions_[l] = Motion{};
    if (!isIdle(view, l)) {
      measure(view, laws[l], links_[l], states[l], motions_[l]);
    }
    countActive(view, links_[l], motions_[l], lastOf(l));
  });
  forEachOther([&](std::size_t l) {
    if (motions_[l].is_active) {
      yieldOf(view, links_[l], motions_[l]);
      expectOthers(view, links_[l], laws[l].isContact(), lastOf(l), motions_[l]);
      exertForce(motions_[l], laws[l], states[l]);
      load(links_[l], motions_[l]);
    }
    payWork(motions_[l], states[l]);
  });
  bool is_any_in_debt = false;
  forEachOther([&](std::size_t l) {
    if (motions_[l].is_shared) {
      correctCharge(view, links_[l], motions_[l], states[l]);
      is_any_in_debt = is_any_in_debt || states[l].tank + motions_[l].heat < Real(0);
    }
  });
  if (is_any_in_debt) {
    settleDebts(near, view, states);
  }
  forEachOther([&](std::size_t l) { closeStep(motions_[l], states[l]); });
}

template <class Real>
ERGOTIC_REALTIME void EnergyStableLinks<Real>::step(const NearLinks<Real>& near,
                                                    const EnergyStableView<Real>& view,
                                                    const EnergyStableLaw<Real>* laws,
                                                    EnergyStableState<Real>* states) noexcept {
  exertOthers(near, view, laws, states);
  for (const std::size_t l : sticking_) {
    if (!isIdle(view, l)) {
      rub(view, laws[l], view.pressed[l], links_[l], motions_[l], states[l]);
    }
  }
  for (const std::size_t l : sticking_) {
    if (!isIdle(view, l)) {
      closeRub(view, links_[l], motions_[l], states[l]);
    }
  }
  for (const std::size_t l : near) {
    const Link& link = links_[l];
    for (std::size_t t = link.first; t < link.first + link.count; ++t) {
      modules_[at(terms_[t].module)] = Module{};
    }
  }
}

template <class Real>
Real EnergyStableLinks<Real>::gapOf(std::size_t link,
                                    const EnergyStableState<Real>& state) const noexcept {
  const bool acts = motions_[link].is_active || state.tank > Real(0) || state.force != Real(0) ||
                    state.damper != Real(0);
  return acts ? Real(0) : -motions_[link].p;
}

template <class Real>
void EnergyStableLinks<Real>::start(const EnergyStableView<Real>& view,
                                    const EnergyStableLaw<Real>* laws,
                                    EnergyStableState<Real>* states) const noexcept {
  for (std::size_t l = 0; l < links_.size(); ++l) {
    states[l].tank = stored(view, laws[l], l);
  }
}

template <class Real>
ERGOTIC_REALTIME Real EnergyStableLinks<Real>::stored(const EnergyStableView<Real>& view,
                                                      const EnergyStableLaw<Real>& law,
                                                      std::size_t link) const noexcept {
  Motion m;
  place(view, law, links_[link], m);
  const bool is_open = law.isContact() && !(m.p > Real(0));
  return is_open ? Real(0) : std::max(Real(0), law.potential(m.p));
}

template <class Real>
ERGOTIC_REALTIME void EnergyStableLinks<Real>::retune(
    const EnergyStableView<Real>& view,
    const EnergyStableLaw<Real>* from,
    const EnergyStableLaw<Real>* to,
    EnergyStableState<Real>* states) const noexcept {
  for (std::size_t l = 0; l < links_.size(); ++l) {
    const Real change = stored(view, to[l], l) - stored(view, from[l], l);
    states[l].tank = std::max(Real(0), states[l].tank + change);
  }
}

template class EnergyStableLinks<float>;
template class EnergyStableLinks<double>;

}  // namespace ergotic::physics
