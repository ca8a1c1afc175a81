// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/stops.hpp"

#include <cmath>
#include <utility>

#include "at.hpp"
#include "ergotic/scene/grid.hpp"
#include "scene/generate/generated.hpp"
#include "scene/generate/points.hpp"

namespace ergotic::scene {
namespace {

constexpr double kOnModule = 1e-9;  // of the spacing

/// The module of the string at a place, or a point there.
int onString(SceneBuilder& builder, const StopsSpec& spec, const Name& name, double along) {
  const GridPlace there = placeOn(builder.scene().grids[at(spec.grid)], along, 0.0);
  for (std::size_t i = 0; i < at(there.count); ++i) {
    if (!spec.are_points && there.weights[i] > 1.0 - kOnModule) {
      return there.mats[i];
    }
  }
  Connection connection;
  connection.grid = spec.grid;
  connection.along.at = {along};
  connection.place = spec.place;
  return addPoint(builder, name.str(), connection);
}

}  // namespace

std::vector<StopsSpec::Stop> fretsOf(int count,
                                     double at_nut,
                                     double at_bridge,
                                     bool is_from_last) {
  std::vector<StopsSpec::Stop> frets;
  for (int k = 1; k <= count; ++k) {
    const double sounding = std::exp2(-k / 12.0);
    const double below = sounding * at_nut + (1.0 - sounding) * at_bridge;
    frets.push_back({is_from_last ? sounding : 1.0 - sounding, -below});
  }
  return frets;
}

void addStops(SceneBuilder& builder, const StopsSpec& spec) {
  builder.reserve(2 * spec.stops.size(), spec.stops.size(), spec.place);
  const Name stem(spec.name + ".");
  const Name points(spec.name + ".at.");
  const Name links(spec.name + ".stop.");
  const auto first_lia = static_cast<int>(builder.scene().lias.size());
  int next = 0;
  for (const StopsSpec::Stop& stop : spec.stops) {
    const int on = onString(builder, spec, points.numbered(next), stop.along);
    const Mat& met = builder.scene().mats[at(on)];
    Mat ground = generatedMat(builder, met.section, stem.numbered(next), met.rest, spec.place);
    ground.type = MatType::kGround;
    ground.position.x() += stop.height;
    const int below = builder.add(std::move(ground));
    Lia lia = generatedLink(links, next++, below, on, spec.place);
    lia.type = LiaType::kContact;
    lia.scheme = Scheme::kAuto;
    lia.damping = spec.damping;
    builder.add(std::move(lia));
  }
  Tuning open;
  open.name = spec.name;
  open.first_lia = first_lia;
  open.lias = next;
  open.place = spec.place;
  builder.scene().tunings.push_back(std::move(open));
}

}  // namespace ergotic::scene
