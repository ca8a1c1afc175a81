// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/yaml_truths.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ergotic/scene/grid.hpp"
#include "scene/laws/law.hpp"
#include "scene/text/number.hpp"
#include "scene/yaml/points.hpp"
#include "scene/yaml/yaml_elements.hpp"

namespace ergotic::scene {
namespace {

using What = Truth::What;

constexpr std::size_t kMaxTruths = 1000;
constexpr std::size_t kMaxExpected = 32;
constexpr std::size_t kMaxSourceBytes = 500;
constexpr Limits kSeconds{"s", 0.0, 1000.0, true};
constexpr Limits kLater{"s", 0.0, 1000.0};
constexpr Limits kPartialCount{"", 1.0, 64.0};
constexpr Limits kDivisors{"", 2.0, 16.0};
constexpr Limits kInharmonicity{"", 0.0, 0.1};
constexpr Limits kHandSpeed{"m/s", 0.0, 100.0, true};
constexpr double kTapS = 1e-3;
constexpr double kPluckS = 0.1;

/// Keys beside those of all.
struct Kind {
  What what;
  std::vector<std::string> required;
  std::vector<std::string> optional;
  std::size_t fewest = 1;  ///< numbers that are expected; 0: none, `within` stands for itself
  std::size_t most = 1;
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {What::kPitch, {"of"}, {"near"}},
      {What::kPartials, {"of", "pitch", "to"}, {"inharmonicity"}, 0, 0},
      {What::kRatios, {"of", "pitch"}, {}, 1, kMaxExpected},
      {What::kT60, {"of"}, {"near"}},
      {What::kHarmonicsLeft, {"of", "pitch", "to", "divisible_by"}, {}},
      {What::kContact, {"of", "figure"}, {}},
      {What::kBeats, {"of", "near"}, {}},
      {What::kDoubleDecay, {"of", "near"}, {}, 2, 2},
      {What::kForce, {"of", "figure"}, {"speed", "travel"}},
      {What::kCentroid, {"of", "times"}, {}},
      {What::kGlide, {"of", "near", "times"}, {}},
      {What::kSilence, {"of"}, {}},
      {What::kEnergy, {}, {}},
  };
  return all;
}

/// Index of what has that name.
template <class Item>
int named(const YamlMap& map, const std::vector<Item>& list, const std::string& kind) {
  const std::string name = map.word("of");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].name == name) {
      return static_cast<int>(i);
    }
    names.push_back(list[i].name);
  }
  map.fail("of", "no " + kind + " has the name " + quoted(name) + suggestion(name, names));
}

class TruthReader {
 public:
  TruthReader(const SceneBuilder& builder, const YamlMap& map) : builder_(builder), map_(map) {}

  Truth run() {
    std::vector<std::string> words;
    for (const Kind& kind : kinds()) {
      words.emplace_back(wordOf(kind.what));
    }
    const Kind& kind = kinds()[map_.choice("what", words)];
    truth_.what = kind.what;
    truth_.place = map_.place();
    allowKeys(kind);
    truth_.source = map_.has("source") ? map_.word("source") : "";
    readObject();
    readPlay();
    readFigures();
    readExpected(kind);
    readTolerance(kind);
    return std::move(truth_);
  }

 private:
  void allowKeys(const Kind& kind) const {
    std::vector<std::string> keys = {"what", "play", "source", "least", "most"};
    if (kind.most > 0) {
      keys.emplace_back("expect");
    }
    keys.emplace_back("within");
    if (kind.what != What::kForce) {
      keys.insert(keys.end(), {"after", "seconds"});
    }
    keys.insert(keys.end(), kind.required.begin(), kind.required.end());
    keys.insert(keys.end(), kind.optional.begin(), kind.optional.end());
    map_.allow(keys);
    for (const std::string& key : kind.required) {
      map_.at(key);
    }
    if (map_.has("source") && map_.word("source").size() > kMaxSourceBytes) {
      map_.fail("source", "'source' of " + map_.what() + " is too long, allowed: at most " +
                              std::to_string(kMaxSourceBytes) + " bytes");
    }
  }

  void readObject() {
    const Scene& scene = builder_.scene();
    if (truth_.what == What::kEnergy) {
      return;
    }
    if (truth_.what == What::kContact) {
      truth_.figure = map_.choice("figure", {"duration", "peak"}) == 0 ? Truth::Figure::kDuration
                                                                       : Truth::Figure::kPeak;
      truth_.lia = builder_.lia(map_.word("of"), map_.placeAt("of"));
      requireContact(scene.lias[static_cast<std::size_t>(truth_.lia)]);
      return;
    }
    if (truth_.what == What::kForce) {
      constexpr Truth::Figure kFigures[] = {Truth::Figure::kRelease, Truth::Figure::kStiffness,
                                            Truth::Figure::kWork, Truth::Figure::kPeak};
      truth_.figure = kFigures[map_.choice("figure", {"release", "stiffness", "work", "peak"})];
      truth_.port = named(map_, scene.ports, "port");
      if (scene.ports[static_cast<std::size_t>(truth_.port)].slice < 0) {
        map_.fail("of", "port " + quoted(map_.word("of")) +
                            " has no slice that a hand could move, allowed: one with 'slice'");
      }
      return;
    }
    truth_.output = named(map_, scene.outputs, "output");
  }

