// SPDX-License-Identifier: BSD-3-Clause
// Outputs: of one module or many, to one channel, to several, or to speakers around the listener.
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "constants.hpp"
#include "ergotic/scene/grid.hpp"
#include "scene/text/number.hpp"
#include "scene/yaml/points.hpp"
#include "scene/yaml/selections.hpp"
#include "scene/yaml/speakers.hpp"
#include "scene/yaml/yaml_elements.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

/// A place, and whether the output is of many.
struct Heard {
  std::vector<Point> points;
  bool are_many = false;
  /// [points] how much of each makes one place of a mesh, plate or skin; none: all of each.
  std::vector<double> weights{};
};

/// The force at a place between the modules of a mesh is interpolated, as its motion is.
Heard forceOn(const Grid& grid, const NamedPlace& at) {
  const GridPlace around = placeOn(grid, at.along, at.across);
  Heard heard;
  for (std::size_t i = 0; i < static_cast<std::size_t>(around.count); ++i) {
    heard.points.push_back({around.mats[i], -1, 0.0});
    heard.weights.push_back(around.weights[i]);
  }
  return heard;
}

/// A module; a place on a string, between two of its modules; a point on a mesh; or many of these.
Heard readHeardPlaces(SceneBuilder& builder, const YamlMap& map, Quantity quantity) {
  const Place place = map.placeAt("at");
  const Node& node = map.at("at");
  if (node.isScalar() && !isSelection(node.text()) && node.text().find('@') != std::string::npos) {
    const NamedPlace at = namedPlace(builder, node.text(), place);
    const Grid& grid = builder.scene().grids[static_cast<std::size_t>(at.grid)];
    if (grid.rows == 1 && moduleOn(grid, at) < 0) {
      const GridPlace around = placeOn(grid, at.along, 0.0);
      return {{{around.mats[0], around.mats[1], around.weights[1]}}, false};
    }
    if (grid.rows > 1 && moduleOn(grid, at) < 0 && quantity == Quantity::kForce) {
      return forceOn(grid, at);
    }
  }
  const Selection selection = selectionOf(builder, node, "'at' of " + map.what(), place);
  Heard heard{{}, selection.is_set};
  for (const int mat : selection.mats) {
    heard.points.push_back({mat, -1, 0.0});
  }
  return heard;
}

int channelIn(const SceneBuilder& builder, const Node& node, const std::string& what, Place place) {
  const double channel = numberOf(builder, node, what, kChannelLimits, place);
  if (channel != static_cast<int>(channel)) {
    builder.fail(placeOf(node, place),
                 what + " = " + numberText(channel) +
                     " is not a whole number, allowed: " + kChannelLimits.text());
  }
  return static_cast<int>(channel) - 1;
}

/// `1..8`, or a list. From 0.
std::vector<int> readChannels(const SceneBuilder& builder, const YamlMap& map) {
  const Node& node = map.at("channels");
  const std::string what = "'channels' of " + map.what();
  const Place place = map.placeAt("channels");
  std::vector<int> channels;
  if (node.isList() && node.size() > 0) {
    for (const Node& item : node) {
      channels.push_back(channelIn(builder, item, what, place));
    }
    return channels;
  }
  const std::size_t dots = node.isScalar() ? node.text().find("..") : std::string::npos;
  if (dots == std::string::npos) {
    map.fail("channels", what + " is " + kindOf(node) + ", allowed: 1..8 and the like, or a list");
  }
  const auto end = [&](const std::string& text) {
    return channelIn(builder, Node(Node::Kind::kScalar, place, text), what, place);
  };
  const int first = end(node.text().substr(0, dots));
  const int last = end(node.text().substr(dots + 2));
  if (first > last) {
    map.fail("channels", what + " is " + quoted(node.text()) + ", allowed: from the lower one on");
  }
  for (int channel = first; channel <= last; ++channel) {
    channels.push_back(channel);
  }
  return channels;
}

struct Direction {
  double azimuth = 0.0;    // rad
  double elevation = 0.0;  // rad
};

