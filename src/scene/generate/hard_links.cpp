// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/hard_links.hpp"

#include <utility>

#include "scene/generate/generated.hpp"

namespace ergotic::scene {

HardLinks::HardLinks(SceneBuilder& builder,
                     const std::string& name,
                     Hardening hardening,
                     Place place)
    : builder_(builder), stem_(name + ".hard."), place_(place) {
  if (hardening == Hardening::kNone) {
    return;
  }
  Scene& scene = builder.scene();
  tank_ = static_cast<int>(scene.tanks.size());
  Tank tank;
  tank.name = name + ".hard";
  tank.is_mean = hardening == Hardening::kGlobal;
  tank.first_lia = static_cast<int>(scene.lias.size());
  tank.place = place;
  scene.tanks.push_back(std::move(tank));
}

void HardLinks::add(int a, int b, double nonlinearity) {
  Lia lia = generatedLink(stem_, count_++, a, b, place_);
  lia.type = LiaType::kCubic;
  lia.scheme = Scheme::kEnergyStable;
  lia.law.edit().nonlinearity.factor = nonlinearity;
  lia.tank = tank_;
  builder_.add(std::move(lia));
}

}  // namespace ergotic::scene
