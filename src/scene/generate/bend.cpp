// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/bend.hpp"

#include <utility>

namespace ergotic::scene {

void addBend(SceneBuilder& builder, Bend bend) {
  const int index = builder.add(bend);
  const Name stem(bend.name + ".");
  double squares = 0.0;
  for (const Bend::End& end : bend.ends) {
    squares += end.weight * end.weight;
  }
  int springs = 0;
  for (std::size_t i = 0; i < bend.ends.size(); ++i) {
    for (std::size_t j = i + 1; j < bend.ends.size(); ++j) {
      const double u = bend.ends[i].weight;
      const double w = bend.ends[j].weight;
      Lia spring;
      spring.name = stem.numbered(springs++);
      spring.a = bend.ends[i].mat;
      spring.b = bend.ends[j].mat;
      spring.stiffness = -u * w * bend.stiffness;
      spring.damping = -u * w * bend.damping;
      spring.rest_length = (u - w) / squares * bend.rest_length;
      spring.place = bend.place;
      spring.bend = index;
      builder.add(std::move(spring));
    }
  }
}

}  // namespace ergotic::scene
