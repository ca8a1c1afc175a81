// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/speakers.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "constants.hpp"
#include "scene/limits.hpp"

namespace ergotic::scene {
namespace {
constexpr std::size_t kMaxSpeakers = 64;
constexpr double kSame = 1e-6;  // between unit vectors
constexpr Limits kElevationLimits{"rad", -90.0 * kDegree, 90.0 * kDegree};

/// Speakers at one height, evenly round from `first` on; channels go on.
struct Ring {
  int count;
  double first_deg;
  double step_deg;
  double elevation_deg;
};
struct Layout {
  const char* name;
  std::vector<Ring> rings;
};

const std::vector<Layout>& layouts() {
  static const std::vector<Layout> kLayouts = {
      {"stereo", {{2, 30.0, -60.0, 0.0}}},
      {"quad", {{2, 45.0, -90.0, 0.0}, {2, 135.0, 90.0, 0.0}}},
      {"ring8", {{8, 0.0, 45.0, 0.0}}},
      {"dome24", {{12, 0.0, 30.0, 0.0}, {8, 0.0, 45.0, 35.0}, {4, 0.0, 90.0, 70.0}}},
  };
  return kLayouts;
}

Speakers speakersOf(const Layout& layout) {
  std::vector<Eigen::Vector3d> directions;
  std::vector<int> channels;
  for (const Ring& ring : layout.rings) {
    for (int i = 0; i < ring.count; ++i) {
      channels.push_back(static_cast<int>(channels.size()));
      directions.push_back(directionOf((ring.first_deg + i * ring.step_deg) * kDegree,
                                       ring.elevation_deg * kDegree));
    }
  }
  return {std::move(channels), Panner(std::move(directions))};
}

Speakers speakersIn(const SceneBuilder& builder, const Node& list, const std::string& what) {
  if (list.size() < 2 || list.size() > kMaxSpeakers) {
    builder.fail(list.place(), what + " is " + kindOf(list) +
                                   ", allowed: 2...64 of [azimuth, elevation, channel]");
  }
  std::vector<Eigen::Vector3d> directions;
  std::vector<int> channels;
  for (const Node& node : list) {
    const Place place = placeOf(node, list.place());
    if (!node.isList() || node.size() != 3) {
      builder.fail(place, "a speaker of " + what + " is " + kindOf(node) +
                              ", allowed: [azimuth, elevation, channel]");
    }
    directions.push_back(
        directionOf(numberOf(builder, node[0], "azimuth of a speaker", kAngleLimits, place),
                    numberOf(builder, node[1], "elevation of a speaker", kElevationLimits, place)));
    const double channel =
        numberOf(builder, node[2], "channel of a speaker", kChannelLimits, place);
    if (channel != std::floor(channel)) {
      builder.fail(placeOf(node[2], place),
                   "channel of a speaker = " + numberText(channel) +
                       " is not a whole number, allowed: " + kChannelLimits.text());
    }
    if (std::any_of(directions.begin(), directions.end() - 1, [&](const Eigen::Vector3d& other) {
          return (other - directions.back()).norm() < kSame;
        })) {
      builder.fail(place, "two speakers of " + what + " are in one direction");
    }
    channels.push_back(static_cast<int>(channel) - 1);
  }
  return {std::move(channels), Panner(std::move(directions))};
}

/// The node with all that is in it: equal ones have equal texts.
std::string keyOf(const Node& node) {
  std::string text = node.text() + " ";
  for (const Node& part : node) {
    text += keyOf(part);
  }
  return text + ";";
}

}  // namespace

const Speakers& Layouts::read(const YamlMap& map, const std::string& key) {
  const Node& node = map.at(key);
  const std::string text = keyOf(node);
  const auto known = known_.find(text);
  if (known != known_.end()) {
    return known->second;
  }
  if (node.isList()) {
    return known_.emplace(text, speakersIn(builder_, node, "'speakers' of " + map.what()))
        .first->second;
  }
  std::vector<std::string> words;
  for (const Layout& layout : layouts()) {
    words.emplace_back(layout.name);
  }
  return known_.emplace(text, speakersOf(layouts()[map.choice(key, words)])).first->second;
}

}  // namespace ergotic::scene
