// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/stretch.hpp"

#include <utility>

namespace ergotic::scene {
namespace {

/// Q = K c/(2 a^2). \pre K or c is no parameter
Value hardeningOf(const Tank& tank, const Value& stiffness) {
  const double per_stiffness = 0.5 / (tank.spacing * tank.spacing);
  return stiffness.parameter < 0 ? per_stiffness * stiffness.factor * tank.hardening
                                 : per_stiffness * tank.hardening.factor * stiffness;
}

}  // namespace

void addStretch(SceneBuilder& builder, Tank tank) {
  Scene& scene = builder.scene();
  const Name stem(tank.name + ".");
  tank.first_lia = static_cast<int>(scene.lias.size());
  int count = 0;
  for (const int l : tank.springs) {
    const Lia& spring = scene.lias[static_cast<std::size_t>(l)];
    Lia lia;
    lia.name = stem.numbered(count++);
    lia.type = LiaType::kCubic;
    lia.scheme = Scheme::kEnergyStable;
    lia.a = spring.a;
    lia.b = spring.b;
    lia.rest_length = spring.rest_length;
    lia.law.edit().nonlinearity = hardeningOf(tank, spring.stiffness);
    lia.place = tank.place;
    lia.tank = static_cast<int>(scene.tanks.size());
    builder.add(std::move(lia));
  }
  scene.tanks.push_back(std::move(tank));
}

void settleStretches(Scene& scene) {
  for (const Tank& tank : scene.tanks) {
    for (std::size_t i = 0; i < tank.springs.size(); ++i) {
      const Value& stiffness = scene.lias[static_cast<std::size_t>(tank.springs[i])].stiffness;
      scene.lias[static_cast<std::size_t>(tank.first_lia) + i].law.edit().nonlinearity =
          hardeningOf(tank, stiffness);
    }
  }
}

}  // namespace ergotic::scene
