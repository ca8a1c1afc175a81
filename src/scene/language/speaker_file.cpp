// SPDX-License-Identifier: BSD-3-Clause
#include "scene/language/speaker_file.hpp"

#include "scene/text/csv_line.hpp"
#include "scene/tree/near_file.hpp"
#include "scene/tree/yaml_map.hpp"

namespace ergotic::scene {
namespace {

constexpr std::size_t kMostSpeakers = 64;
constexpr std::size_t kMostBytes = 1U << 16U;
constexpr const char* kLine = "azimuth, elevation, channel";

}  // namespace

Node speakersIn(const SceneBuilder& builder, const Node& spec, Place place) {
  const YamlMap map(builder, spec, "'speakers'", place);
  map.allow({"file"});
  const std::string name = map.word("file");
  const Place where = map.placeAt("file");
  const std::string path = pathOfNear(builder, name, "", where);
  const std::string text = readNear(builder, path, kMostBytes, "", where);
  Node list(Node::Kind::kList, place);
  forEachCsvLine(text, path, [&](CsvLine& line) {
    Node speaker(Node::Kind::kList, place);
    for (const char* const what : {"azimuth", "elevation", "channel"}) {
      const bool is_angle = what[0] != 'c';
      const double number = line.number(what, is_angle ? Limits{"deg"} : kChannelLimits, kLine);
      speaker.add({Node::Kind::kScalar, place, shortest(number) + (is_angle ? " deg" : "")});
      line.skipSeparator();
    }
    line.expectEnd(std::string("a speaker has more than 3 numbers, allowed: ") + kLine);
    if (list.size() == kMostSpeakers) {
      line.fail("too many speakers, allowed: 64");
    }
    list.add(std::move(speaker));
  });
  return list;
}

}  // namespace ergotic::scene
