// SPDX-License-Identifier: BSD-3-Clause
#include "support/small_scene.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/small_scene_dice.hpp"

namespace ergotic::test {
namespace {

class Maker : SmallSceneDice {
 public:
  explicit Maker(unsigned seed) : SmallSceneDice(seed) {}

  SmallScene make(unsigned family) {
    static constexpr void (Maker::*kFamilies[])() = {
        &Maker::linear, &Maker::twoRates, &Maker::contacts, &Maker::space,      &Maker::tables,
        &Maker::snaps,  &Maker::box,      &Maker::hammer,   &Maker::stiffening, &Maker::friction,
        &Maker::bends,  &Maker::relaxing, &Maker::tanks};
    is_lossless_ = chance(0.5);
    (this->*kFamilies[family % std::size(kFamilies)])();
    return made_;
  }

 private:
  void linear() {
    begin("linear");
    section("all", kRate);
    scalarMasses(any(1, 4));
    springs(any(2, 7), pick({0.5, 2.0, 4.0}));
    if (chance(0.2)) {
      springTo(anyMass(), "g_all", -decades(1e-3, 1.0), 0.0);
    }
  }

  void twoRates() {
    begin("two rates", pick({2, 3, 4, 8, 14, 44}));
    section("fast", kRate);
    scalarMasses(any(1, 3));
    section("slow", kRate / made_.rates.ratio);
    const int first_slow = last() + 1;
    scalarMasses(any(1, 2));
    for (const Mass& m : masses_) {
      if (chance(0.8)) {
        springTo(m, groundOf(m), decades(1e-3, 2.0), anyLoss());
      }
    }
    const int links = any(1, 3);
    for (int i = 0; i < links; ++i) {
      const Mass& slow = masses_[static_cast<std::size_t>(any(first_slow, last()))];
      const Mass& fast = masses_[static_cast<std::size_t>(any(0, first_slow - 1))];
      springTo(slow, fast.name, decades(1e-3, 3.0), anyLoss());
    }
    if (first_slow > 1) {
      springTo(masses_[0], masses_[1].name, decades(1e-3, 2.0), anyLoss());
    }
  }

  void contact(const Mass& m, double kappa, const std::string& schemes) {
    const std::string other = otherThan(m, 0.6);
    const bool is_left = chance(0.5);
    const double k = kappa * m.kg * m.rate * m.rate;
    const std::string type = pick({"contact", "contact", "power_contact", "felt", "cubic_contact"});
    const double a = type == "contact" ? 1.0 : within(1.0, 3.0);
    std::string keys = ", threshold: " + number(within(-1e-3, 1e-3));
    if (type == "cubic_contact") {
      keys += ", stiffness: " + number(0.1 * k) + ", stiffness_limit: " + number(k) +
              ", nonlinearity: " + number(k * decades(1e4, 1e8));
    } else {
      keys += ", stiffness: " + number(type == "contact" ? k : k / std::pow(1e-3, a - 1.0));
    }
    if (type == "power_contact" || type == "felt") {
      keys += ", exponent: " + number(a);
    }
    keys += type == "felt" ? ", damping: " + number(within(0.0, 2.0)) : damping(m, 1.0);
    link(type, is_left ? m.name : other, is_left ? other : m.name, keys + schemes);
  }

  void contacts() {
    begin("contacts");
    section("all", kRate);
    scalarMasses(any(1, 3));
    for (int i = any(1, chance(0.3) ? 60 : 5); i > 0; --i) {
      contact(anyMass(), decades(1e-3, 1.0), scheme({"explicit", "energy_stable", "auto"}));
    }
    springs(any(0, 3), 1.0);
    inTimeWithTheSteps();
  }

  /// A mass between two walls of many contacts each: it hits them all the time.
  void box() {
    begin("box");
    section("all", kRate);
    mass(1.0, ", v: " + number(within(0.3, 30.0)));
    for (int side : {0, 1}) {
      const int contacts = any(1, chance(0.5) ? 40 : 2);
      const double kappa = decades(1e-3, 1.0) / contacts;
      for (int i = 0; i < contacts; ++i) {
        link("contact", side == 0 ? "m0" : "g_all", side == 0 ? "g_all" : "m0",
             ", threshold: " + number(-decades(1e-5, 1e-3)) + ", stiffness: " +
                 full(masses_[0], kappa) + damping(masses_[0], 0.1) + scheme({"explicit", "auto"}));
      }
    }
    inTimeWithTheSteps();
  }

