// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/advice/reach.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "advice/acting.hpp"
#include "advice/statics.hpp"
#include "at.hpp"
#include "ergotic/scene/origin.hpp"
#include "physics/note.hpp"
#include "scene/laws/law.hpp"
#include "scene/names.hpp"

namespace ergotic::physics {
namespace {

using scene::Geometry;
using scene::Law;
using scene::LiaType;
using scene::Port;
using scene::Scene;

constexpr double kStill = 1e-12;  // of what an end goes: its link is not drawn

/// Ends together, or as one of them goes alone.
Separation minus(bool is_scalar, const Separation& a, const Separation& b) {
  return {is_scalar, a.apart - b.apart, a.way - b.way};
}

bool touches(const Span& span) {
  return span.from < 0.0 && span.to > 0.0;
}

/// The span that is reached first in this direction, from outside of all; nullptr: none.
const Span* nextOf(const std::vector<Span>& spans, double direction) {
  if (direction > 0.0) {
    const auto found =
        std::find_if(spans.begin(), spans.end(), [](const Span& s) { return s.from >= 0.0; });
    return found == spans.end() ? nullptr : &*found;
  }
  const auto found =
      std::find_if(spans.rbegin(), spans.rend(), [](const Span& s) { return s.to <= 0.0; });
  return found == spans.rend() ? nullptr : &*found;
}

class Finder {
 public:
  Finder(const Scene& scene, bool pushes)
      : scene_(scene),
        network_(scene),
        statics_(network_),
        pushes_(pushes),
        is_in_hands_(scene.mats.size(), 0) {
    for (const Port& port : scene.ports) {
      const std::vector<unsigned char> moved = statics_.movedBy(port);
      for (std::size_t m = 0; m < moved.size(); ++m) {
        is_in_hands_[m] |= moved[m];
      }
    }
    for (int l = 0; l < static_cast<int>(scene.lias.size()); ++l) {
      const scene::Lia& lia = scene.lias[at(l)];
      const Law& law = scene::lawOf(lia.type);
      if (!law.has_linear_part && law.kind != Law::Kind::kFriction) {
        letting_go_.push_back(l);
      }
      const scene::Name& presser = lia.law->pressed_by;
      if (!presser.empty()) {
        pressed_[presser.str()].push_back(l);
      }
    }
  }

  PortReach of(int p) {
    const Port& port = scene_.ports[at(p)];
    PortReach found;
    found.port = p;
    for (const int mat : statics_.followersOf(port)) {
      found.carries.push_back(nameOf(mat));
    }
    const std::vector<unsigned char> moved = statics_.movedBy(port);
    for (int l = 0; l < static_cast<int>(scene_.lias.size()); ++l) {
      const scene::Lia& lia = scene_.lias[at(l)];
      if (lia.bend < 0 && (moved[at(lia.a)] != 0 || moved[at(lia.b)] != 0)) {
        addLink(port, l, found);
      }
    }
    const auto order = [](const Meeting& m) {
      return std::make_pair(m.touches ? 0 : m.is_missed ? 2 : 1, std::abs(m.at_m));
    };
    std::stable_sort(found.meetings.begin(), found.meetings.end(),
                     [&order](const Meeting& a, const Meeting& b) { return order(a) < order(b); });
    addGuides(port, found);
    return found;
  }

  int untold() const { return statics_.untold(); }

 private:
  std::string nameOf(int mat) const { return scene_.mats[at(mat)].name.str(); }
  const scene::Section& sectionOf(int mat) const { return scene_.sectionOf(scene_.mats[at(mat)]); }

  /// An end of a link in the frame where that acts: that of the end with fewer coordinates.
  Separation endOf(int mat, const Port& port, const scene::Section& frame, bool is_seen) {
    Separation end{true, statics_.placeOf(mat), statics_.wayOf(mat, port)};
    if (is_seen) {
      const Eigen::Isometry3d seen = frame.pose.inverse() * sectionOf(mat).pose;
      end.apart = seen * end.apart;
      end.way = seen.linear() * end.way;
    }
    const int dimensions = scene::dimensionsOf(frame.geometry);
    end.apart.tail(3 - dimensions).setZero();
    end.way.tail(3 - dimensions).setZero();
    return end;
  }

