// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "ergotic/exception.hpp"
#include "ergotic/scene/coarse_string.hpp"
#include "ergotic/scene/origin.hpp"
#include "ergotic/scene/scene.hpp"
#include "ergotic/scene/table.hpp"
#include "scene/laws/law.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"
#include "scene/rules/rules.hpp"

namespace ergotic::scene {
namespace {

/// The rules, one function for each kind of element.
class Validator {
 public:
  explicit Validator(const Scene& scene) : scene_(scene), si_(scene.time_unit_s == 1.0) {}

  void check() const {
    if (!(std::isfinite(scene_.time_unit_s) && scene_.time_unit_s > 0.0)) {
      fail(Place{1, 1}, outOfRange("time unit", scene_.time_unit_s, {"s", 0.0, kInfinity, true}));
    }
    number(Place{1, 1}, "gestural_rate", scene_.gestural_rate_hz, kGesturalRateLimits);
    each(scene_.parameters, "parameter", &Validator::parameter);
    each(scene_.audio_parameters, "audio parameter", &Validator::audioParameter);
    each(scene_.sections, "section", &Validator::section);
    each(scene_.mats, "module", &Validator::mat);
    std::for_each(scene_.grids.begin(), scene_.grids.end(), [this](const Grid& g) { grid(g); });
    for (const Connection& c : scene_.connections) {
      index(c.place, "point of a connection", c.mat, scene_.mats.size());
      connection(c, scene_.mats[static_cast<std::size_t>(c.mat)]);
    }
    each(scene_.lias, "link", &Validator::lia);
    each(scene_.inputs, "input", &Validator::input);
    each(scene_.outputs, "output", &Validator::output);
    each(scene_.agents, "agent", &Validator::agent);
    each(scene_.ports, "port", &Validator::port);
    for (const auto faultOf : {misplacedPoint, movedTwice, wrongBend, unpressed, wrongTank}) {
      if (const std::optional<Fault> fault = faultOf(scene_)) {
        fail(fault->place, fault->text);
      }
    }
    std::for_each(scene_.strings.begin(), scene_.strings.end(),
                  [this](const auto& s) { string(s); });
  }

 private:
  [[noreturn]] void fail(Place place, const std::string& what) const {
    throw errorAt(scene_, place, what);
  }

  void number(Place place, const std::string& what, double value, const Limits& limits) const {
    if (!limits.hold(value)) {
      fail(place, outOfRange(what, value, limits, si_));
    }
  }

  /// A number that a parameter can change must be legal at both ends of the parameter's range.
  void value(Place place, const std::string& what, const Value& v, const Limits& limits) const {
    if (v.audio >= 0) {
      index(place, "audio parameter of " + what, v.audio, scene_.audio_parameters.size());
      return;
    }
    if (v.parameter < 0) {
      number(place, what, v.factor, limits);
      return;
    }
    index(place, "parameter of " + what, v.parameter, scene_.parameters.size());
    const Parameter& p = scene_.parameters[static_cast<std::size_t>(v.parameter)];
    number(place, what, v.factor * p.minimum, limits);
    number(place, what, v.factor * p.maximum, limits);
  }

  void index(Place place, const std::string& what, int i, std::size_t count) const {
    if (i < 0 || static_cast<std::size_t>(i) >= count) {
      fail(place, what + " = " + std::to_string(i) + " does not exist, there are " +
                      std::to_string(count));
    }
  }

  /// Names of one kind are unique and not empty; then the rules of each.
  template <class T>
  void each(const std::vector<T>& list,
            const char* kind,
            void (Validator::*rules)(const T&) const) const {
    NameTable names;
    names.reserve(list.size());
    for (const T& item : list) {
      if (item.name.empty()) {
        fail(item.place, std::string("a ") + kind + " has no name");
      }
      if (names.add(item.name, 0) >= 0) {
        fail(item.place, std::string(kind) + " " + quoted(item.name) + " is defined twice");
      }
      (this->*rules)(item);
    }
  }

  void parameter(const Parameter& p) const {
    const std::string of = " of parameter " + quoted(p.name);
    number(p.place, "minimum" + of, p.minimum, {});
    number(p.place, "maximum" + of, p.maximum, {"", p.minimum});
    number(p.place, "value" + of, p.value, {"", p.minimum, p.maximum});
  }

  void audioParameter(const AudioParameter& p) const {
    number(p.place, "channel of audio parameter " + quoted(p.name), p.channel + 1, kChannelLimits);
  }