  void space() {
    begin("space");
    const int axes = any(1, 3);
    section("all", kRate,
            std::string(", geometry: ") + (axes == 1   ? "line"
                                           : axes == 2 ? "plane"
                                                       : "space"));
    const auto triple = [&](double reach) {
      std::string list = "[";
      for (int k = 0; k < axes; ++k) {
        list += (k == 0 ? "" : ", ") + number(within(-reach, reach));
      }
      return list + "]";
    };
    for (int i = any(1, 3); i > 0; --i) {
      mass(decades(0.3, 3.0), ", at: " + triple(0.01) + ", v: " + triple(3.0));
    }
    for (int i = any(1, 5); i > 0; --i) {
      const Mass& m = anyMass();
      const std::string rest = chance(0.5) ? ""
                                           : ", rest_length: " + number(decades(1e-5, 2e-2)) +
                                                 scheme({"explicit", "energy_stable"});
      link("spring_damper", m.name, otherThan(m, 0.4),
           ", stiffness: " + full(m, decades(1e-3, 2.0)) +
               ", damping: " + number(anyLoss() * m.kg * m.rate) + rest);
    }
    if (chance(0.4)) {
      contact(anyMass(), decades(1e-3, 1.0), scheme({"explicit", "energy_stable", "auto"}));
      if (chance(0.5)) {
        rubAcross(std::string(made_.lias.back()));
      }
    }
    inTimeWithTheSteps();
  }

  void tables() {
    begin("tables");
    section("all", kRate);
    scalarMasses(any(1, 2));
    for (int i = any(1, 2); i > 0; --i) {
      const Mass& m = anyMass();
      const int parts = any(1, 3);
      std::string keys;
      if ((parts & 1) != 0) {
        keys += ", elastic: " + table(2e-3, decades(1e-4, 1.0) * m.kg * m.rate * m.rate);
      }
      if ((parts & 2) != 0) {
        keys += ", viscous: " + table(3.0, decades(1e-4, 1.0) * m.kg * m.rate);
      }
      link("table", m.name, otherThan(m, 0.7),
           keys + ((parts & 2) != 0 ? "" : scheme({"explicit", "energy_stable", "auto"})));
    }
    springs(any(0, 3), 0.1);
    inTimeWithTheSteps();
  }

  void snaps() {
    begin("snaps");
    section("all", kRate);
    scalarMasses(any(1, 2));
    for (int i = any(1, 3); i > 0; --i) {
      const Mass& m = anyMass();
      const double width = decades(1e-5, 5e-3);
      if (chance(0.5)) {
        link("pluck", m.name, otherThan(m, 0.7),
             ", stiffness: " + full(m, decades(1e-3, 3.0)) + ", width: " + number(width) +
                 damping(m, 0.1) + scheme({"explicit", "energy_stable", "auto"}));
      } else if (chance(0.5)) {
        link("one_way_pluck", m.name, otherThan(m, 0.7),
             ", stiffness: " + full(m, decades(1e-3, 3.0)) + ", width: " + number(width) +
                 damping(m, 0.1) + scheme({"explicit", "energy_stable", "auto"}));
      } else {
        link("conditional", m.name, otherThan(m, 0.7),
             ", stiffness: " + full(m, decades(1e-3, 3.0)) + ", engage: " + number(width) +
                 ", release: " + number(width * decades(1.0, 10.0)) + damping(m, 0.1) +
                 scheme({"explicit", "energy_stable", "auto"}));
      }
    }
    springs(any(1, 3), 0.1);
    inTimeWithTheSteps();
  }