  /// Separations over the position of the hand: of each end, then between both.
  struct Ends {
    Separation a;
    Separation b;
    Separation both;
    /// True if the link is not drawn by any motion of the hand.
    bool areStill() const {
      return !(both.way.norm() > kStill * std::max(a.way.norm(), b.way.norm()));
    }
  };

  Ends endsOf(const scene::Lia& lia, const Port& port) {
    const scene::Section& a = sectionOf(lia.a);
    const scene::Section& b = sectionOf(lia.b);
    const bool is_scalar = a.geometry == Geometry::kScalar || b.geometry == Geometry::kScalar;
    const bool is_plain = &a == &b || (a.geometry == b.geometry && is_scalar);
    const scene::Section& frame = b.geometry < a.geometry ? b : a;
    Ends ends{endOf(lia.a, port, frame, !is_plain && &frame != &a),
              endOf(lia.b, port, frame, !is_plain && &frame != &b),
              {}};
    ends.both = minus(is_scalar, ends.a, ends.b);
    return ends;
  }

  void addLink(const Port& port, int l, PortReach& found) {
    const scene::Lia& lia = scene_.lias[at(l)];
    const Ends ends = endsOf(lia, port);
    if (ends.areStill()) {
      return;
    }
    const Law& law = scene::lawOf(lia.type);
    const bool a_leads = ends.a.way.norm() > ends.b.way.norm();
    if (network_.links[at(l)].at_rest != 0.0) {
      addHold(port, l, a_leads, ends, found);
      return;
    }
    const int body = statics_.bodyOf(lia.a);
    const bool is_inside = body >= 0 && body == statics_.bodyOf(lia.b);
    const bool is_nothing = law.kind == Law::Kind::kLinear && scene_.valueOf(lia.damping) == 0.0;
    if (law.has_linear_part && (is_inside || is_nothing)) {
      return;
    }
    Meeting meeting;
    meeting.thing = nameOf(a_leads ? lia.b : lia.a);
    meeting.by = nameOf(a_leads ? lia.a : lia.b);
    meeting.link = lia.name.str();
    meeting.law = law.name;
    for (const int other : pressedBy(lia)) {
      const scene::Lia& rub = scene_.lias[at(other)];
      meeting.presses.push_back({rub.name.str(), nameOf(rub.a), nameOf(rub.b)});
    }
    const std::vector<Span> spans = spansOf(port, lia, ends.both, meeting);
    if (!ends.both.is_scalar && spans.empty() && law.kind == Law::Kind::kGap) {
      meeting.missed_by_m = nearestOf(ends.both) - scene_.valueOf(lia.law->width);
    }
    add(port, l, a_leads, spans, std::move(meeting), found);
  }

  const std::vector<int>& pressedBy(const scene::Lia& lia) const {
    static const std::vector<int> kNone;
    const auto pressed = pressed_.find(lia.name.str());
    return pressed == pressed_.end() ? kNone : pressed->second;
  }

  /// Spans of the hand in which a link acts; those of a friction where its contact presses.
  std::vector<Span> spansOf(const Port& port,
                            const scene::Lia& lia,
                            const Separation& both,
                            Meeting& meeting) {
    if (lia.law->pressed_by.empty()) {
      return handSpans(actingSpans(scene_, lia, both.is_scalar), both);
    }
    const std::string presser = lia.law->pressed_by.str();
    const auto contact =
        std::find_if(scene_.lias.begin(), scene_.lias.end(),
                     [&presser](const scene::Lia& other) { return other.name == presser; });
    const Ends pressing = endsOf(*contact, port);
    const std::vector<Span> acting = actingSpans(scene_, *contact, pressing.both.is_scalar);
    if (!pressing.areStill()) {
      return handSpans(acting, pressing.both);
    }
    const double apart =
        pressing.both.is_scalar ? pressing.both.apart.x() : pressing.both.apart.norm();
    if (apart > acting[0].from && apart < acting[0].to) {
      return handSpans({{-kEndless, kEndless}}, both);
    }
    meeting.waits_for = presser;
    return {};
  }

