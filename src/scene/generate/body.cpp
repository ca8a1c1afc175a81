// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/body.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "at.hpp"
#include "scene/generate/body_modes.hpp"

namespace ergotic::scene {
namespace {

constexpr int kPartialsToTell = 8;
constexpr int kMaxMasses = 20'000;  // of all bodies of a scene: their modes are looked for

void requireFew(const SceneBuilder& builder, const Tuning& body) {
  int masses = body.mats;
  for (const Tuning& other : builder.scene().tunings) {
    masses += other.mats;
  }
  if (masses > kMaxMasses) {
    builder.fail(body.place, "the bodies with a pitch would have " + std::to_string(masses) +
                                 " modules together, allowed: at most " +
                                 std::to_string(kMaxMasses));
  }
}

/// The highest partial that is asked for.
int highestPartial(const BodyWish& wish) {
  int highest = wish.pitch_of;
  for (const auto& [partial, seconds] : wish.t60) {
    highest = std::max(highest, partial);
  }
  return highest;
}

}  // namespace

Tuning beginBody(const SceneBuilder& builder, const std::string& name, Place place) {
  const Scene& scene = builder.scene();
  Tuning body;
  body.name = name;
  body.place = place;
  body.first_mat = static_cast<int>(scene.mats.size());
  body.first_lia = static_cast<int>(scene.lias.size());
  body.first_bend = static_cast<int>(scene.bends.size());
  return body;
}

void endBody(const SceneBuilder& builder, Tuning& body) {
  const Scene& scene = builder.scene();
  body.mats = static_cast<int>(scene.mats.size()) - body.first_mat;
  body.lias = static_cast<int>(scene.lias.size()) - body.first_lia;
  body.bends = static_cast<int>(scene.bends.size()) - body.first_bend;
}

void findModes(const Scene& scene, Tuning& body) {
  BodyModes found = lowestModes(scene, body, static_cast<int>(body.modes.size()));
  body.modes = std::move(found.modes);
  body.top = found.top;
}

void finishBody(SceneBuilder& builder, Tuning body, const BodyWish& wish) {
  Scene& scene = builder.scene();
  endBody(builder, body);
  requireFew(builder, body);
  const int highest = highestPartial(wish);
  body.modes.resize(at(std::max(highest, kPartialsToTell)));
  findModes(scene, body);
  const auto found = static_cast<int>(body.modes.size());
  if (found < highest) {
    builder.fail(body.place, "generator " + quoted(body.name) + " has " + std::to_string(found) +
                                 " partials, but partial " + std::to_string(highest) +
                                 " is asked for, allowed: 1..." + std::to_string(found));
  }
  body.pitch_hz = wish.pitch_hz;
  body.pitch_mode = wish.pitch_of - 1;
  body.inharmonicity = wish.inharmonicity;
  for (const auto& [partial, seconds] : wish.t60) {
    body.decays.push_back({partial - 1, seconds});
  }
  const Tuning::Mode& mode = body.modes[at(body.pitch_mode)];
  const double omega = 2.0 * M_PI * wish.pitch_hz * scene.time_unit_s;
  BodyScale scale;
  scale.springs = scale.bends = omega * omega / (mode.springs + mode.bends);
  scaleBody(scene, body, scale);
  scene.tunings.push_back(std::move(body));
}

void scaleBody(Scene& scene, Tuning& body, const BodyScale& scale) {
  for (int l = body.first_lia; l < body.first_lia + body.lias; ++l) {
    Lia& lia = scene.lias[at(l)];
    lia.stiffness = (lia.bend < 0 ? scale.springs : scale.bends) * lia.stiffness;
    lia.damping = scale.dampers * lia.damping;
    if (lia.tank >= 0) {
      lia.law.edit().nonlinearity = scale.springs * lia.law->nonlinearity;
    }
  }
  for (int b = body.first_bend; b < body.first_bend + body.bends; ++b) {
    Bend& bend = scene.bends[at(b)];
    bend.stiffness = scale.bends * bend.stiffness;
  }
  for (int m = body.first_mat; m < body.first_mat + body.mats; ++m) {
    Mat& mat = scene.mats[at(m)];
    if (mat.type == MatType::kCell) {
      mat.damping = scale.loss * mat.mass;
    }
  }
  const auto scaled = [&](const Tuning::Mode& mode) {
    return Tuning::Mode{scale.springs * mode.springs, scale.bends * mode.bends,
                        scale.dampers * mode.dampers};
  };
  std::transform(body.modes.begin(), body.modes.end(), body.modes.begin(), scaled);
  body.top = scaled(body.top);
}

}  // namespace ergotic::scene