  /// A short string, and what strikes it from the same or from a slower section.
  void hammer() {
    begin("hammer on a string", pick({4, 14}));
    section("fast", kRate);
    const double kappa = decades(1e-2, 0.9);
    const double loss = anyLoss();
    const int masses = any(4, 12);
    for (int i = 0; i < masses; ++i) {
      mass(1e-2, "");
      springTo(masses_.back(), i == 0 ? "g_fast" : masses_[static_cast<std::size_t>(i - 1)].name,
               kappa, loss);
    }
    springTo(masses_.back(), "g_fast", kappa, loss);
    const Mass struck = anyMass();
    if (chance(0.5)) {
      section("slow", kRate / made_.rates.ratio);
    }
    mass(decades(1e-3, 1.0), ", x: -0.002, v: " + number(within(0.3, 3.0)));
    const Mass thrown = masses_.back();
    const double k = decades(1e-3, 1.0) * struck.kg * kRate * kRate;
    link("contact", thrown.name, struck.name,
         ", stiffness: " + number(k) + damping(struck, 0.1) + ", scheme: auto");
    springTo(thrown, groundOf(thrown), decades(1e-6, 1e-3), anyLoss());
  }

  void stiffening() {
    begin("nonlinear springs");
    section("all", kRate);
    scalarMasses(any(1, 4));
    for (int i = any(1, 4); i > 0; --i) {
      const Mass& m = anyMass();
      const double k = decades(1e-3, 10.0) * m.kg * m.rate * m.rate;
      const std::string type = pick({"cubic", "quadratic", "clipped_cubic"});
      std::string keys = ", stiffness: " + number(0.1 * k);
      keys += ", nonlinearity: " + number(type == "quadratic" ? k * 1e3 : k * 1e6);
      keys += type == "clipped_cubic" ? ", stiffness_limit: " + number(k) : "";
      link(type, m.name, otherThan(m, 0.5),
           keys + damping(m, 0.1) + scheme({"explicit", "energy_stable", "energy_stable", "auto"}));
    }
    springs(any(0, 2), 1.0);
    inTimeWithTheSteps();
  }

  void friction() {
    begin("friction");
    section("all", kRate);
    scalarMasses(any(1, 3));
    for (int i = any(1, 3); i > 0; --i) {
      const Mass& m = anyMass();
      if (chance(0.5)) {
        rub(m.name, otherThan(m, 0.5), number(decades(1e-3, 10.0) * m.kg * m.rate));
        continue;
      }
      link(pick({"bow", "smooth_bow"}), m.name, otherThan(m, 0.5),
           ", damping: " + number(decades(1e-3, 10.0) * m.kg * m.rate) + ", width: " +
               number(decades(1e-2, 3.0)) + scheme({"explicit", "energy_stable", "auto"}));
    }
    if (chance(0.3)) {
      contact(anyMass(), decades(1e-3, 1.0), ", scheme: energy_stable");
      const Mass& m = anyMass();
      rub(m.name, otherThan(m, 0.5), nameOf(made_.lias.back()));
    }
    springs(any(0, 3), 1.0);
    inTimeWithTheSteps();
  }

  void relaxing() {
    begin("relaxing");
    section("all", kRate);
    scalarMasses(any(1, 4));
    for (int i = any(1, 4); i > 0; --i) {
      const Mass& m = anyMass();
      const double kappa = pick({0.1, 1.0, 2.0, 3.0});
      std::string branches;
      for (int r = any(1, 3); r > 0; --r) {
        branches += (branches.empty() ? "[" : ", [") + full(m, within(0.0, 1.0) * kappa) + ", " +
                    number(std::max(1e-6, decades(1e-2, 1e4) / m.rate)) + "]";
      }
      const double slow = chance(0.2) ? 0.0 : within(0.0, 1.0) * kappa;
      link("relaxing", m.name, otherThan(m, 0.5),
           ", stiffness: " + full(m, slow) + damping(m, 0.1) +
               (chance(0.3) ? ", loss_factor: " + number(decades(1e-3, 0.5))
                            : ", branches: [" + branches + "]"));
    }
    if (chance(0.3)) {
      contact(anyMass(), decades(1e-3, 1.0), scheme({"explicit", "energy_stable", "auto"}));
    }
    springs(any(0, 2), 1.0);
    inTimeWithTheSteps();
  }

