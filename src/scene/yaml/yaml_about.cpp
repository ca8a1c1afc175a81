// SPDX-License-Identifier: BSD-3-Clause
// What readers and players are told of a scene.
#include <algorithm>
#include <cctype>
#include <optional>

#include "scene/text/number.hpp"
#include "scene/yaml/yaml_elements.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

constexpr std::size_t kMaxTitleBytes = 200;
constexpr std::size_t kMaxWordsBytes = 4096;

std::string readWords(const YamlMap& about, const std::string& key, std::size_t most) {
  if (!about.has(key)) {
    return "";
  }
  std::string words = about.word(key);
  if (words.size() > most) {
    about.fail(key, quoted(key) + " of " + about.what() + " has " + std::to_string(words.size()) +
                        " bytes, allowed: at most " + std::to_string(most));
  }
  return words;
}

/// An SPDX expression, as `CC-BY-4.0` or `MIT OR Apache-2.0`, as far as its letters tell.
std::string readLicence(const YamlMap& about) {
  std::string licence = readWords(about, "licence", kMaxTitleBytes);
  const auto is_of_it = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string("-.+() ").find(c) != std::string::npos;
  };
  if (about.has("licence") &&
      (licence.empty() || !std::all_of(licence.begin(), licence.end(), is_of_it))) {
    about.fail("licence", "'licence' is " + quoted(licence) +
                              ", allowed: an SPDX expression, as CC-BY-4.0 or MIT OR CC0-1.0");
  }
  return licence;
}

/// `3`, or `0..5`, the lower one first.
bool areSlices(const std::string& key) {
  const std::size_t dots = key.find("..");
  const std::optional<int> first = parseInteger(key.substr(0, dots));
  const std::optional<int> last =
      dots == std::string::npos ? first : parseInteger(key.substr(dots + 2));
  return first && last && kSliceLimits.hold(*first) && kSliceLimits.hold(*last) && *first <= *last;
}

Eigen::Vector3d vectorOf(const YamlMap& map, const std::string& key) {
  const std::vector<double> numbers = map.vector(key, 3, kMetreLimits);
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

About readAbout(const SceneBuilder& builder, const YamlMap& top) {
  About about;
  if (!top.has("about")) {
    return about;
  }
  const YamlMap map = top.map("about");
  map.allow(aboutKeys());
  about.title = readWords(map, "title", kMaxTitleBytes);
  about.author = readWords(map, "author", kMaxTitleBytes);
  about.licence = readLicence(map);
  about.description = readWords(map, "description", kMaxWordsBytes);
  about.play = readWords(map, "play", kMaxTitleBytes);
  if (map.has("hands")) {
    forEachEntry(builder, map.at("hands"), "'hands' of " + map.what(), map.keyPlaceAt("hands"),
                 [&](const std::string& key, Place place, const Node& node) {
                   if (!areSlices(key)) {
                     builder.fail(place, quoted(key) +
                                             " of 'hands' is no slice, allowed: 0...63, "
                                             "or 0..5 and the like");
                   }
                   about.hands.emplace_back(
                       key, wordOf(builder, node, "what slice " + key + " is", place));
                 });
  }
  if (map.has("sources")) {
    const Node& sources = map.at("sources");
    if (!sources.isList()) {
      map.fail("sources", "'sources' of " + map.what() + " is " + kindOf(sources) +
                              ", allowed: a list of words");
    }
    for (const Node& source : sources) {
      about.sources.push_back(wordOf(builder, source, "a source", map.placeAt("sources")));
    }
  }
  if (map.has("picture")) {
    const YamlMap picture = map.map("picture");
    picture.allow(cameraKeys());
    picture.at("from");
    about.picture = About::Camera{vectorOf(picture, "from"), vectorOf(picture, "at")};
  }
  return about;
}

}  // namespace ergotic::scene
