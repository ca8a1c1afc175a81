// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "physics/engine/guarded.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics::test {

/// The guarded form of a law, all numbers 0. A kTable is elastic once it has a table.
template <class Real = double>
GuardedLaw<Real> guardedLaw(scene::LiaType type) {
  GuardedLaw<Real> law;
  law.form = &scene::lawOf(type).guarded({}).template get<Real>();
  return law;
}

/// Masses, linear springs between them and guarded links, in up to three coordinates, stepped as an
/// instrument does: forces of step n, then the move to n + 1. One step is one unit of time.
template <class Real>
class GuardedNetwork {
 public:
  using Law = GuardedLaw<Real>;
  explicit GuardedNetwork(int dimensions = 1) : dimensions_(dimensions) {}

  /// \param inverse_mass  h^2/M; 0: it keeps its velocity. \return its index
  int mass(double inverse_mass, double position = 0.0, double velocity = 0.0) {
    for (auto* values : {&inverse_mass_, &drift_, &pull_, &x_, &d_, &f_}) {
      values->resize(values->size() + at(dimensions_), Real(0));
    }
    lose_.resize(x_.size(), Real(0));
    const int m = static_cast<int>(x_.size()) / dimensions_ - 1;
    x(m) = static_cast<Real>(position);
    d(m) = static_cast<Real>(velocity);
    for (int k = 0; k < dimensions_; ++k) {
      inverse_mass_[at(m * dimensions_ + k)] = static_cast<Real>(inverse_mass);
    }
    return m;
  }

  /// Scalar, linear, explicit. b = -1: the ground at 0
  void spring(int a, int b, double stiffness) { springs_.push_back({a, b, stiffness}); }

  /// Ends are weighted modules; the second may be empty: the ground at 0.
  using End = std::vector<std::pair<int, double>>;
  std::size_t guard(const Law& law, const End& a, const End& b = {}) {
    GuardedLink link;
    link.dimensions = dimensions_ > 1 ? dimensions_ : 0;
    for (int k = 0; k < dimensions_; ++k) {
      for (const auto& [m, weight] : a) {
        link.terms.push_back(term(m, k, weight));
      }
      for (const auto& [m, weight] : b) {
        link.terms.push_back(term(m, k, -weight));
      }
    }
    links.push_back(link);
    laws.push_back(law);
    return links.size() - 1;
  }

  void start() {
    states.assign(links.size(), GuardedState<Real>{});
    modules_.resize(x_.size());
    guarded_ = std::make_unique<GuardedLinks<Real>>(links, modules_);
    guarded_->start(view(), laws.data(), states.data());
  }

  void step() {
    for (const Spring& s : springs_) {
      const Real force = static_cast<Real>(s.stiffness) * elongation(s);
      f_[at(s.a)] -= force;
      if (s.b >= 0) {
        f_[at(s.b)] += force;
      }
    }
    guarded_->step(view(), laws.data(), states.data());
    for (std::size_t l = 0; l < links.size(); ++l) {
      for (const GuardedTerm& t : links[l].terms) {
        const Real weight = static_cast<Real>(t.weight[t.component]);
        const Real force = states[l].force + states[l].damper;
        f_[at(t.slot)] -= weight * states[l].gradient[t.component] * force;
      }
    }
    for (std::size_t i = 0; i < x_.size(); ++i) {
      d_[i] =
          d_[i] - (lose_[i] * d_[i] + pull_[i] * x_[i]) + (inverse_mass_[i] * f_[i] + drift_[i]);
      x_[i] += d_[i];
      f_[i] = Real(0);
    }
  }

  /// What the explicit step keeps exactly, and the tanks. Between two steps.
  double energy() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (inverse_mass_[i] > Real(0)) {
        sum += 0.5 * static_cast<double>(d_[i]) * static_cast<double>(d_[i] / inverse_mass_[i]);
      }
    }
    for (const Spring& s : springs_) {
      const Real e = elongation(s);
      const Real before = e - d_[at(s.a)] + (s.b < 0 ? Real(0) : d_[at(s.b)]);
      sum += 0.5 * s.stiffness * static_cast<double>(e * before);
    }
    for (const GuardedState<Real>& state : states) {
      sum += static_cast<double>(state.tank);
    }
    return sum;
  }
  double lost() const {
    double sum = 0.0;
    for (const GuardedState<Real>& state : states) {
      sum += state.lost;
    }
    return sum;
  }
  double clipFraction() const {
    double active = 0.0;
    double clipped = 0.0;
    for (const GuardedState<Real>& state : states) {
      active += state.active;
      clipped += state.clipped;
    }
    return active > 0.0 ? clipped / active : 0.0;
  }
  double momentum(int component) const {
    double sum = 0.0;
    for (std::size_t i = at(component); i < x_.size(); i += at(dimensions_)) {
      sum += static_cast<double>(d_[i] / inverse_mass_[i]);
    }
    return sum;
  }

  Real& x(int m, int component = 0) { return x_[at(m * dimensions_ + component)]; }
  Real& d(int m, int component = 0) { return d_[at(m * dimensions_ + component)]; }
  Real& drift(int m) { return drift_[at(m * dimensions_)]; }
  Real& lose(int m) { return lose_[at(m * dimensions_)]; }
  Real& pull(int m) { return pull_[at(m * dimensions_)]; }
  GuardedLinks<Real>& guarded() { return *guarded_; }
  GuardedView<Real> view() {
    return {x_.data(),     d_.data(),    f_.data(),    inverse_mass_.data(),
            drift_.data(), lose_.data(), pull_.data(), nullptr};
  }

  std::vector<Law> laws;
  std::vector<GuardedState<Real>> states;
  std::vector<GuardedLink> links;

 private:
  struct Spring {
    int a;
    int b;
    double stiffness;
  };
  GuardedTerm term(int m, int component, double weight) const {
    GuardedTerm t{m * dimensions_ + component, m * dimensions_, component, {0, 0, 0}, -1};
    t.weight[component] = weight;
    return t;
  }
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  Real elongation(const Spring& s) const { return x_[at(s.a)] - (s.b < 0 ? Real(0) : x_[at(s.b)]); }

  int dimensions_;
  std::vector<Real> inverse_mass_, drift_, lose_, pull_, x_, d_, f_;
  std::vector<Spring> springs_;
  std::vector<GuardedModule<Real>> modules_;
  std::unique_ptr<GuardedLinks<Real>> guarded_;
};

}  // namespace ergotic::physics::test
