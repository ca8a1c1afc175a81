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

int Scene::inputChannels() const {
  return std::max(channelsOf(inputs), channelsOf(audio_parameters));
}

int Scene::outputChannels() const {
  return channelsOf(outputs);
}

}  // namespace ergotic::scene