Direction directionIn(const SceneBuilder& builder,
                      const Node& node,
                      const std::string& what,
                      Place place) {
  if (node.isScalar()) {
    return {numberOf(builder, node, what, kAngleLimits, place), 0.0};
  }
  if (!node.isList() || node.size() != 2) {
    builder.fail(placeOf(node, place),
                 what + " is " + kindOf(node) + ", allowed: [azimuth, elevation]");
  }
  return {numberOf(builder, node[0], what, kAngleLimits, place),
          numberOf(builder, node[1], what, kAngleLimits, place)};
}

/// `spread(-40 deg, 40 deg)`: evenly from one azimuth to the other.
std::vector<Direction> spread(const SceneBuilder& builder,
                              const YamlMap& map,
                              const std::string& what,
                              std::size_t count) {
  const std::string text = map.word("pan");
  const std::size_t comma = text.find(',');
  if (text.compare(0, 7, "spread(") != 0 || text.back() != ')' || comma == std::string::npos) {
    map.fail("pan", what + " is " + quoted(text) +
                        ", allowed of many: spread(-40 deg, 40 deg), or a direction for each");
  }
  const auto angle = [&](const std::string& part) {
    return numberIn(builder, part, what, kAngleLimits, map.placeAt("pan"));
  };
  const double first = angle(trimmed(text.substr(7, comma - 7)));
  const double last = angle(trimmed(text.substr(comma + 1, text.size() - comma - 2)));
  std::vector<Direction> directions;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.5;
    directions.push_back({first + share * (last - first), 0.0});
  }
  return directions;
}

std::vector<Direction> readPan(const SceneBuilder& builder,
                               const YamlMap& map,
                               const Heard& heard) {
  const Node& node = map.at("pan");
  const std::string what = "'pan' of " + map.what();
  if (!heard.are_many && node.isScalar() && node.text().compare(0, 7, "spread(") == 0) {
    map.fail("pan", what + " is " + quoted(node.text()) +
                        ", allowed of a single module: a direction, as 20 deg, or "
                        "[azimuth, elevation]");
  }
  if (!heard.are_many) {
    return {directionIn(builder, node, what, map.placeAt("pan"))};
  }
  if (node.isScalar()) {
    return spread(builder, map, what, heard.points.size());
  }
  if (!node.isList() || node.size() != heard.points.size()) {
    map.fail("pan", what + " is " + kindOf(node) + ", allowed: a direction for each of " +
                        std::to_string(heard.points.size()) + ", or spread(-40 deg, 40 deg)");
  }
  std::vector<Direction> directions;
  for (const Node& item : node) {
    directions.push_back(directionIn(builder, item, what, map.placeAt("pan")));
  }
  return directions;
}

class OutputReader {
 public:
  OutputReader(SceneBuilder& builder, const YamlMap& top)
      : builder_(builder), top_(top), layouts_(builder) {
    if (top.has("speakers")) {
      layouts_.read(top, "speakers");  // says what is wrong with it even if nothing is panned
    }
  }

  void read(const std::string& name, const YamlMap& map) {
    map.allow(outputKeys());
    const auto ways = std::count_if(std::begin(kWays), std::end(kWays),
                                    [&](const char* key) { return map.has(key); });
    if (ways != 1 && !(ways == 2 && map.has("speakers") && map.has("pan"))) {
      builder_.fail(map.place(), map.what() + (ways == 0 ? " goes nowhere" : " goes two ways") +
                                     ", allowed: 'channel', 'channels', or 'speakers' and 'pan'");
    }
    Output output;
    output.place = map.place();
    output.quantity = readQuantity(map, {"position", "force", "velocity"});
    const Heard heard = readHeardPlaces(builder_, map, output.quantity);
    if (!heard.weights.empty() && !map.has("channel")) {
      map.fail("at", "the force at a place of a mesh goes to one channel, allowed: 'channel'");
    }
    output.axis = readAxis(builder_, map, heard.points.front().mat);
    output.gain = map.value("gain", kGainLimits, {1.0});
    if (map.has("radiation")) {
      output.radiation_hz = map.number("radiation", kRadiationLimits);
      if (output.quantity != Quantity::kVelocity) {
        map.fail("radiation", "'radiation' of " + map.what() +
                                  ", which hears no velocity, allowed: with 'quantity: velocity'");
      }
    }
    name_ = name;
    next_ = heard.points.size() > 1 || heard.are_many || !map.has("channel") ? 0 : -1;
    if (map.has("channel")) {
      output.channel = map.integer("channel", kChannelLimits) - 1;
      const Value gain = output.gain;
      for (std::size_t i = 0; i < heard.points.size(); ++i) {
        output.point = heard.points[i];
        output.gain = heard.weights.empty() ? gain : heard.weights[i] * gain;
        add(output);
      }
    } else if (map.has("pan")) {
      pan(map, heard, output);
    } else {
      deal(map, heard, output);
    }
  }