  void section(const Section& s) const {
    const std::string of = " of section " + quoted(s.name);
    for (const double acceleration : s.gravity) {
      number(s.place, "gravity" + of, acceleration, kGravityLimits);
    }
    value(s.place, "medium" + of, s.medium, kDampingLimits);
    if (s.sleep_energy != 0.0) {
      number(s.place, "sleep" + of, s.sleep_energy, kSleepLimits);
    }
    if (s.modes != kNoModes && s.geometry != Geometry::kScalar) {
      fail(s.place, "modes" + of + " are of no use there, allowed: in sections of geometry scalar");
    }
    if (s.starts_in_balance && s.geometry != Geometry::kScalar) {
      fail(s.place, "section " + quoted(s.name) +
                        " starts in equilibrium in a line, plane or space, allowed: in sections of "
                        "geometry scalar");
    }
    if (s.gestural && s.automatic_rate) {
      fail(s.place, "rate" + of + " is both gestural and auto, allowed: one of them");
    }
    if (!s.gestural) {
      number(s.place, "divisor" + of, s.divisor, kDivisorLimits);
    }
    if (!s.pose.matrix().allFinite()) {
      fail(s.place, "pose" + of + " is not finite");
    }
  }

  void mat(const Mat& m) const {
    const std::string of = " of module " + quoted(m.name);
    index(m.place, "section" + of, m.section, scene_.sections.size());
    if (m.type == MatType::kMass || m.type == MatType::kCell) {
      value(m.place, "mass" + of, m.mass, kMassLimits);
    }
    if (m.type == MatType::kCell) {
      value(m.place, "stiffness" + of, m.stiffness, kStiffnessLimits);
      value(m.place, "damping" + of, m.damping, kDampingLimits);
    }
    for (int i = 0; i < 3; ++i) {
      number(m.place, "force" + of, m.push->force[i], kForceLimits);
      number(m.place, "velocity" + of, m.push->velocity[i], kVelocityLimits);
      number(m.place, "a coordinate" + of, m.rest[i], kMetreLimits);
      number(m.place, "a coordinate" + of, m.position[i], kMetreLimits);
    }
    if (m.type == MatType::kSlice || m.type == MatType::kDriven) {
      moved(m);
    }
  }

  /// Something outside moves it; what is asleep follows nothing.
  void moved(const Mat& m) const {
    const bool is_slice = m.type == MatType::kSlice;
    const Section& section = scene_.sectionOf(m);
    const std::string is = (is_slice ? "slice " : "driven module ") + quoted(m.name) +
                           " is in section " + quoted(section.name);
    if (is_slice && !section.gestural && !section.automatic_rate) {
      fail(m.place, is + ", allowed: sections with rate: gestural or auto");
    }
    if (section.sleep_energy > 0.0) {
      fail(m.place, is + ", which may sleep, allowed: sections without 'sleep'");
    }
  }

  void grid(const Grid& g) const {
    const std::string what = "string or mesh " + quoted(g.name);
    const auto modules = static_cast<std::size_t>(std::max(g.rows, 0)) *
                         static_cast<std::size_t>(std::max(g.columns, 0));
    index({1, 1}, "first module of " + what, g.first, scene_.mats.size());
    const Mat& first = scene_.mats[static_cast<std::size_t>(g.first)];
    number(first.place, "columns of " + what, g.columns, {"", 2.0});
    number(first.place, "rows of " + what, g.rows, {"", 1.0});
    const std::size_t end = static_cast<std::size_t>(g.first) + modules;
    if (end > scene_.mats.size()) {
      fail(first.place, what + " ends at module " + std::to_string(end) + ", there are " +
                            std::to_string(scene_.mats.size()));
    }
    for (auto i = static_cast<std::size_t>(g.first); i < end; ++i) {
      const Mat& m = scene_.mats[i];
      if (m.section != first.section || m.type == MatType::kPoint) {
        fail(m.place, "module " + quoted(m.name) + " of " + what +
                          " is a point or in another section, allowed: modules of one section");
      }
    }
  }

