// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/scene.hpp"

#include <algorithm>

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

}  // namespace ergotic::scene
