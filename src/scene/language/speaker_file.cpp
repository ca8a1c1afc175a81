// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/speaker_file.hpp"

#include <sstream>

#include "scene/text/csv.hpp"
#include "scene/text/number.hpp"
#include "scene/tree/near_file.hpp"
#include "scene/tree/yaml_map.hpp"

namespace ergotic::scene {
namespace {

constexpr std::size_t kMaxSpeakers = 64;
constexpr std::size_t kMaxBytes = 1U << 16U;
constexpr const char* kColumns = "azimuth,elevation,channel";

Node readSpeaker(const CsvReader& csv, Place place) {
  Node speaker(Node::Kind::kList, place);
  const auto add = [&](double number, const char* unit) {
    speaker.add({Node::Kind::kScalar, place, shortest(number) + unit});
  };
  add(csv.number(0, "azimuth", {"deg"}), " deg");
  add(csv.number(1, "elevation", {"deg"}), " deg");
  add(csv.whole(2, "channel", kChannelLimits), "");
  csv.expectEnd(3);
  return speaker;
}

}  // namespace

Node speakersIn(const SceneBuilder& builder, const Node& spec, Place place) {
  const YamlMap map(builder, spec, "'speakers'", place);
  map.allow({"file"});
  const std::string name = map.word("file");
  const Place where = map.placeAt("file");
  const std::string path = pathOfNear(builder, name, "", where);
  const std::string text = readNear(builder, path, kMaxBytes, "", where);
  Node list(Node::Kind::kList, place);
  std::istringstream in(text);
  CsvReader csv(in, path, kColumns);
  while (csv.next()) {
    if (csv.isHeader()) {
      continue;
    }
    if (list.size() == kMaxSpeakers) {
      csv.fail(0, "too many speakers, allowed: " + std::to_string(kMaxSpeakers));
    }
    list.add(readSpeaker(csv, place));
  }
  return list;
}

}  // namespace ergotic::scene
