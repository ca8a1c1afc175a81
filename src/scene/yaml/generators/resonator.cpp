// SPDX-License-Identifier: BSD-3-Clause
#include <sstream>
#include <vector>

#include "scene/generate/ring.hpp"
#include "scene/text/csv.hpp"
#include "scene/yaml/generators/body_keys.hpp"
#include "scene/yaml/generators/generator_keys.hpp"
#include "scene/yaml/generators/readers.hpp"
#include "scene/yaml/point_files.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

constexpr std::size_t kMaxRows = 400;
constexpr std::size_t kMaxPlaces = 64;
constexpr std::size_t kColumns = 3;  // before the weights
constexpr Limits kWavesLimits{"", -12.0, 12.0};
constexpr Limits kPartialRatioLimits{"", 0.0, 1000.0, true};

std::vector<std::string> readPlaceNames(const SceneBuilder& builder, const YamlMap& map) {
  std::vector<std::string> names;
  if (!map.has("places")) {
    return names;
  }
  const Node& list = map.at("places");
  if (!list.isList() || list.size() < 1 || list.size() > kMaxPlaces) {
    map.fail("places", "'places' of " + map.what() + " is " + kindOf(list) +
                           ", allowed: a list of 1...64 names");
  }
  for (const Node& node : list) {
    const Place place = placeOf(node, map.placeAt("places"));
    names.push_back(wordOf(builder, node, "a place of " + map.what(), place));
    checkName(builder, names.back(), place);
  }
  return names;
}

Limits limitsOfFrequency(double pitch_hz) {
  return pitch_hz > 0.0 ? kPartialRatioLimits : Limits{"Hz", 0.0, kHighestPartialHz, true};
}

/// \param row  frequency or ratio, t60, mass, weights
Partial partialOfRow(const std::vector<double>& row, double pitch_hz) {
  Partial partial;
  partial.frequency_hz = (pitch_hz > 0.0 ? pitch_hz : 1.0) * row[0];
  partial.t60_s = row[1];
  partial.mass = row[2];
  partial.weights.assign(row.begin() + kColumns, row.end());
  return partial;
}

Partial readPartial(const SceneBuilder& builder,
                    const YamlMap& map,
                    const Node& row,
                    double pitch_hz,
                    std::size_t places) {
  const Place place = placeOf(row, map.placeAt("partials"));
  if (!row.isList() || row.size() != kColumns + places) {
    builder.fail(
        place,
        "a partial of " + map.what() + " is " + kindOf(row) + ", allowed: [frequency, t60, mass" +
            (places > 0 ? ", a weight for each of " + std::to_string(places) + " places]" : "]"));
  }
  const std::string of = " of a partial of " + map.what();
  std::vector<double> numbers{
      numberOf(builder, row[0], (pitch_hz > 0.0 ? "ratio" : "frequency") + of,
               limitsOfFrequency(pitch_hz), place),
      numberOf(builder, row[1], "t60" + of, kT60Limits, place),
      numberOf(builder, row[2], "mass" + of, kMassLimits, place)};
  for (std::size_t p = 0; p < places; ++p) {
    numbers.push_back(numberOf(builder, row[kColumns + p], "a weight" + of, kWeightLimits, place));
  }
  Partial partial = partialOfRow(numbers, pitch_hz);
  const Limits heard = limitsOfFrequency(0.0);
  if (!heard.hold(partial.frequency_hz)) {
    builder.fail(placeOf(row[0], place), outOfRange("frequency" + of, partial.frequency_hz, heard));
  }
  return partial;
}

std::vector<double> readRow(const CsvReader& csv, double pitch_hz, std::size_t places) {
  std::vector<double> row;
  const auto read = [&](const char* what, const Limits& limits) {
    row.push_back(csv.number(row.size(), what, limits));
  };
  read(pitch_hz > 0.0 ? "ratio" : "frequency", limitsOfFrequency(pitch_hz));
  if (pitch_hz > 0.0 && !limitsOfFrequency(0.0).hold(pitch_hz * row[0])) {
    csv.fail(0, outOfRange("frequency", pitch_hz * row[0], limitsOfFrequency(0.0)));
  }
  read("t60", kT60Limits);
  read("mass", kMassLimits);
  for (std::size_t p = 0; p < places; ++p) {
    read("a weight", kWeightLimits);
  }
  csv.expectEnd(kColumns + places);
  return row;
}