  void add(const Port& port,
           int l,
           bool a_leads,
           const std::vector<Span>& spans,
           Meeting meeting,
           PortReach& found) {
    const auto touching = std::find_if(spans.begin(), spans.end(), touches);
    if (touching != spans.end()) {
      meeting.touches = true;
      addEnd(touching->from, meeting);
      addEnd(touching->to, meeting);
      found.meetings.push_back(std::move(meeting));
      return;
    }
    const Span* const above = nextOf(spans, 1.0);
    const Span* const below = nextOf(spans, -1.0);
    meeting.is_missed = above == nullptr && below == nullptr;
    if (meeting.is_missed) {
      found.meetings.push_back(std::move(meeting));
      return;
    }
    for (const double direction : {1.0, -1.0}) {
      const Span* const span = direction > 0.0 ? above : below;
      if (span != nullptr) {
        Meeting one = meeting;
        one.at_m = (direction > 0.0 ? span->from : span->to) + 0.0;  // never -0
        addEnd(direction > 0.0 ? span->to : span->from, one);
        one.then = pushedOn(port, l, a_leads, one.at_m, direction);
        found.meetings.push_back(std::move(one));
      }
    }
  }

  static void addEnd(double end, Meeting& meeting) {
    if (std::isfinite(end)) {
      meeting.ends_m.push_back(end);
    }
  }

  /// Contacts made by what the hand pushes ahead of it from there on; not by what hands carry,
  /// which may go away.
  std::vector<PushedMeeting> pushedOn(
      const Port& port, int l, bool a_leads, double from, double direction) {
    const scene::Lia& pushing = scene_.lias[at(l)];
    const int thing = a_leads ? pushing.b : pushing.a;
    const int by = a_leads ? pushing.a : pushing.b;
    std::vector<PushedMeeting> met;
    if (!pushes_ || scene::lawOf(pushing.type).kind != Law::Kind::kGap ||
        !statics_.wayOf(thing, port).isZero(0.0) || sectionOf(by).geometry != Geometry::kScalar) {
      return met;
    }
    const double stiffness = scene_.valueOf(pushing.stiffness);
    const double softness =
        pushing.type == LiaType::kContact && stiffness > 0.0 ? 1.0 / stiffness : 0.0;
    const std::vector<double> ways = statics_.pushedWays(thing, by, port, softness);
    const int body = statics_.bodyOf(thing);
    for (const int other : ways.empty() ? std::vector<int>{} : letting_go_) {
      const scene::Lia& lia = scene_.lias[at(other)];
      const double a = statics_.among(body, ways, lia.a);
      const double b = statics_.among(body, ways, lia.b);
      Separation both = endsOf(lia, port).both;
      const bool is_hand = is_in_hands_[at(lia.a)] != 0 || is_in_hands_[at(lia.b)] != 0;
      if (other == l || is_hand || a == b || !both.is_scalar) {
        continue;
      }
      both.way = (a - b) * Eigen::Vector3d::UnitX();
      const std::vector<Span> spans = handSpans(actingSpans(scene_, lia, true), both);
      const Span* const next = nextOf(spans, direction);
      if (std::none_of(spans.begin(), spans.end(), touches) && next != nullptr) {
        met.push_back({nameOf(std::abs(a) > std::abs(b) ? lia.b : lia.a), lia.name.str(),
                       scene::lawOf(lia.type).name,
                       from + (direction > 0.0 ? next->from : next->to)});
      }
    }
    std::sort(met.begin(), met.end(), [](const PushedMeeting& a, const PushedMeeting& b) {
      return std::abs(a.at_m) < std::abs(b.at_m);
    });
    return met;
  }

  /// A spring of the slice itself; those behind it are what it draws by that.
  void addHold(const Port& port, int l, bool a_leads, const Ends& ends, PortReach& found) const {
    const scene::Lia& lia = scene_.lias[at(l)];
    if (lia.a != port.mat && lia.b != port.mat) {
      return;
    }
    const Separation& slice = a_leads ? ends.a : ends.b;
    const Separation& thing = a_leads ? ends.b : ends.a;
    found.holds.push_back(
        {nameOf(a_leads ? lia.b : lia.a), lia.name.str(),
         network_.links[at(l)].at_rest / (scene_.time_unit_s * scene_.time_unit_s),
         thing.way.dot(slice.way) / slice.way.squaredNorm()});
  }

