// SPDX-License-Identifier: BSD-3-Clause
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "scene/rules/rules.hpp"
#include "scene/text/gesture_csv.hpp"
#include "scene/yaml/point_files.hpp"
#include "scene/yaml/points.hpp"
#include "scene/yaml/yaml_elements.hpp"
#include "scene/yaml/yaml_keys.hpp"

namespace ergotic::scene {
namespace {

bool mayHaveSlices(const Section& section) {
  return section.gestural || section.automatic_rate;
}

/// The section that the hand moves in: a gestural one that is named, that of the module, or the
/// only one.
int sectionOfHand(const SceneBuilder& builder, const YamlMap& map, const Mat& mat) {
  const Scene& scene = builder.scene();
  if (map.has("section")) {
    const int named = sectionOf(builder, map);
    if (!mayHaveSlices(scene.sections[static_cast<std::size_t>(named)])) {
      map.fail("section", map.what() + " is in a section that is not gestural, allowed: sections " +
                              "with rate: gestural or auto");
    }
    return named;
  }
  if (scene.sectionOf(mat).gestural) {
    return mat.section;
  }
  int found = -1;
  std::string names;
  for (std::size_t s = 0; s < scene.sections.size(); ++s) {
    if (scene.sections[s].gestural) {
      names += (found < 0 ? "" : ", ") + scene.sections[s].name;
      found = found == -1 ? static_cast<int>(s) : -2;
    }
  }
  if (found == -1) {
    builder.fail(map.place(), map.what() + " needs a section for its hand and the scene has no " +
                                  "gestural one, allowed: at least one with rate: gestural");
  }
  if (found == -2) {
    builder.fail(map.place(), "missing key 'section' of " + map.what() + ", allowed: " + names);
  }
  return found;
}

/// At rest the hand is where the module is.
Mat targetOf(
    const Scene& scene, const YamlMap& map, const std::string& name, const Mat& mat, int section) {
  const Section& from = scene.sectionOf(mat);
  Mat target;
  target.name = name + ".target";
  target.type = MatType::kSlice;
  target.section = section;
  target.place = map.place();
  const Section& to = scene.sectionOf(target);
  target.rest = to.pose.inverse() * from.pose * mat.rest;
  if (from.geometry == Geometry::kScalar && to.geometry == Geometry::kScalar) {
    target.rest.x() = mat.rest.x();  // they have the axis in common, wherever they are
  }
  for (int k = 0; k < dimensionsOf(to.geometry); ++k) {
    target.position[k] = target.rest[k];
  }
  return target;
}

Lia handOf(const Scene& scene, const YamlMap& map, const std::string& name, int target, int mat) {
  Lia hand;
  hand.name = name + ".hand";
  hand.a = target;
  hand.b = mat;
  hand.place = map.place();
  hand.stiffness = map.value("stiffness", kStiffnessLimits);
  hand.damping = map.value("damping", kDampingLimits, {});
  if (map.has("filter")) {
    hand.filtered = map.choice("filter", {"none", "auto"}) == 1;
    const std::string fault = filterFault(scene, hand);
    if (!fault.empty()) {
      map.fail("filter", fault);
    }
  }
  return hand;
}

PointList knotsIn(const SceneBuilder& builder,
                  const Node& points,
                  const std::string& what,
                  Place place) {
  if (!points.isList() || points.size() == 0 || points.size() > kMaxSceneTablePoints) {
    builder.fail(place, what + " is not a list of points, allowed: 1..." +
                            std::to_string(kMaxSceneTablePoints) + " pairs [s, m]");
  }
  PointList knots;
  Limits times{"s", 0.0};
  for (const Node& point : points) {
    const Place at = placeOf(point, place);
    if (!point.isList() || point.size() != 2) {
      builder.fail(at, "a point of " + what + " is not a pair of numbers");
    }
    const double time = numberOf(builder, point[0], "time of a point of " + what, times, at);
    knots.emplace_back(
        time, numberOf(builder, point[1], "position of a point of " + what, kTargetLimits, at));
    times = {"s", time, kInfinity, true};
  }
  return knots;
}

/// Trajectory of one slice in a gesture file: times, or ticks from the first one on, and m.
struct GestureOfSlice {
  bool in_ticks = false;
  PointList points;
  int value_line = 0;  ///< line of the first row that sets a parameter; 0: there is none
};

void addPoint(const GestureReader& rows, int slice, double first_tick, PointList& points) {
  if (rows.isInTicks()) {
    points.emplace_back(rows.time() - first_tick,
                        rows.positions()[static_cast<std::size_t>(slice)]);
  } else if (rows.slice() == slice) {
    points.emplace_back(rows.time(), rows.target());
  }
}

GestureOfSlice readGesture(const PointFiles::File& file, int slice) {
  std::istringstream in(file.text);
  constexpr auto kSliceCount = static_cast<int>(kSliceLimits.maximum) + 1;
  GestureReader rows(in, file.path, kSliceCount, kTargetLimits);
  if (slice >= rows.slices()) {
    rows.failAtLine("no column of slice " + std::to_string(slice) + ", there are " +
                    std::to_string(rows.slices()) + " slices");
  }
  GestureOfSlice gesture{rows.isInTicks(), {}, 0};
  double first_tick = -1.0;
  while (rows.next()) {
    if (rows.isParameter()) {
      gesture.value_line = gesture.value_line > 0 ? gesture.value_line : rows.place(1).line;
      continue;
    }
    first_tick = first_tick < 0.0 ? rows.time() : first_tick;
    addPoint(rows, slice, first_tick, gesture.points);
    if (gesture.points.size() > kMaxSceneTablePoints) {
      rows.fail("too many points, allowed: " + std::to_string(kMaxSceneTablePoints));
    }
  }
  if (gesture.points.empty()) {
    rows.failAtLine("the gesture has nothing of slice " + std::to_string(slice));
  }
  return gesture;
}

/// `gesture: {file: ..., slice: ..., tick_rate: ...}`
PointList knotsOfFile(SceneBuilder& builder,
                      PointFiles& files,
                      const std::string& name,
                      const YamlMap& spec) {
  spec.allow(gestureKeys());
  const int slice = spec.integer("slice", kSliceLimits);
  const std::string file_name = PointFiles::nameOf(spec);
  const double rate_hz = spec.number("tick_rate", kGesturalRateLimits, 0.0);
  if (files.isSelfContained()) {
    const PointFiles::Appended* appended = files.find(PointFiles::Part::kGestures, name);
    if (appended == nullptr) {
      spec.fail("file", "the gesture of agent " + quoted(name) +
                            " is not among those of the second document");
    }
    return knotsIn(builder, *appended->points, "gesture " + quoted(name), appended->place);
  }
  const PointFiles::File file = files.open(spec);
  GestureOfSlice gesture = readGesture(file, slice);
  if (gesture.in_ticks != spec.has("tick_rate")) {
    builder.fail(spec.place(),
                 quoted(file_name) + (gesture.in_ticks ? " counts ticks" : " is in seconds") +
                     ", allowed: " + (gesture.in_ticks ? "with" : "without") + " 'tick_rate'");
  }
  if (gesture.value_line > 0) {
    builder.warn(spec.place(), "line " + std::to_string(gesture.value_line) + " of " +
                                   quoted(file_name) +
                                   " sets a parameter, which an agent does not: it moves one "
                                   "module, and passes such lines over");
  }
  for (auto& knot : gesture.points) {
    knot.first /= gesture.in_ticks ? rate_hz : 1.0;
  }
  files.keep(PointFiles::Part::kGestures, name, gesture.points);
  return std::move(gesture.points);
}

/// `loop: true` begins anew after the last point, `period` after that many seconds.
double periodOf(const SceneBuilder& builder, const YamlMap& map, double end_s) {
  const bool loops = map.flag("loop", false);
  if (loops && map.has("period")) {
    builder.fail(map.keyPlaceAt("period"),
                 map.what() + " has both 'loop' and 'period', allowed: one of them");
  }
  if (loops && end_s == 0.0) {
    map.fail("loop", map.what() + " has no point after 0 s, allowed: 'loop' with one at least");
  }
  return loops ? end_s : map.number("period", {"s", end_s, kInfinity, end_s == 0.0}, 0.0);
}

void readAgent(SceneBuilder& builder,
               PointFiles& files,
               const std::string& name,
               const YamlMap& map) {
  map.allow(agentKeys());
  if (map.has("points") == map.has("gesture")) {
    builder.fail(map.place(), map.what() + " has " + (map.has("points") ? "both" : "neither") +
                                  " 'points' " + (map.has("points") ? "and" : "nor") +
                                  " 'gesture', allowed: one of them");
  }
  Agent agent;
  agent.name = name;
  agent.place = map.place();
  agent.knots = map.has("points") ? knotsIn(builder, map.at("points"), "'points' of " + map.what(),
                                            map.placeAt("points"))
                                  : knotsOfFile(builder, files, name, map.map("gesture"));
  agent.period_s = periodOf(builder, map, agent.knots.back().first);

  Scene& scene = builder.scene();
  const int mat = pointAt(builder, map.word("mat"), map.placeAt("mat"));
  const Mat& held = scene.mats[static_cast<std::size_t>(mat)];
  Port port;
  port.name = name + ".target";
  port.place = map.place();
  port.mat = builder.add(targetOf(scene, map, name, held, sectionOfHand(builder, map, held)));
  port.axis = readAxis(builder, map, port.mat);
  port.agent = static_cast<int>(scene.agents.size());
  Lia hand = handOf(scene, map, name, port.mat, mat);
  const auto is_scalar = [&scene](int index) {
    return scene.sectionOf(scene.mats[static_cast<std::size_t>(index)]).geometry ==
           Geometry::kScalar;
  };
  if (!is_scalar(port.mat) || !is_scalar(mat)) {
    hand.scheme = Scheme::kAuto;  // the damper of an explicit one is not proven there
  }
  builder.add(std::move(hand));
  scene.ports.push_back(std::move(port));
  scene.agents.push_back(std::move(agent));
}

}  // namespace

void readAgents(SceneBuilder& builder, const YamlMap& top, PointFiles& files) {
  std::size_t points = 0;  // aliases share them in the text, but not in the scene
  forEachElement(builder, top, "agents", "agent", [&](const std::string& name, const YamlMap& map) {
    readAgent(builder, files, name, map);
    points += builder.scene().agents.back().knots.size();
    if (points > kMaxSceneTablePoints) {
      builder.fail(map.place(), "the agents of the scene have more than " +
                                    std::to_string(kMaxSceneTablePoints) + " points");
    }
  });
}

}  // namespace ergotic::scene
