// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/comedi/comedi_settings.hpp"

#include <algorithm>

#include "ergotic/tgr/driver.hpp"
#include "tgr/settings.hpp"

namespace ergotic::tgr {

const std::vector<std::string> kComediReferences = {"ground", "common", "diff", "other"};

namespace {

using scene::Limits;
using scene::YamlMap;

constexpr Limits kIndexLimits{"", 0.0, 255.0};  // what comedi's words have room for
constexpr Limits kVoltsLimits{"V", -100.0, 100.0};
constexpr Limits kSafeVoltsLimits{"V", -0.5, 0.5};  // an amplifier's offset, not a bias
constexpr Limits kDampingLimits{"N s/m", 0.0, 10'000.0};
constexpr Limits kDiscardLimits{"", 0.0, 16.0};
constexpr Limits kAverageLimits{"", 1.0, 64.0};

int integer(const YamlMap& map, const std::string& key, const Limits& limits, int otherwise) {
  return map.has(key) ? map.integer(key, limits) : otherwise;
}

unsigned reference(const YamlMap& map, const std::string& key) {
  return map.has(key) ? static_cast<unsigned>(map.choice(key, kComediReferences)) : 0U;
}

std::vector<int> channels(const Settings& settings, const std::string& key) {
  const YamlMap& map = settings.top();
  std::vector<int> list = map.integers(key, 1, kMaxSlices, kIndexLimits);
  for (auto channel = list.begin(); channel != list.end(); ++channel) {
    if (std::find(list.begin(), channel, *channel) != channel) {
      settings.builder().fail(
          map.placeAt(key, static_cast<std::size_t>(channel - list.begin())),
          key + ": channel " + std::to_string(*channel) + " comes twice, allowed: each once");
    }
  }
  return list;
}

ComediRange range(const YamlMap& map, const std::string& key) {
  ComediRange range;
  if (!map.has(key)) {
    return range;
  }
  if (map.at(key).isScalar()) {
    range.index = map.integer(key, kIndexLimits);
    return range;
  }
  const std::vector<double> volts = map.vector(key, 2, kVoltsLimits);
  if (volts[0] >= volts[1]) {
    map.fail(key, key + " = [" + scene::numberText(volts[0]) + ", " + scene::numberText(volts[1]) +
                      "] V, allowed: the number of a range, or [low, high] in volts, low < high");
  }
  range.low_volts = volts[0];
  range.high_volts = volts[1];
  return range;
}

std::vector<double> safeVolts(const YamlMap& map, std::size_t slices) {
  if (!map.has("safe_volts")) {
    return std::vector<double>(slices, 0.0);
  }
  if (map.at("safe_volts").isScalar()) {
    return std::vector<double>(slices, map.number("safe_volts", kSafeVoltsLimits));
  }
  return map.vector("safe_volts", slices, kSafeVoltsLimits);
}

}  // namespace

ComediSettings readComediSettings(const YAML::Node& node, const std::string& file) {
  const Settings settings(node, file, "driver comedi");
  const YamlMap& map = settings.top();
  map.allow({"board", "ai_subdevice", "ao_subdevice", "ai_channels", "ao_channels", "ai_range",
             "ao_range", "ai_reference", "ao_reference", "discard", "average", "deglitch",
             "safe_volts", "damping"});
  ComediSettings read;
  if (map.has("board")) {
    read.board = map.word("board");
  }
  read.ai_subdevice = integer(map, "ai_subdevice", kIndexLimits, -1);
  read.ao_subdevice = integer(map, "ao_subdevice", kIndexLimits, -1);
  read.ai_channels = channels(settings, "ai_channels");
  read.ao_channels = channels(settings, "ao_channels");
  if (read.ao_channels.size() != read.ai_channels.size()) {
    map.fail("ao_channels", "ao_channels has " + std::to_string(read.ao_channels.size()) +
                                " channels, allowed: as many as ai_channels, " +
                                std::to_string(read.ai_channels.size()) + ", one per slice");
  }
  read.ai_range = range(map, "ai_range");
  read.ao_range = range(map, "ao_range");
  read.ai_reference = reference(map, "ai_reference");
  read.ao_reference = reference(map, "ao_reference");
  read.discard = integer(map, "discard", kDiscardLimits, read.discard);
  read.average = integer(map, "average", kAverageLimits, read.average);
  read.deglitch = map.flag("deglitch", false);
  read.safe_volts = safeVolts(map, read.ai_channels.size());
  if (map.has("damping")) {
    read.damping = map.number("damping", kDampingLimits);
  }
  return read;
}

}  // namespace ergotic::tgr