  /// Requires a contact of which duration and force can be measured.
  void requireContact(const Lia& lia) const {
    const Scene& scene = builder_.scene();
    const auto isScalar = [&](int mat) {
      return scene.sectionOf(scene.mats[static_cast<std::size_t>(mat)]).geometry ==
             Geometry::kScalar;
    };
    if (lawOf(lia.type).kind != Law::Kind::kGap || !isScalar(lia.a) || !isScalar(lia.b)) {
      map_.fail("of", "link " + quoted(lia.name.str()) +
                          " is not a contact between modules of scalar sections: only of those "
                          "duration and force of a contact are measured");
    }
    const auto linksOn = [&](int mat) {
      return std::count_if(scene.lias.begin(), scene.lias.end(),
                           [mat](const Lia& other) { return other.a == mat || other.b == mat; });
    };
    if (truth_.figure == Truth::Figure::kPeak && linksOn(lia.a) > 1 && linksOn(lia.b) > 1) {
      map_.fail("of", "both ends of link " + quoted(lia.name.str()) +
                          " have other links: its force cannot be told from theirs");
    }
  }

  void readPlay() {
    if (!map_.has("play")) {
      return;
    }
    if (truth_.what == What::kForce) {
      builder_.fail(map_.keyPlaceAt("play"), map_.what() + " is played by its own hand");
    }
    const YamlMap play = map_.map("play");
    if (play.has("gesture")) {
      play.allow({"gesture"});
      truth_.play = Truth::Play::kGesture;
      truth_.gesture = play.word("gesture");
      return;
    }
    const bool is_tap = play.has("tap");
    if (!is_tap && !play.has("pluck")) {
      builder_.fail(
          map_.keyPlaceAt("play"),
          play.what() + " has neither 'tap', 'pluck' nor 'gesture', allowed: one of them");
    }
    const std::string how = is_tap ? "tap" : "pluck";
    play.allow({how, "at", "time", "axis"});
    truth_.play = is_tap ? Truth::Play::kTap : Truth::Play::kPluck;
    truth_.force = play.number(how, kForceLimits);
    if (truth_.force == 0.0) {
      play.fail(how, "a force of 0 N plays nothing");
    }
    readStruck(play);
    truth_.time_s = play.number("time", kSeconds, is_tap ? kTapS : kPluckS);
  }

  /// A module, a point, or a place on a grid, of which no point is made.
  void readStruck(const YamlMap& play) {
    const std::string text = play.word("at");
    const Place place = play.placeAt("at");
    const Scene& scene = builder_.scene();
    if (text.find('@') == std::string::npos) {
      truth_.struck = {{builder_.mat(text, place), 1.0}};
    } else {
      const NamedPlace at = namedPlace(builder_, text, place);
      const GridPlace around =
          placeOn(scene.grids[static_cast<std::size_t>(at.grid)], at.along, at.across);
      for (std::size_t i = 0; i < static_cast<std::size_t>(around.count); ++i) {
        if (around.weights[i] > 0.0) {
          truth_.struck.emplace_back(around.mats[i], around.weights[i]);
        }
      }
    }
    truth_.axis = readAxis(builder_, play, truth_.struck.front().first);
    for (const auto& [mat, weight] : truth_.struck) {
      const Mat& one = scene.mats[static_cast<std::size_t>(mat)];
      if (one.type == MatType::kMass || one.type == MatType::kCell || one.type == MatType::kPoint) {
        return;
      }
    }
    play.fail("at",
              "nothing at " + quoted(text) + " moves by a force, allowed: a mass, cell or point");
  }

