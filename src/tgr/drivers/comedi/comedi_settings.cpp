// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/comedi/comedi_settings.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "ergotic/exception.hpp"
#include "ergotic/tgr/driver.hpp"

namespace ergotic::tgr {

const std::vector<std::string> kComediReferences = {"ground", "common", "diff", "other"};

namespace {

constexpr int kMaxIndex = 255;  // what a packed channel has room for
constexpr double kMaxVolts = 100.0;

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) {
    all += (all.empty() ? "" : ", ") + word;
  }
  return all;
}

/// The map of settings, with messages that name place, key, value and what is allowed.
class SettingsReader {
 public:
  SettingsReader(const std::string& text, std::string place) : place_(std::move(place)) {
    try {
      map_ = YAML::Load(text);
    } catch (const YAML::Exception& problem) {
      throw Exception(place_ + ": error: settings of comedi: " + problem.what());
    }
    if (!map_.IsMap()) {
      throw Exception(place_ + ": error: settings of comedi: not a map");
    }
  }

  void allow(const std::vector<std::string>& keys) const {
    for (const auto& entry : map_) {
      const auto key = entry.first.as<std::string>("");
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
        throw Exception(place_ + ": error: unknown setting '" + key +
                        "' of comedi, allowed: " + joined(keys));
      }
    }
  }

  YAML::Node at(const std::string& key) const { return map_[key]; }

  [[noreturn]] void fail(const std::string& key, const std::string& allowed) const {
    const YAML::Node node = map_[key];
    std::ostringstream text;
    text << place_ << ": error: setting '" << key << "' of comedi ";
    if (node) {
      text << "= " << YAML::Dump(node) << ", allowed: " << allowed;
    } else {
      text << "is missing, wanted: " << allowed;
    }
    throw Exception(text.str());
  }

  int whole(const std::string& key, int fallback, int low, int high) const {
    return at(key) ? wholeIn(key, at(key), low, high) : fallback;
  }

  int wholeIn(const std::string& key, const YAML::Node& node, int low, int high) const {
    const double value = number(node);
    if (!(value >= low && value <= high) || value != std::floor(value)) {
      fail(key, "whole numbers " + std::to_string(low) + "..." + std::to_string(high));
    }
    return static_cast<int>(value);
  }

  double volts(const std::string& key, const YAML::Node& node) const {
    const double value = number(node);
    if (!(std::abs(value) <= kMaxVolts)) {
      fail(key, "-100...100 V");
    }
    return value;
  }

  bool flag(const std::string& key) const {
    const YAML::Node node = at(key);
    bool value = false;
    if (node && !(node.IsScalar() && YAML::convert<bool>::decode(node, value))) {
      fail(key, "true, false");
    }
    return value;
  }

  unsigned reference(const std::string& key) const {
    if (!at(key)) {
      return 0;
    }
    const auto word = at(key).IsScalar() ? at(key).Scalar() : std::string();
    const auto found = std::find(kComediReferences.begin(), kComediReferences.end(), word);
    if (found == kComediReferences.end()) {
      fail(key, joined(kComediReferences));
    }
    return static_cast<unsigned>(found - kComediReferences.begin());
  }

 private:
  /// NaN if it is none.
  static double number(const YAML::Node& node) {
    double value = 0.0;
    const bool ok = node.IsScalar() && YAML::convert<double>::decode(node, value);
    return ok ? value : std::nan("");
  }

  YAML::Node map_;
  std::string place_;
};

std::vector<int> channels(const SettingsReader& reader, const std::string& key) {
  const YAML::Node node = reader.at(key);
  const std::string allowed =
      "a list of 1..." + std::to_string(kMaxSlices) + " channels, each once";
  if (!node || !node.IsSequence() || node.size() < 1 || node.size() > kMaxSlices) {
    reader.fail(key, allowed);
  }
  std::vector<int> list;
  for (const YAML::Node& channel : node) {
    list.push_back(reader.wholeIn(key, channel, 0, kMaxIndex));
  }
  std::vector<int> sorted = list;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    reader.fail(key, allowed);
  }
  return list;
}

ComediRange range(const SettingsReader& reader, const std::string& key) {
  ComediRange range;
  const YAML::Node node = reader.at(key);
  if (!node) {
    return range;
  }
  if (node.IsScalar()) {
    range.index = reader.wholeIn(key, node, 0, kMaxIndex);
    return range;
  }
  const char* allowed = "the index of a range, or [low, high] in volts";
  if (!node.IsSequence() || node.size() != 2) {
    reader.fail(key, allowed);
  }
  range.low_volts = reader.volts(key, node[0]);
  range.high_volts = reader.volts(key, node[1]);
  if (range.low_volts >= range.high_volts) {
    reader.fail(key, allowed);
  }
  return range;
}

std::vector<double> safeVolts(const SettingsReader& reader, std::size_t slices) {
  const YAML::Node node = reader.at("safe_volts");
  if (!node) {
    return std::vector<double>(slices, 0.0);
  }
  if (node.IsScalar()) {
    return std::vector<double>(slices, reader.volts("safe_volts", node));
  }
  if (!node.IsSequence() || node.size() != slices) {
    reader.fail("safe_volts", "volts for all slices, or a list of one for each");
  }
  std::vector<double> volts;
  for (const YAML::Node& one : node) {
    volts.push_back(reader.volts("safe_volts", one));
  }
  return volts;
}

}  // namespace

ComediSettings readComediSettings(const std::string& text, const std::string& place) {
  const SettingsReader reader(text, place);
  reader.allow({"board", "ai_subdevice", "ao_subdevice", "ai_channels", "ao_channels", "ai_range",
                "ao_range", "ai_reference", "ao_reference", "discard", "average", "deglitch",
                "safe_volts"});
  ComediSettings settings;
  if (reader.at("board")) {
    settings.board = reader.at("board").IsScalar() ? reader.at("board").Scalar() : "";
    if (settings.board.empty()) {
      reader.fail("board", "the path of a device, as /dev/comedi0");
    }
  }
  settings.ai_subdevice = reader.whole("ai_subdevice", -1, 0, kMaxIndex);
  settings.ao_subdevice = reader.whole("ao_subdevice", -1, 0, kMaxIndex);
  settings.ai_channels = channels(reader, "ai_channels");
  settings.ao_channels = channels(reader, "ao_channels");
  if (settings.ao_channels.size() != settings.ai_channels.size()) {
    reader.fail("ao_channels", "as many as ai_channels, one each per slice");
  }
  settings.ai_range = range(reader, "ai_range");
  settings.ao_range = range(reader, "ao_range");
  settings.ai_reference = reader.reference("ai_reference");
  settings.ao_reference = reader.reference("ao_reference");
  settings.discard = reader.whole("discard", 0, 0, 16);
  settings.average = reader.whole("average", 1, 1, 64);
  settings.deglitch = reader.flag("deglitch");
  settings.safe_volts = safeVolts(reader, settings.ai_channels.size());
  return settings;
}

}  // namespace ergotic::tgr
