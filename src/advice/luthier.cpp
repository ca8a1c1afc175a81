// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/advice/luthier.hpp"

#include <algorithm>
#include <cmath>

#include "advice/mode_targets.hpp"
#include "at.hpp"
#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "scene/names.hpp"

namespace ergotic::physics {
namespace {

using scene::Scene;

constexpr int kMaxHeard = 400;  // modes
constexpr double kSemitone = 1.0595;
constexpr double kHighestRatio = 4.0;  // times a pitch, how high a parameter may lift it
constexpr double kAtHome = 0.3;        // of its kinetic energy a mode has in the body that sounds
constexpr double kHeardCents = 0.5;
constexpr double kHeardLoss = 0.1;
constexpr int kSteps = 8;            // in which a range is searched
constexpr double kPrecision = 1e-6;  // of a figure
constexpr int kMaxHalvings = 60;

/// The first partial that a body asks for.
struct Body {
  int asked = 0;  // index in SceneModes::asked
  int rank = 1;   // among the modes that are at home in the body
};

bool isAtHome(const SceneMode& mode, int asked) {
  return mode.kind != SceneMode::Kind::kCreeps && mode.in_asked[at(asked)] >= kAtHome;
}

/// Rank of a mode among the modes at home in the body, from 1.
int rankOf(const SceneModes& found, std::size_t mode, int asked) {
  const auto end = found.modes.begin() + static_cast<std::ptrdiff_t>(mode) + 1;
  return static_cast<int>(std::count_if(
      found.modes.begin(), end, [&](const SceneMode& other) { return isAtHome(other, asked); }));
}

bool isOf(const std::string& name, const std::string& body) {
  return name.size() > body.size() && name.compare(0, body.size(), body) == 0 &&
         (name[body.size()] == '.' || name[body.size()] == '@');
}

/// Whether a pitch is the first that is reported of its body. Partials that are cells of a body
/// have names below its own.
bool isFirst(const std::vector<AskedPitch>& asked, std::size_t index) {
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if ((i < index && asked[i].body == asked[index].body) ||
        isOf(asked[index].body, asked[i].body)) {
      return false;
    }
  }
  return true;
}

std::string nameOf(const Scene& scene, const LinkShare& share) {
  return share.lia >= 0 ? scene.lias[at(share.lia)].name.str()
                        : scene.bends[at(share.bend)].name.str();
}

std::vector<Influence> influencesOn(const std::string& body,
                                    const SceneMode& mode,
                                    const Scene& settled) {
  constexpr double kCentsOfHalf = 600.0 / 0.69314718055994531;  // 1200/(2 ln 2)
  std::vector<Influence> all;
  for (const LinkShare& share : mode.links) {
    if (share.lia < 0 && share.bend < 0) {
      continue;
    }
    const Influence one{nameOf(settled, share), kCentsOfHalf * share.of_pull, share.of_loss};
    if (!isOf(one.link, body) &&
        (std::abs(one.cents) >= kHeardCents || one.of_loss >= kHeardLoss)) {
      all.push_back(one);
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Influence& a, const Influence& b) {
    return std::abs(a.cents) > std::abs(b.cents);
  });
  return all;
}

/// A figure of a scene that follows its parameters.
class Figure {
 public:
  Figure(const Wish& wish, const Scene& scene, const Rates& rates, const DeviceTraits& device)
      : wish_(wish), rates_(rates), device_(device) {
    if (wish.kind != Wish::Kind::kMargin) {
      findBody(scene);
    }
  }

  /// \return none if the scene cannot be so, or the body does not sound
  std::optional<double> of(const Scene& scene) const {
    try {
      validate(scene);
      return wish_.kind == Wish::Kind::kMargin ? marginOf(scene) : heardIn(scene);
    } catch (const Exception&) {
      return std::nullopt;  // a value that cannot stand there
    }
  }

 private:
  void findBody(const Scene& scene) {
    const std::vector<AskedPitch> pitches = askedPitchesOf(scene);
    while (pitches.size() > at(body_.asked) &&
           (pitches[at(body_.asked)].body != wish_.body || !isFirst(pitches, at(body_.asked)))) {
      ++body_.asked;
    }
    if (pitches.size() == at(body_.asked)) {
      throw Exception("no body " + scene::quoted(wish_.body) + " asks for a pitch");
    }
    const AskedPitch& asked = pitches[at(body_.asked)];
    body_.rank = asked.partial;
    highest_hz_ =
        kHighestRatio * std::max(asked.hz, wish_.kind == Wish::Kind::kPitch ? wish_.value : 0.0);
    const SceneModes found = modesIn(scene);
    for (std::size_t i = 0; i < found.modes.size(); ++i) {
      if (found.modes[i].asked == body_.asked) {
        body_.rank = rankOf(found, i, body_.asked);
      }
    }
  }

  SceneModes modesIn(const Scene& scene) const {
    return modesOf(settle(scene, rates_).scene, rates_, {0.0, highest_hz_, kMaxHeard}, scene);
  }

  std::optional<double> marginOf(const Scene& scene) const {
    return certify(settle(scene, rates_).scene, rates_, device_).margin();
  }