  void addGuides(const Port& port, PortReach& found) {
    for (const scene::Connection& point : scene_.connections) {
      for (const scene::Connection::Way* const way : {&point.along, &point.across}) {
        if (way->guide < 0) {
          continue;
        }
        const double per_m = way->scale * statics_.wayOf(way->guide, port)[way->axis];
        if (per_m == 0.0) {
          continue;
        }
        const scene::Mat& guide = scene_.mats[at(way->guide)];
        const double led = (statics_.placeOf(way->guide) - guide.rest)[way->axis];
        Guide one{nameOf(point.mat),
                  scene_.grids[at(point.grid)].name,
                  scene_.valueOf(way->at) + way->scale * led,
                  per_m,
                  {}};
        one.ends_m = {(way->minimum - one.fraction) / per_m, (way->maximum - one.fraction) / per_m};
        std::sort(one.ends_m.begin(), one.ends_m.end());
        found.guides.push_back(std::move(one));
      }
    }
  }

  const Scene& scene_;
  Network network_;
  Statics statics_;
  bool pushes_;
  std::vector<unsigned char> is_in_hands_;           // [mats] what any port moves
  std::vector<int> letting_go_;                      // links, friction apart
  std::map<std::string, std::vector<int>> pressed_;  // by contacts: frictions
};

bool isWithin(const Meeting& meeting, double stroke_m) {
  return !meeting.touches && !meeting.is_missed && std::abs(meeting.at_m) <= stroke_m;
}

}  // namespace

const Meeting* PortReach::first(double stroke_m) const {
  const auto found = std::find_if(meetings.begin(), meetings.end(),
                                  [stroke_m](const Meeting& m) { return isWithin(m, stroke_m); });
  return found == meetings.end() ? nullptr : &*found;
}

bool PortReach::isIdle(double stroke_m) const {
  return holds.empty() && guides.empty() && first(stroke_m) == nullptr &&
         std::none_of(meetings.begin(), meetings.end(),
                      [](const Meeting& m) { return m.touches || !m.waits_for.empty(); });
}

std::vector<PortReach> reachOf(const Scene& scene,
                               const std::vector<int>& ports,
                               bool pushes,
                               std::vector<std::string>& notes) {
  std::vector<PortReach> found;
  if (ports.empty()) {
    return found;
  }
  Finder finder(scene, pushes);
  std::transform(ports.begin(), ports.end(), std::back_inserter(found),
                 [&finder](int port) { return finder.of(port); });
  if (finder.untold() > 0) {
    notes.push_back(std::to_string(finder.untold()) +
                    (finder.untold() == 1 ? " body hangs" : " bodies hang") +
                    " on slices in a way that is not worked out: taken as held where they start");
  }
  return found;
}

std::vector<int> portsOfSlices(const Scene& scene) {
  std::vector<int> ports;
  for (int p = 0; p < static_cast<int>(scene.ports.size()); ++p) {
    if (scene.ports[at(p)].slice >= 0) {
      ports.push_back(p);
    }
  }
  return ports;
}

std::vector<std::string> reachWarnings(const Scene& scene,
                                       const std::vector<PortReach>& found,
                                       double stroke_m) {
  std::vector<std::string> warnings;
  for (const PortReach& reach : found) {
    if (!reach.isIdle(stroke_m)) {
      continue;
    }
    const Port& port = scene.ports[at(reach.port)];
    const std::string mat = scene::quoted(scene.mats[at(port.mat)].name);
    std::string text = scene::textOf(scene, port.place) + ": warning: port " +
                       scene::quoted(port.name) + " (slice " + std::to_string(port.slice) + ") ";
    if (reach.meetings.empty()) {
      text += "can touch nothing: no link leads from " + mat +
              " to anything that it does not carry, and it guides no point";
    } else if (reach.meetings.front().is_missed) {
      text += "meets nothing, however far it goes: " + scene::quoted(reach.meetings.front().thing) +
              ", the first that a link could bring it to, is not on its way";
    } else {
      const Meeting& next = reach.meetings.front();
      text += "meets nothing within its stroke of +-" + shortly(1e3 * stroke_m) +
              " mm: the nearest, " + scene::quoted(next.thing) + " (" + next.law + " " +
              scene::quoted(next.link) + "), is at " + shortly(1e3 * next.at_m) +
              " mm of the hand. Let " + mat + " rest nearer, or lower its position_scale";
    }
    warnings.push_back(std::move(text));
  }
  return warnings;
}

}  // namespace ergotic::physics
