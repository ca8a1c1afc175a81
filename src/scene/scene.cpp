// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace ergotic::scene {
namespace {

template <class T>
int channelsOf(const std::vector<T>& list) {
  int channels = 0;
  for (const T& item : list) {
    channels = std::max(channels, item.channel + 1);
  }
  return channels;
}

}  // namespace

int dimensionsOf(Geometry geometry) {
  switch (geometry) {
    case Geometry::kScalar:
    case Geometry::kLine:
      return 1;
    case Geometry::kPlane:
      return 2;
    case Geometry::kSpace:
      return 3;
  }
  return 1;
}

double Agent::at(double time_s) const noexcept {
  const double t = period_s > 0.0 ? std::fmod(time_s, period_s) : time_s;
  const auto next =
      std::upper_bound(knots.begin(), knots.end(), t,
                       [](double time, const auto& knot) { return time < knot.first; });
  if (next == knots.begin()) {
    return knots.front().second;
  }
  const auto last = std::prev(next);
  if (next == knots.end()) {
    return last->second;
  }
  const double part = (t - last->first) / (next->first - last->first);
  return last->second + part * (next->second - last->second);
}

int Scene::coordinates() const {
  int count = 0;
  for (const Mat& mat : mats) {
    count += dimensionsOf(sectionOf(mat).geometry);
  }
  return count;
}

int Scene::inputChannels() const {
  return std::max(channelsOf(inputs), channelsOf(audio_parameters));
}

int Scene::outputChannels() const {
  return channelsOf(outputs);
}

bool isSettled(const Scene& scene) {
  const auto none = [](const auto& all, auto&& is_open) {
    return std::none_of(all.begin(), all.end(), is_open);
  };
  return scene.tunings.empty() &&
         none(scene.sections, [](const Section& s) { return s.automatic_rate; }) &&
         none(scene.strings, [](const StringInfo& s) { return s.frequency_hz > 0.0; }) &&
         none(scene.mats,
              [](const Mat& m) {
                return m.coupling == Coupling::kChaplet || m.coupling == Coupling::kAuto;
              }) &&
         none(scene.lias, [](const Lia& lia) { return lia.filtered || isOpen(lia.scheme); });
}

}  // namespace ergotic::scene