 private:
  static constexpr const char* kWays[] = {"channel", "channels", "speakers", "pan"};

  void add(Output output) {
    output.name = next_ < 0 ? name_ : name_ + "." + std::to_string(next_++);
    builder_.scene().outputs.push_back(std::move(output));
  }

  const Speakers& speakersOf(const YamlMap& map) {
    if (!map.has("speakers") && !top_.has("speakers")) {
      builder_.fail(map.keyPlaceAt("pan"), "'pan' of " + map.what() +
                                               " without 'speakers', allowed: with " +
                                               "those of the output, or of the scene");
    }
    return layouts_.read(map.has("speakers") ? map : top_, "speakers");
  }

  /// Deals out the modules: one to each channel, in turn; or one module to all channels.
  void deal(const YamlMap& map, const Heard& heard, Output& output) {
    const bool is_named = map.has("channels");
    const std::vector<int> channels =
        is_named ? readChannels(builder_, map) : speakersOf(map).channels;
    const std::size_t places = heard.points.size();
    if (places > 1 && places % channels.size() != 0) {
      map.fail(is_named ? "channels" : "speakers",
               map.what() + " has " + std::to_string(places) + " modules for " +
                   std::to_string(channels.size()) + " channels, allowed: as many for each");
    }
    for (std::size_t i = 0; i < std::max(places, channels.size()); ++i) {
      output.point = heard.points[places > 1 ? i : 0];
      output.channel = channels[i % channels.size()];
      add(output);
    }
  }

  void pan(const YamlMap& map, const Heard& heard, Output& output) {
    const Speakers& speakers = speakersOf(map);
    const Value gain = output.gain;
    const std::vector<Direction> directions = readPan(builder_, map, heard);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const auto gains =
          speakers.panner.gains(directionOf(directions[i].azimuth, directions[i].elevation));
      if (!gains) {
        map.fail("pan", "'pan' of " + map.what() + ": [" +
                            numberText(directions[i].azimuth / kDegree) + ", " +
                            numberText(directions[i].elevation / kDegree) +
                            "] deg is not between speakers, allowed: where they are around it");
      }
      output.point = heard.points[i];
      for (std::size_t s = 0; s < gains->size(); ++s) {
        if ((*gains)[s] > 0.0) {
          output.channel = speakers.channels[s];
          output.gain = (*gains)[s] * gain;
          add(output);
        }
      }
    }
  }

  SceneBuilder& builder_;
  const YamlMap& top_;
  Layouts layouts_;
  std::string name_;
  int next_ = -1;  // number behind the name
};

}  // namespace

Quantity readQuantity(const YamlMap& map, const std::vector<std::string>& words) {
  constexpr Quantity kQuantities[] = {Quantity::kPosition, Quantity::kForce, Quantity::kVelocity};
  return kQuantities[map.choice("quantity", words)];
}

void readOutputs(SceneBuilder& builder, const YamlMap& top) {
  OutputReader reader(builder, top);
  forEachElement(builder, top, "outputs", "output",
                 [&](const std::string& name, const YamlMap& map) { reader.read(name, map); });
}

}  // namespace ergotic::scene
