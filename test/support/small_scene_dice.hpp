// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "support/small_scene.hpp"

namespace ergotic::test {

inline std::string number(double value) {
  std::ostringstream text;
  text.precision(10);
  text << value;
  return text.str();
}

/// Dice, and the elements of a small scene that are thrown with them.
class SmallSceneDice {
 protected:
  static constexpr double kRate = 44100.0;

  explicit SmallSceneDice(unsigned seed) : random_(seed) {}

  struct Mass {
    std::string name;
    double kg;
    double rate;
  };

  double within(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double decades(double low, double high) {
    return std::pow(10.0, within(std::log10(low), std::log10(high)));
  }
  bool chance(double share) { return within(0.0, 1.0) < share; }
  int any(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  template <class Item>
  Item pick(std::initializer_list<Item> all) {
    return *(all.begin() + any(0, static_cast<int>(all.size()) - 1));
  }
  const Mass& anyMass() { return masses_[static_cast<std::size_t>(any(0, last()))]; }
  int last() const { return static_cast<int>(masses_.size()) - 1; }

  void begin(const char* family, int ratio = 14) {
    made_.family = family;
    made_.rates = {kRate, ratio};
  }
  void section(const std::string& name, double rate, const std::string& more = "") {
    made_.sections.push_back(name + ": {rate: " + (rate == kRate ? "audio" : "gestural") + more +
                             "}");
    made_.mats.push_back("g_" + name + ": {type: ground, section: " + name + "}");
    rate_ = rate;
    section_ = name;
  }
  /// \param keys  beside mass and section
  void mass(double kg, const std::string& keys) {
    masses_.push_back({"m" + std::to_string(masses_.size()), kg, rate_});
    made_.mats.push_back(masses_.back().name + ": {type: mass, section: " + section_ +
                         ", mass: " + number(kg) + keys + "}");
  }
  void scalarMasses(int count) {
    for (int i = 0; i < count; ++i) {
      mass(decades(0.3, 3.0),
           ", x: " + number(within(-1e-3, 1e-3)) + ", v: " + number(within(-3.0, 3.0)));
    }
  }
  std::string groundOf(const Mass& m) {
    return made_.mats[0].find("section: fast") != std::string::npos && m.rate != kRate ? "g_slow"
           : made_.sections.size() > 1 && m.rate == kRate                              ? "g_fast"
                                                          : "g_" + section_;
  }
  void link(const std::string& type,
            const std::string& a,
            const std::string& b,
            const std::string& keys) {
    made_.lias.push_back("l" + std::to_string(made_.lias.size()) + ": {type: " + type +
                         ", between: [" + a + ", " + b + "]" + keys + "}");
  }
  /// The other end of a link from a mass: the ground, or another one.
  std::string otherThan(const Mass& m, double to_ground) {
    const Mass& other = anyMass();
    return chance(to_ground) || other.name == m.name ? groundOf(m) : other.name;
  }
  std::string full(const Mass& m, double kappa) { return number(kappa * m.kg * m.rate * m.rate); }
  std::string damping(const Mass& m, double most) {
    return is_lossless_ || chance(0.5)
               ? ""
               : ", damping: " + number(decades(1e-6, most) * m.kg * m.rate);
  }
  std::string scheme(std::initializer_list<const char*> all) {
    return std::string(", scheme: ") + pick(all);
  }

  void springTo(const Mass& m, const std::string& other, double kappa, double damped) {
    link("spring_damper", m.name, other,
         ", stiffness: " + full(m, kappa) + ", damping: " + number(damped * m.kg * m.rate));
  }
  double anyLoss() { return is_lossless_ || chance(0.5) ? 0.0 : decades(1e-7, 1e-1); }
  void springs(int count, double kappa) {
    for (int i = 0; i < count; ++i) {
      const Mass& m = anyMass();
      springTo(m, otherThan(m, 0.4), within(0.0, 1.0) * kappa, anyLoss());
    }
  }

  /// A table of up to `reach` either way, of about that slope.
  std::string table(double reach, double slope) {
    std::vector<double> x(static_cast<std::size_t>(any(2, 6)));
    for (double& each : x) {
      each = within(-reach, reach);
    }
    std::sort(x.begin(), x.end());
    const bool rises = chance(0.5);
    std::string points = "[";
    double last = x.front() * slope;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double y = rises ? last : within(-1.0, 1.0) * reach * slope;
      points += (i == 0 ? "[" : ", [") + number(x[i] + 1e-9 * static_cast<double>(i)) + ", " +
                number(y) + "]";
      last += i + 1 < x.size() ? within(0.0, 1.0) * slope * (x[i + 1] - x[i]) : 0.0;
    }
    return "{points: " + points + "]" + (chance(0.5) ? ", interpolation: monotone" : "") + "}";
  }

  /// Cubic links with one tank.
  void hardenTogether(int count) {
    for (int i = 0; i < count; ++i) {
      const Mass& m = anyMass();
      link("cubic", m.name, otherThan(m, 0.5),
           ", stiffness: 0, nonlinearity: " + full(m, decades(1e3, 1e7)) + ", tank: net");
    }
  }
  /// \pre all links so far are springs
  void stretchAll() {
    std::string of;
    for (const std::string& lia : made_.lias) {
      of += (of.empty() ? "" : ", ") + nameOf(lia);
    }
    made_.lias.push_back("l" + std::to_string(made_.lias.size()) + ": {type: stretch, of: [" + of +
                         "], spacing: 0.001, hardening: " + number(decades(1e-3, 1e3)) + "}");
  }

  /// A mass that swings in two, three, four or six steps a period, or nearly so: it meets whatever
  /// the step does wrong at the same phase again and again.
  void inTimeWithTheSteps() {
    const double kappa = pick({1.0, 2.0, 2.0, 3.0, 3.0, 3.0, 3.9});
    if (chance(0.4)) {
      springTo(anyMass(), "g_all", kappa - pick({1.0, -1.0}) * decades(1e-6, 1e-1),
               is_lossless_ ? 0.0 : anyLoss());
    }
  }

  static std::string nameOf(const std::string& lia) { return lia.substr(0, lia.find(':')); }

  /// Friction that sticks. \param normal  N, or the contact that presses it
  void rub(const std::string& a, const std::string& b, const std::string& normal) {
    std::string keys = ", normal: " + normal;
    if (chance(0.3)) {
      const double width = decades(1e-2, 3.0);
      keys += ", table: [[0, " + number(within(0.6, 1.5)) + "], [" + number(width) + ", 0.5], [" +
              number(10.0 * width) + ", " + number(within(0.0, 2.0)) + "]]";
    } else {
      keys += ", steady: " + number(within(0.0, 0.5)) + ", parts: [[" + number(within(0.1, 1.0)) +
              ", " + number(decades(1e-3, 3.0)) + "]]";
    }
    link("friction", a, b, keys + scheme({"energy_stable", "auto"}));
  }

  /// Across a contact, which presses it.
  void rubAcross(const std::string& contact) {
    const std::size_t ends = contact.find('[') + 1;
    const std::size_t comma = contact.find(", ", ends);
    rub(contact.substr(ends, comma - ends),
        contact.substr(comma + 2, contact.find(']') - comma - 2), nameOf(contact));
  }

  std::mt19937 random_;
  SmallScene made_;
  std::vector<Mass> masses_;
  std::string section_;
  bool is_lossless_ = false;
  double rate_ = kRate;
};

}  // namespace ergotic::test