  void readFigures() {
    truth_.near_hz = map_.number(map_.has("pitch") ? "pitch" : "near", kFrequencyLimits, 0.0);
    truth_.inharmonicity = map_.number("inharmonicity", kInharmonicity, 0.0);
    truth_.partials = map_.has("to") ? map_.integer("to", kPartialCount) : 0;
    truth_.divisor = map_.has("divisible_by") ? map_.integer("divisible_by", kDivisors) : 0;
    if (truth_.divisor > 0 && truth_.partials < truth_.divisor) {
      map_.fail("to", "'to' of " + map_.what() + " = " + std::to_string(truth_.partials) +
                          ": none of these is left, allowed: at least 'divisible_by'");
    }
    truth_.speed = map_.number("speed", kHandSpeed, 0.01);
    truth_.travel = map_.number("travel", kOffsetLimits, 0.02);
    if (truth_.travel == 0.0) {
      map_.fail("travel", "'travel' of " + map_.what() + " = 0 m: nothing is felt");
    }
    truth_.after_s = map_.number("after", kLater, truth_.what == What::kContact ? 0.0 : 0.02);
    truth_.seconds = map_.number("seconds", kSeconds, 0.0);
    if (map_.has("times")) {
      const bool is_centroid = truth_.what == What::kCentroid;
      truth_.times_s = map_.numbers("times", is_centroid ? 1 : 2, 2, kLater);
      if (truth_.times_s.size() > 1 && !(truth_.times_s[1] > truth_.times_s[0])) {
        map_.fail("times", "'times' of " + map_.what() + " do not rise");
      }
    }
  }

  void readExpected(const Kind& kind) {
    const Limits limits{unitOf(truth_)};
    if (map_.has("expect")) {
      truth_.expected = map_.numbers("expect", kind.fewest, kind.most, limits);
      for (std::size_t i = 0; i < truth_.expected.size(); ++i) {
        if (!(truth_.expected[i] > 0.0)) {
          builder_.fail(map_.placeAt("expect", i),
                        outOfRange("'expect' of " + map_.what(), truth_.expected[i],
                                   {unitOf(truth_), 0.0, kInfinity, true}));
        }
      }
    }
    truth_.least = map_.number("least", limits, truth_.least);
    truth_.most = map_.number("most", limits, truth_.most);
    const bool has_bounds = map_.has("least") || map_.has("most");
    if (has_bounds && (map_.has("within") || kind.fewest != 1)) {
      builder_.fail(map_.keyPlaceAt(map_.has("least") ? "least" : "most"),
                    map_.what() +
                        " has bounds, allowed: 'expect' and 'within', or of one number "
                        "'least', 'most' or both");
    }
    if (!has_bounds && truth_.expected.empty() && kind.most > 0) {
      builder_.fail(map_.place(), map_.what() +
                                      " says nothing, allowed: 'expect' and 'within', or 'least', "
                                      "'most' or both");
    }
    if (truth_.what == What::kPitch && truth_.near_hz == 0.0) {
      if (truth_.expected.empty()) {
        builder_.fail(map_.place(), map_.what() + " has bounds alone, allowed: with 'near'");
      }
      truth_.near_hz = truth_.expected.front();
    }
    if (truth_.least > truth_.most) {
      map_.fail("least", "'least' of " + map_.what() + " is more than 'most'");
    }
  }

  /// `1 cent`, `2 %`, `3 dB`, or in the unit of what is measured.
  void readTolerance(const Kind& kind) {
    if (!map_.has("within")) {
      if (!truth_.expected.empty() || kind.most == 0) {
        map_.at("within");  // says that it is missing
      }
      return;
    }
    std::string text = map_.word("within");
    const auto ends = [&text](const std::string& end) {
      const bool fits =
          text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
      text = fits ? trimmed(text.substr(0, text.size() - end.size())) : text;
      return fits;
    };
    truth_.tolerance = ends("cents") || ends("cent") ? Truth::Tolerance::kCents
                       : ends("%")                   ? Truth::Tolerance::kRelative
                       : ends("dB")                  ? Truth::Tolerance::kDecibels
                                                     : Truth::Tolerance::kAbsolute;
    const char* const unit = truth_.tolerance == Truth::Tolerance::kAbsolute ? unitOf(truth_) : "";
    truth_.within = numberIn(builder_, text, "'within' of " + map_.what(),
                             {unit, 0.0, kInfinity, true}, map_.placeAt("within"));
    truth_.within /= truth_.tolerance == Truth::Tolerance::kRelative ? 100.0 : 1.0;
    if (truth_.what == What::kPartials && truth_.tolerance == Truth::Tolerance::kAbsolute) {
      map_.fail("within", "'within' of " + map_.what() + " has no unit, allowed: cents, or %");
    }
  }

  const SceneBuilder& builder_;
  const YamlMap& map_;
  Truth truth_;
};

}  // namespace

std::vector<Truth> truthsOf(const SceneBuilder& builder, const YamlMap& top) {
  std::vector<Truth> truths;
  if (!top.has("truths")) {
    return truths;
  }
  const Node& list = top.at("truths");
  if (!list.isList() || list.size() > kMaxTruths) {
    top.fail("truths", "'truths' is " + kindOf(list) + ", allowed: a list of at most " +
                           std::to_string(kMaxTruths));
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    const YamlMap map(builder, list[i], "truth " + std::to_string(i + 1), top.placeAt("truths", i));
    truths.push_back(TruthReader(builder, map).run());
  }
  return truths;
}

}  // namespace ergotic::scene