  void tanks() {
    begin("one tank");
    section("all", kRate);
    scalarMasses(any(1, 5));
    springs(any(1, 5), 1.0);
    if (chance(0.5)) {
      stretchAll();
    } else {
      hardenTogether(any(1, 5));
    }
    if (chance(0.3)) {
      contact(anyMass(), decades(1e-3, 1.0), scheme({"energy_stable", "auto"}));
    }
    if (chance(0.3)) {
      const Mass& m = anyMass();
      rub(m.name, otherThan(m, 0.5), number(decades(1e-3, 10.0) * m.kg * m.rate));
    }
    inTimeWithTheSteps();
  }

  /// A link of some ends.
  void bend(bool is_flat, double kappa) {
    std::vector<std::string> names{"g_all"};
    for (const Mass& m : masses_) {
      names.push_back(m.name);
    }
    std::shuffle(names.begin(), names.end(), random_);
    const int ends = any(3, std::min(5, last() + 2));
    std::string between;
    std::string weights;
    double sum = 0.0;
    double squares = 0.0;
    for (int i = 0; i < ends; ++i) {
      double weight = static_cast<double>(any(1, 2)) * pick({1.0, -1.0});
      if (i == ends - 1) {
        weight = -sum;
      } else if (sum + weight == 0.0) {
        weight *= 2.0;
      }
      sum += weight;
      squares += weight * weight;
      between += (i == 0 ? "[" : ", ") + names[static_cast<std::size_t>(i)];
      weights += (i == 0 ? "[" : ", ") + number(weight);
    }
    const Mass& m = anyMass();
    made_.lias.push_back("b" + std::to_string(made_.lias.size()) +
                         ": {type: bend, between: " + between + "], weights: " + weights +
                         "], stiffness: " + full(m, within(0.0, 1.0) * kappa / squares) +
                         (is_flat ? "" : damping(m, 0.1)) +
                         (is_flat || chance(0.7) ? "" : ", rest_length: 0.0007") + "}");
  }

  void bends() {
    begin("bends");
    const bool is_flat = chance(0.3);
    section("all", kRate, is_flat ? ", geometry: plane" : "");
    const int masses = any(3, 8);
    for (int i = 0; is_flat && i < masses; ++i) {
      mass(decades(0.3, 3.0), ", at: [" + number(0.01 * i) + ", " + number(within(-0.01, 0.01)) +
                                  "], v: [" + number(within(-3.0, 3.0)) + ", " +
                                  number(within(-3.0, 3.0)) + "]");
    }
    scalarMasses(is_flat ? 0 : masses);
    for (int i = any(1, 8); i > 0; --i) {
      bend(is_flat, pick({0.5, 1.0, 2.0, 4.0}));
    }
    for (int i = is_flat ? 0 : any(0, 3); i > 0; --i) {
      springTo(anyMass(), "g_all", decades(1e-3, 1.0), anyLoss());
    }
    inTimeWithTheSteps();
  }
};

void addPart(std::string& text, const char* name, const std::vector<std::string>& rows) {
  text += std::string(name) + ":\n";
  for (const std::string& row : rows) {
    text += "  " + row + "\n";
  }
}

}  // namespace

std::string SmallScene::text() const {
  std::string text = "ergotic: 1\nname: small\ngestural_rate: " + number(rates.gesturalHz()) + "\n";
  addPart(text, "sections", sections);
  addPart(text, "mats", mats);
  addPart(text, "lias", lias);
  return text + "outputs:\n  o: {at: m0, quantity: velocity, channel: 1}\n";
}

SmallScene smallScene(unsigned seed) {
  return Maker(seed).make(seed);
}

SmallScene leftOpen(SmallScene scene) {
  static const std::string kKey = ", scheme: ";
  for (std::string& lia : scene.lias) {
    const std::size_t key = lia.find(kKey);
    if (key != std::string::npos) {
      lia.erase(key, lia.find_first_of(",}", key + kKey.size()) - key);
    }
  }
  return scene;
}

}  // namespace ergotic::test
