// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <unordered_map>

#include "ergotic/exception.hpp"
#include "ergotic/scene/scene.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"

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
    each(scene_.lias, "link", &Validator::lia);
    each(scene_.inputs, "input", &Validator::input);
    each(scene_.outputs, "output", &Validator::output);
    each(scene_.ports, "port", &Validator::port);
    exclusive();
    for (const StringInfo& string : scene_.strings) {
      index(Place{1, 1}, "first module of string " + quoted(string.name), string.first,
            scene_.mats.size());
      index(Place{1, 1}, "last module of string " + quoted(string.name),
            string.count < 3 ? -1 : string.first + string.count - 1, scene_.mats.size());
    }
  }

 private:
  [[noreturn]] void fail(Place place, const std::string& what) const {
    throw TextError(scene_.file, place.line, place.column, what);
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
    number(s.place, "gravity" + of, s.gravity.x(), kGravityLimits);
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
    number(m.place, "force" + of, m.force.x(), kForceLimits);
    number(m.place, "velocity" + of, m.velocity.x(), kVelocityLimits);
    for (const double metres : {m.rest.x(), m.rest.y(), m.rest.z(), m.position.x()}) {
      number(m.place, "a coordinate" + of, metres, kMetreLimits);
    }
    if (m.type == MatType::kSlice &&
        !scene_.sections[static_cast<std::size_t>(m.section)].gestural) {
      fail(m.place, "slice " + quoted(m.name) + " is in section " +
                        quoted(scene_.sections[static_cast<std::size_t>(m.section)].name) +
                        ", allowed: sections with rate: gestural");
    }
  }

  void lia(const Lia& l) const {
    const std::string of = " of link " + quoted(l.name);
    index(l.place, "first module" + of, l.a, scene_.mats.size());
    index(l.place, "second module" + of, l.b, scene_.mats.size());
    if (l.a == l.b) {
      fail(l.place, "link " + quoted(l.name) + " joins module " +
                        quoted(scene_.mats[static_cast<std::size_t>(l.a)].name) + " to itself");
    }
    number(l.place, "rest_length" + of, l.rest_length, kMetreLimits);
    if (!l.table.empty()) {
      table(l);
      return;
    }
    for (const LiaField& field : liaFields(l.type)) {
      value(l.place, field.key + of, l.*field.member, field.limits);
    }
    number(l.place, "tipping_point" + of, l.tipping_point, {"m", 0.0});
    value(l.place, "limit_damping" + of, l.limit_damping, kDampingLimits);
  }

  void table(const Lia& l) const {
    const std::string of = " in the table of link " + quoted(l.name);
    if (l.type != LiaType::kPluck && l.type != LiaType::kBow) {
      fail(l.place, "link " + quoted(l.name) + " has a table, allowed: pluck and bow only");
    }
    if (l.table.points.size() < 2) {
      fail(l.place, "one point" + of + ", allowed: at least 2");
    }
    for (std::size_t i = 0; i < l.table.points.size(); ++i) {
      const double before = i == 0 ? -kInfinity : l.table.points[i - 1].first;
      number(l.place, "first number" + of, l.table.points[i].first, {"", before, kInfinity, i > 0});
      number(l.place, "force" + of, l.table.points[i].second, kForceLimits);
    }
  }

  void input(const Input& in) const {
    const std::string of = " of input " + quoted(in.name);
    index(in.place, "module" + of, in.mat, scene_.mats.size());
    number(in.place, "channel" + of, in.channel + 1, kChannelLimits);
    value(in.place, "gain" + of, in.gain, kGainLimits);
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
  }

  void port(const Port& p) const {
    const std::string of = " of port " + quoted(p.name);
    index(p.place, "module" + of, p.mat, scene_.mats.size());
    number(p.place, "slice" + of, p.slice, kSliceLimits);
    number(p.place, "offset" + of, p.offset, kOffsetLimits);
    number(p.place, "position_scale" + of, p.position_scale, kPositionScaleLimits);
    number(p.place, "force_scale" + of, p.force_scale, kForceScaleLimits);
    const Mat& m = scene_.mats[static_cast<std::size_t>(p.mat)];
    if (m.type != MatType::kSlice) {
      fail(p.place, "port " + quoted(p.name) + " is on module " + quoted(m.name) +
                        ", allowed: modules of type slice");
    }
  }

  /// One port for a slice, one port for a module, one position input for a driven module.
  void exclusive() const {
    std::unordered_map<int, const Port*> by_slice;
    std::unordered_map<int, const Port*> by_mat;
    for (const Port& p : scene_.ports) {
      const auto same_slice = by_slice.emplace(p.slice, &p);
      if (!same_slice.second) {
        fail(p.place, "port " + quoted(p.name) + " is on slice " + std::to_string(p.slice) +
                          ", which port " + quoted(same_slice.first->second->name) + " has");
      }
      const auto same_mat = by_mat.emplace(p.mat, &p);
      if (!same_mat.second) {
        fail(p.place, "port " + quoted(p.name) + " is on module " +
                          quoted(scene_.mats[static_cast<std::size_t>(p.mat)].name) +
                          ", which port " + quoted(same_mat.first->second->name) + " has");
      }
    }
    std::unordered_map<int, const Input*> by_driven;
    for (const Input& in : scene_.inputs) {
      if (in.quantity != Quantity::kPosition) {
        continue;
      }
      const auto same = by_driven.emplace(in.mat, &in);
      if (!same.second) {
        fail(in.place, "input " + quoted(in.name) + " sets the position of module " +
                           quoted(scene_.mats[static_cast<std::size_t>(in.mat)].name) +
                           ", which input " + quoted(same.first->second->name) + " does");
      }
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