  void connection(const Connection& c, const Mat& m) const {
    const std::string of = " of point " + quoted(m.name);
    if (m.type != MatType::kPoint) {
      fail(c.place, "module " + quoted(m.name) + " has a connection, allowed: points");
    }
    index(c.place, "string or mesh" + of, c.grid, scene_.grids.size());
    const Grid& g = scene_.grids[static_cast<std::size_t>(c.grid)];
    if (scene_.mats[static_cast<std::size_t>(g.first)].section != m.section) {
      fail(c.place,
           "section" + of + " is another than that of " + quoted(g.name) + ", allowed: the same");
    }
    way(c.place, " along" + of, c.along);
    way(c.place, " across" + of, c.across);
    if (c.speed != 0.0) {
      number(c.place, "speed" + of, c.speed, kPointSpeedLimits);
    }
    number(c.place, "power" + of, c.power, kPointPowerLimits);
    if (g.rows == 1 && c.across.guide != -1) {
      fail(c.place, "guide across" + of + ", allowed: none, " + quoted(g.name) + " has one row");
    }
  }

  void way(Place place, const std::string& of, const Connection::Way& way) const {
    number(place, "lower end of the range" + of, way.minimum, kFractionLimits);
    number(place, "upper end of the range" + of, way.maximum, {"", way.minimum, 1.0});
    value(place, "place" + of, way.at, {"", way.minimum, way.maximum});
    if (way.guide == -1) {
      return;
    }
    index(place, "guide" + of, way.guide, scene_.mats.size());
    number(place, "scale of the guide" + of, way.scale, kGuideScaleLimits);
    const Mat& guide = scene_.mats[static_cast<std::size_t>(way.guide)];
    if (guide.type == MatType::kPoint) {
      fail(place, "guide" + of + " is a point, allowed: modules of any other type");
    }
    const int axes = dimensionsOf(scene_.sectionOf(guide).geometry);
    index(place, "axis of the guide" + of, way.axis, static_cast<std::size_t>(axes));
  }

  void string(const StringInfo& s) const {
    const std::string of = " of string " + quoted(s.name);
    index({1, 1}, "first module" + of, s.first, scene_.mats.size());
    index({1, 1}, "last module" + of, s.count < 3 ? -1 : s.first + s.count - 1, scene_.mats.size());
    const Place place = scene_.mats[static_cast<std::size_t>(s.first)].place;
    if (s.frequency_hz != 0.0) {
      number(place, "frequency" + of, s.frequency_hz, kFrequencyLimits);
    }
    if (s.coarse) {
      number(place, "masses" + of, s.count - 2, {"", kFewestCoarseMasses});
    }
    const int links = s.coarse ? coarseLinks(s.count - 2) : s.count - 1;
    index(place, "first link" + of, s.first_lia, scene_.lias.size());
    index(place, "last link" + of, s.first_lia + links - 1, scene_.lias.size());
  }

  void lia(const Lia& l) const {
    const std::string of = " of link " + quoted(l.name);
    index(l.place, "first module" + of, l.a, scene_.mats.size());
    index(l.place, "second module" + of, l.b, scene_.mats.size());
    if (l.a == l.b) {
      fail(l.place, "link " + quoted(l.name) + " joins module " +
                        quoted(scene_.mats[static_cast<std::size_t>(l.a)].name) + " to itself");
    }
    number(l.place, "rest_length" + of, l.rest_length, restLengthLimits(scene_, l));
    laws(l, of);
    if (const std::string fault = liaFault(scene_, l); !fault.empty()) {
      fail(l.place, fault);
    }
  }

  void laws(const Lia& l, const std::string& of) const {
    const Law& law = lawOf(l.type);
    const bool has_table = !l.law->table.empty();
    const bool has_viscous = !l.law->viscous_table.empty();
    if ((has_table && law.tables == Law::Tables::kNone) ||
        (has_viscous && law.tables != Law::Tables::kParts)) {
      fail(l.place, "link " + quoted(l.name) + " has a table, allowed: pluck, bow and table only");
    }
    if (law.tables == Law::Tables::kOne && !has_table) {
      fail(l.place, "link " + quoted(l.name) + " has no table, allowed: one");
    }
    if (law.tables == Law::Tables::kParts && !has_table && !has_viscous) {
      fail(l.place, "link " + quoted(l.name) + " has no table, allowed: elastic, viscous or both");
    }
    table(l, l.law->table);
    table(l, l.law->viscous_table);
    for (const LiaField& field : law.fields) {
      value(l.place, field.key + of, memberOf(l, field.member), field.limits);
    }
    number(l.place, "tipping_point" + of, l.law->tipping_point, {"m", 0.0});
    value(l.place, "limit_damping" + of, l.law->limit_damping, kDampingLimits);
    if (law.has_release) {
      number(l.place, "release" + of, l.law->release, releaseLimits(scene_, l));
    }
  }

