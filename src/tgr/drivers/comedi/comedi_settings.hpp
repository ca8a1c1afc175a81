// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace YAML {
class Node;
}

namespace ergotic::tgr {

/// A range of a board: by its index, or the narrowest one that holds `low_volts...high_volts`.
struct ComediRange {
  int index = -1;  ///< -1: by volts
  double low_volts = -10.0;
  double high_volts = 10.0;
};

/// Settings of the `comedi` driver. Slice i is read at `ai_channels[i]` and driven by
/// `ao_channels[i]`.
struct ComediSettings {
  std::string board = "/dev/comedi0";
  int ai_subdevice = -1;  ///< -1: the first of its type
  int ao_subdevice = -1;
  std::vector<int> ai_channels;  ///< 1...kMaxSlices, each once
  std::vector<int> ao_channels;  ///< as many
  ComediRange ai_range;
  ComediRange ao_range;
  unsigned ai_reference = 0;  ///< AREF_ constants of comedi.h
  unsigned ao_reference = 0;
  int discard = 0;  ///< conversions thrown away after switching to a channel, 0...16
  int average = 1;  ///< conversions averaged after these, 1...64
  bool deglitch = false;
  std::vector<double> safe_volts;  ///< one per slice: volts that the amplifier takes as no force
  std::optional<double> damping;   ///< own damping of a slice, N s/m, if it is known

  int slices() const { return static_cast<int>(ai_channels.size()); }
};

/// \param node  map, see docs/tgr.md
/// \param file  for messages
/// \throws TextError with file:line:col, value and allowed range
ComediSettings readComediSettings(const YAML::Node& node, const std::string& file);

/// Names of the references, by the index of the AREF_ constants.
extern const std::vector<std::string> kComediReferences;

}  // namespace ergotic::tgr
