// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/chaplet.hpp"

#include <cmath>
#include <utility>

#include "ergotic/scene/generate/chaplet.hpp"
#include "scene/generate/generated.hpp"

namespace ergotic::scene {

void addChaplet(SceneBuilder& builder, const ChapletSpec& spec) {
  const double nyquist = M_PI * builder.scene().gestural_rate_hz;  // wN, rad/s
  const Mat carrier = builder.scene().mats[static_cast<std::size_t>(spec.from)];

  int previous = spec.from;
  int index = 0;
  for (const ChapletStage& stage : kChapletC2) {
    Mat mat;
    mat.name = Name(spec.name + ".").numbered(index);
    mat.section = spec.section;
    mat.mass = stage.mass * spec.mass;
    mat.rest.x() = carrier.rest.x();
    mat.position.x() = carrier.position.x();
    mat.rest.y() = spec.at.x();
    mat.rest.z() = spec.at.y();
    mat.place = spec.place;
    const int added = builder.add(std::move(mat));
    Lia lia = generatedLink(linkStem(spec.name), index, previous, added, spec.place);
    lia.stiffness = stage.stiffness * nyquist * nyquist * spec.mass;
    lia.damping = stage.damping * nyquist * spec.mass;
    builder.add(std::move(lia));
    previous = added;
    ++index;
  }
}

}  // namespace ergotic::scene