  void table(const Lia& l, const Table& t) const {
    const std::string of = " in the table of link " + quoted(l.name);
    if (t.empty()) {
      return;
    }
    if (t.points.size() < 2) {
      fail(l.place, "one point" + of + ", allowed: at least 2");
    }
    for (std::size_t i = 0; i < t.points.size(); ++i) {
      const double before = i == 0 ? -kInfinity : t.points[i - 1].first;
      number(l.place, "first number" + of, t.points[i].first, {"", before, kInfinity, i > 0});
      number(l.place, "force" + of, t.points[i].second, kForceLimits);
    }
    if (!isFinite(interpolate(t))) {
      fail(l.place, "points" + of + " are too close to each other, allowed: finite slopes");
    }
  }

  void input(const Input& in) const {
    const std::string of = " of input " + quoted(in.name);
    index(in.place, "module" + of, in.mat, scene_.mats.size());
    number(in.place, "channel" + of, in.channel + 1, kChannelLimits);
    value(in.place, "gain" + of, in.gain, kGainLimits);
    axis(in.place, of, in.axis, in.mat);
    const bool driven = scene_.mats[static_cast<std::size_t>(in.mat)].type == MatType::kDriven;
    if (in.quantity == Quantity::kVelocity) {
      fail(in.place, "quantity" + of + " is velocity, allowed: position, force");
    }
    if (in.quantity == Quantity::kPosition && !driven) {
      fail(in.place, "input " + quoted(in.name) + " sets the position of module " +
                         quoted(scene_.mats[static_cast<std::size_t>(in.mat)].name) +
                         ", allowed: modules of type driven");
    }
  }

  void output(const Output& out) const {
    const std::string of = " of output " + quoted(out.name);
    index(out.place, "module" + of, out.point.mat, scene_.mats.size());
    if (out.point.next != -1) {
      index(out.place, "next module" + of, out.point.next, scene_.mats.size());
    }
    number(out.place, "fraction" + of, out.point.fraction, kFractionLimits);
    number(out.place, "channel" + of, out.channel + 1, kChannelLimits);
    value(out.place, "gain" + of, out.gain, kGainLimits);
    if (out.radiation_hz != 0.0) {
      number(out.place, "radiation" + of, out.radiation_hz, kRadiationLimits);
    }
    axis(out.place, of, out.axis, out.point.mat);
  }

  void axis(Place place, const std::string& of, int coordinate, int mat) const {
    const Section& section = scene_.sectionOf(scene_.mats[static_cast<std::size_t>(mat)]);
    number(place, "axis" + of, coordinate, {"", 0.0, dimensionsOf(section.geometry) - 1.0});
  }

  void agent(const Agent& a) const {
    const std::string of = " of agent " + quoted(a.name);
    if (a.knots.empty()) {
      fail(a.place, "agent " + quoted(a.name) + " has no points, allowed: at least 1");
    }
    Limits times{"s", 0.0};
    for (const auto& [time, position] : a.knots) {
      number(a.place, "time" + of, time, times);
      number(a.place, "position" + of, position, kTargetLimits);
      times = {"s", time, kInfinity, true};
    }
    if (a.period_s != 0.0) {
      number(a.place, "period" + of, a.period_s, {"s", a.knots.back().first});
    }
  }

  void port(const Port& p) const {
    const std::string of = " of port " + quoted(p.name);
    if (p.agent != -1) {
      index(p.place, "agent" + of, p.agent, scene_.agents.size());
    }
    if (p.filter != -1) {
      index(p.place, "filter" + of, p.filter, scene_.mats.size());
    }
    if (p.agent != -1 && p.slice != -1) {
      fail(p.place, "port " + quoted(p.name) + " has a slice and an agent, allowed: one of them");
    }
    index(p.place, "module" + of, p.mat, scene_.mats.size());
    if (p.slice != -1) {
      number(p.place, "slice" + of, p.slice, kSliceLimits);
    }
    axis(p.place, of, p.axis, p.mat);
    number(p.place, "offset" + of, p.offset, kOffsetLimits);
    number(p.place, "position_scale" + of, p.position_scale, kPositionScaleLimits);
    number(p.place, "force_scale" + of, p.force_scale, kForceScaleLimits);
    const Mat& m = scene_.mats[static_cast<std::size_t>(p.mat)];
    if (m.type != MatType::kSlice) {
      fail(p.place, "port " + quoted(p.name) + " is on module " + quoted(m.name) +
                        ", allowed: modules of type slice");
    }
  }

  const Scene& scene_;
  bool si_;  // units are worth telling
};

}  // namespace

void validate(const Scene& scene) {
  Validator(scene).check();
}

}  // namespace ergotic::scene