/// Reads the rows of a file, with as many numbers in each line as a row has.
RowList readRows(const PointFiles::File& file, double pitch_hz, std::size_t places) {
  const std::string columns =
      "frequency, t60, mass" +
      (places > 0 ? " and " + std::to_string(places) + " weights" : std::string()) + " in a line";
  std::istringstream in(file.text);
  CsvReader csv(in, file.path, columns);
  RowList rows;
  while (csv.next()) {
    if (csv.isHeader()) {
      continue;
    }
    if (rows.size() == kMaxRows) {
      csv.fail(0, "too many partials, allowed: 1..." + std::to_string(kMaxRows));
    }
    rows.push_back(readRow(csv, pitch_hz, places));
  }
  if (rows.empty()) {
    csv.failAtLine("the list has no partials, allowed: 1..." + std::to_string(kMaxRows));
  }
  return rows;
}

/// Reads partials from the rows of a list, in the scene or in its second document.
std::vector<Partial> readList(const SceneBuilder& builder,
                              const YamlMap& map,
                              const Node& rows,
                              double pitch_hz,
                              std::size_t places) {
  if (!rows.isList() || rows.size() < 1 || rows.size() > kMaxRows) {
    map.fail("partials", "'partials' of " + map.what() + " is " + kindOf(rows) +
                             ", allowed: a list of 1...400 rows [frequency, t60, mass, ...], or "
                             "{file: name.csv}");
  }
  std::vector<Partial> partials;
  for (const Node& row : rows) {
    partials.push_back(readPartial(builder, map, row, pitch_hz, places));
  }
  return partials;
}

std::vector<Partial> readPartials(const SceneBuilder& builder,
                                  const YamlMap& map,
                                  double pitch_hz,
                                  std::size_t places,
                                  PointFiles& files) {
  if (!map.at("partials").isMap()) {
    return readList(builder, map, map.at("partials"), pitch_hz, places);
  }
  const YamlMap spec = map.map("partials");
  spec.allow({"file"});
  const std::string name = PointFiles::nameOf(spec);
  if (files.isSelfContained()) {
    const PointFiles::Appended* appended = files.find(PointFiles::Part::kPartials, name);
    if (appended == nullptr) {
      spec.fail("file", "file " + quoted(name) + " of " + map.what() +
                            " is not among the partials of the second document");
    }
    return readList(builder, map, *appended->points, pitch_hz, places);
  }
  const RowList rows = readRows(files.open(spec), pitch_hz, places);
  files.keep(PointFiles::Part::kPartials, name, rows);
  std::vector<Partial> partials;
  for (const std::vector<double>& row : rows) {
    partials.push_back(partialOfRow(row, pitch_hz));
  }
  return partials;
}

/// How it looks, for pictures alone.
RingShape readRing(const SceneBuilder& builder, const YamlMap& map, std::size_t partials) {
  const YamlMap ring = map.map("ring");
  ring.allow({"radius", "height", "waves"});
  RingShape shape;
  shape.radius = ring.number("radius", kSpacingLimits);
  shape.height = ring.number("height", kMetreLimits, 0.0);
  shape.waves = ring.integers("waves", 1, kMaxRows, kWavesLimits);
  if (shape.waves.size() != partials) {
    builder.fail(ring.placeAt("waves"), "'waves' of " + ring.what() + " has " +
                                            std::to_string(shape.waves.size()) +
                                            " numbers, allowed: one for each of its " +
                                            std::to_string(partials) + " partials");
  }
  return shape;
}

}  // namespace

void readResonator(SceneBuilder& builder,
                   const std::string& name,
                   const YamlMap& map,
                   PointFiles& files) {
  map.allow(resonatorKeys());
  ModalSpec spec;
  spec.name = name;
  spec.place = map.placeAt("name");
  spec.section = bodySection(builder, map);
  spec.at = readRest(sectionAt(builder, spec.section), map, "at");
  spec.places = readPlaceNames(builder, map);
  const double pitch_hz = map.number("pitch", kFrequencyLimits, 0.0);
  spec.partials = readPartials(builder, map, pitch_hz, spec.places.size(), files);
  if (map.has("ring")) {
    setRing(spec, readRing(builder, map, spec.partials.size()));
  }
  addModalBody(builder, spec);
}

}  // namespace ergotic::scene