  std::optional<double> heardIn(const Scene& scene) const {
    int left = body_.rank;
    for (const SceneMode& mode : modesIn(scene).modes) {
      if (isAtHome(mode, body_.asked) && --left == 0) {
        return wish_.kind == Wish::Kind::kPitch ? mode.frequency_hz : mode.t60_s;
      }
    }
    return std::nullopt;
  }

  const Wish& wish_;
  Rates rates_;
  const DeviceTraits& device_;
  Body body_;
  double highest_hz_ = 0.0;
};

/// Search over one parameter, which is moved alone.
class ParameterSearch {
 public:
  ParameterSearch(const Figure& figure, const Scene& scene, std::size_t index, double wanted)
      : figure_(figure), scene_(scene), index_(index), wanted_(wanted) {}

  /// \return none if the parameter does not change the figure
  std::optional<Move> run() {
    const scene::Parameter& parameter = scene_.parameters[index_];
    Move move{parameter.name, std::nullopt, kInfinity, -kInfinity};
    double nearest = kInfinity;
    std::optional<Point> last;
    for (int i = 0; i <= kSteps; ++i) {
      const std::optional<Point> point = pointAt(valueAt(static_cast<double>(i) / kSteps));
      if (!point) {
        last.reset();
        continue;
      }
      if (std::isfinite(point->figure)) {
        move.lowest = std::min(move.lowest, point->figure);
        move.highest = std::max(move.highest, point->figure);
      }
      if (last && (last->figure >= wanted_) != (point->figure >= wanted_)) {
        const std::optional<double> to = crossing(*last, *point);
        const double way = to ? std::abs(*to - parameter.value) : kInfinity;
        move.to = way < nearest ? to : move.to;
        nearest = std::min(nearest, way);
      }
      last = point;
    }
    const bool does_something = move.highest - move.lowest > 1e-9 * std::abs(move.highest);
    return does_something ? std::optional<Move>(move) : std::nullopt;
  }

 private:
  struct Point {
    double value = 0.0;
    double figure = 0.0;
  };

  /// Value at a share of the parameter's range: on a logarithmic scale if all of it is positive.
  double valueAt(double share) const {
    const scene::Parameter& parameter = scene_.parameters[index_];
    const double low = parameter.minimum;
    const double high = parameter.maximum;
    return share == 0.0   ? low
           : share == 1.0 ? high
           : low > 0.0    ? low * std::pow(high / low, share)
                          : low + share * (high - low);
  }

  std::optional<Point> pointAt(double value) const {
    Scene scene = scene_;
    scene::Parameter& parameter = scene.parameters[index_];
    parameter.value = parameter.minimum = parameter.maximum = value;
    const std::optional<double> figure = figure_.of(scene);
    return figure && !std::isnan(*figure) ? std::optional<Point>({value, *figure}) : std::nullopt;
  }

  /// \return none where the figure jumps over what is wanted
  std::optional<double> crossing(Point a, Point b) const {
    for (int i = 0; i < kMaxHalvings; ++i) {
      const bool is_first = std::abs(a.figure - wanted_) < std::abs(b.figure - wanted_);
      const Point& better = is_first ? a : b;
      if (std::abs(better.figure - wanted_) <= kPrecision * std::abs(wanted_)) {
        return better.value;
      }
      const std::optional<Point> middle = pointAt(0.5 * (a.value + b.value));
      if (!middle) {
        return std::nullopt;
      }
      ((a.figure >= wanted_) != (middle->figure >= wanted_) ? b : a) = *middle;
    }
    return std::nullopt;
  }

  const Figure& figure_;
  const Scene& scene_;
  std::size_t index_;
  double wanted_;
};

}  // namespace

HeardBodies listenTo(const Scene& scene, const Rates& rates) {
  HeardBodies heard;
  const Scene settled = settle(scene, rates).scene;
  const std::vector<AskedPitch> pitches = askedPitchesOf(scene);
  double to_hz = 0.0;
  for (std::size_t a = 0; a < pitches.size(); ++a) {
    to_hz = std::max(to_hz, isFirst(pitches, a) ? kSemitone * pitches[a].hz : 0.0);
  }
  const SceneModes found = modesOf(settled, rates, {0.0, to_hz, kMaxHeard}, scene);
  for (const SceneMode& mode : found.modes) {
    if (mode.asked < 0 || !isFirst(found.asked, at(mode.asked))) {
      continue;
    }
    const AskedPitch& asked = found.asked[at(mode.asked)];
    heard.bodies.push_back({asked.body, asked.hz, mode.frequency_hz, mode.cents, mode.t60_s,
                            influencesOn(asked.body, mode, settled)});
  }
  for (std::size_t a = 0; a < found.asked.size(); ++a) {
    if (!found.asked[a].is_found && isFirst(found.asked, a)) {
      heard.missing.push_back(found.asked[a]);
    }
  }
  return heard;
}

std::vector<Move> movesFor(const Wish& wish,
                           const Scene& scene,
                           const Rates& rates,
                           const DeviceTraits& device) {
  const Figure figure(wish, scene, rates, device);
  std::vector<Move> moves;
  for (std::size_t p = 0; p < scene.parameters.size(); ++p) {
    if (const std::optional<Move> move = ParameterSearch(figure, scene, p, wish.value).run()) {
      moves.push_back(*move);
    }
  }
  return moves;
}

}  // namespace ergotic::physics
