// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/virtual_settings.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "scene/text/number.hpp"
#include "scene/text/source_text.hpp"
#include "tgr/calibration_rules.hpp"
#include "tgr/drivers/virtual/virtual_slice_fields.hpp"
#include "tgr/settings.hpp"

namespace ergotic::tgr {
namespace {

using scene::Limits;
using scene::Place;
using scene::YamlMap;

/// Takes what the map names; the rest stays.
void readMechanics(const YamlMap& map, VirtualSliceConfig& slice) {
  for (const VirtualSliceField& field : kVirtualSliceFields) {
    slice.*field.member = map.number(field.key, field.limits, slice.*field.member);
  }
}

void readVolts(const Settings& settings, const YamlMap& map, VirtualSliceConfig& slice) {
  if (map.has("volts")) {
    slice.volts =
        readSliceCalibration(settings, map.at("volts"), "'volts' of " + map.what(), map.place());
    if (!slice.volts->is_calibrated) {
      map.fail("volts", "'volts' of " + map.what() +
                            " lacks a number, allowed: metres_per_volt and volts_per_newton both");
    }
  }
}

std::vector<std::string> mechanicsKeys() {
  std::vector<std::string> keys;
  for (const VirtualSliceField& field : kVirtualSliceFields) {
    keys.emplace_back(field.key);
  }
  return keys;
}

int sliceIndex(const Settings& settings, const std::string& key, Place place, int slices) {
  const std::optional<int> index = scene::parseInteger(key);
  if (!index || *index < 0 || *index >= slices) {
    settings.builder().fail(place, "slice " + scene::quoted(key) + " of 'others', allowed: 0..." +
                                       std::to_string(slices - 1));
  }
  return *index;
}

void readOthers(const Settings& settings, VirtualDriverConfig& config) {
  const YamlMap& top = settings.top();
  if (!top.has("others")) {
    return;
  }
  scene::forEachEntry(settings.builder(), top.at("others"), "'others' of " + top.what(),
                      top.placeAt("others"),
                      [&](const std::string& key, Place place, const scene::Node& node) {
                        const YamlMap map(settings.builder(), node, "slice " + key, place);
                        std::vector<std::string> keys = mechanicsKeys();
                        keys.emplace_back("volts");
                        map.allow(keys);
                        VirtualSliceConfig slice = config.slice;
                        readMechanics(map, slice);
                        readVolts(settings, map, slice);
                        config.others[sliceIndex(settings, key, place, config.slices)] = slice;
                      });
}

void readInProcess(const Settings& settings, VirtualDriverConfig& config) {
  const YamlMap& top = settings.top();
  top.allow({"slices", "seed", "gesture", "gesture_rate", "shared_memory", "extra_delay_ticks",
             "mechanics", "volts", "others"});
  if (top.has("seed")) {
    config.seed = static_cast<std::uint64_t>(top.integer("seed", {"", 0.0, 2147483647.0}));
  }
  if (top.has("gesture")) {
    config.gesture_file = scene::besideFile(top.word("gesture"), settings.builder().scene().file);
  }
  config.gesture_rate = top.number("gesture_rate", {"Hz", 1.0, 1e6}, 0.0);
  if (top.has("extra_delay_ticks")) {
    constexpr Limits kTicks{"ticks", 0.0, static_cast<double>(kMaxExtraDelayTicks)};
    config.extra_delay_ticks = top.integer("extra_delay_ticks", kTicks);
  }
  if (top.has("mechanics")) {
    const YamlMap mechanics = top.map("mechanics");
    mechanics.allow(mechanicsKeys());
    readMechanics(mechanics, config.slice);
  }
  readVolts(settings, top, config.slice);
  readOthers(settings, config);
}

}  // namespace

VirtualDriverConfig readVirtualSettings(const YAML::Node& node, const std::string& place) {
  const Settings settings(node, place, "driver virtual");
  const YamlMap& top = settings.top();
  VirtualDriverConfig config;
  if (top.has("slices")) {
    config.slices = top.integer("slices", {"", 1.0, static_cast<double>(kMaxSlices)});
  }
  if (top.has("shared_memory")) {  // all the rest is the other process's
    top.allow({"slices", "shared_memory", "is_raw"});
    config.shared_memory = top.word("shared_memory");
    config.is_raw = top.flag("is_raw", false);
  } else {
    readInProcess(settings, config);
  }
  return config;
}

}  // namespace ergotic::tgr
