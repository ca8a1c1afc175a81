// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/generate/cut_string.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "at.hpp"
#include "ergotic/scene/coarse_string.hpp"
#include "ergotic/scene/grid.hpp"
#include "scene/limits.hpp"

namespace ergotic::scene {
namespace {

int linksOf(const StringCut& cut) {
  return cut.coarse ? coarseLinks(cut.masses) : cut.masses + 1;
}

bool isInner(const StringInfo& string, int mat) {
  return mat > string.first && mat < string.first + string.count - 1;
}

class Cutter {
 public:
  Cutter(const Scene& scene, int string, const StringCut& cut)
      : from_(scene),
        string_(scene.strings[at(string)]),
        cut_(cut),
        finer_((cut.masses + 1.0) / (string_.count - 1.0)),
        more_mats_(cut.masses + 2 - string_.count),
        more_lias_(linksOf(cut) - linksOf(cutOf(string_))),
        grid_(static_cast<int>(std::distance(
            scene.grids.begin(),
            std::find_if(scene.grids.begin(),
                         scene.grids.end(),
                         [&](const Grid& grid) { return grid.first == string_.first; })))),
        to_(scene) {}

  Scene run(int string) {
    setInfo(to_.strings[at(string)]);
    replaceMats();
    replaceLias(to_.strings[at(string)]);
    moveOthers(string);
    for (Lia& lia : to_.lias) {
      const auto index = static_cast<int>(&lia - to_.lias.data());
      if (index < string_.first_lia || index >= string_.first_lia + linksOf(cut_)) {
        lia.a = endAt(lia.a, lia.place);
        lia.b = endAt(lia.b, lia.place);
      }
    }
    for (Input& input : to_.inputs) {
      input.mat = endAt(input.mat, input.place);
    }
    for (Output& output : to_.outputs) {
      output.point = pointOf(output.point);
    }
    return std::move(to_);
  }

 private:
  void setInfo(StringInfo& info) const {
    const double stiffer = halfSine(string_.count - 2) / halfSine(cut_.masses);
    info.count = cut_.masses + 2;
    info.mass = (1.0 / finer_) * string_.mass;
    info.loss = (1.0 / finer_) * string_.loss;
    info.damping = finer_ * string_.damping;
    info.stiffness = stiffer * stiffer / finer_ * string_.stiffness;
    info.frequency_hz = cut_.coarse ? idealPitchHz(from_, string_) : string_.frequency_hz;
    info.coarse = cut_.coarse;
  }
  static double halfSine(int masses) { return std::sin(M_PI / (2.0 * (masses + 1))); }

  /// Interpolates between two of the old modules, `place` counted in their spacings.
  template <class What>
  Eigen::Vector3d between(const What& what, double place) const {
    const int lower = std::min(static_cast<int>(place), string_.count - 2);
    const Mat& a = from_.mats[at(string_.first + lower)];
    const Mat& b = from_.mats[at(string_.first + lower + 1)];
    return (1.0 - (place - lower)) * what(a) + (place - lower) * what(b);
  }

  void replaceMats() {
    const auto first = to_.mats.begin() + string_.first;
    const Name stem(string_.name + ".");
    std::vector<Mat> mats;
    for (int i = 0; i < cut_.masses + 2; ++i) {
      const bool is_end = i == 0 || i == cut_.masses + 1;
      Mat mat = from_.mats[at(string_.first + (i == 0 ? 0 : is_end ? string_.count - 1 : 1))];
      mat.name = stem.numbered(i);
      if (!is_end) {
        const double place = i / finer_;
        mat.mass = (1.0 / finer_) * mat.mass;
        mat.damping = (1.0 / finer_) * mat.damping;
        mat.rest = between([](const Mat& m) { return m.rest; }, place);
        mat.position = between([](const Mat& m) { return m.position; }, place);
        setVelocity(mat, between([](const Mat& m) { return m.push->velocity; }, place));
      }
      mats.push_back(std::move(mat));
    }
    const auto after = to_.mats.erase(first, first + string_.count);
    to_.mats.insert(after, std::make_move_iterator(mats.begin()),
                    std::make_move_iterator(mats.end()));
  }

  void replaceLias(const StringInfo& info) {
    const Lia pattern = from_.lias[at(string_.first_lia)];
    const Name stem(string_.name + ".link.");
    std::vector<Lia> lias;
    for (int i = 0; i < linksOf(cut_); ++i) {
      const CoarseLink ends = cut_.coarse ? coarseLink(cut_.masses, i) : CoarseLink{i, i + 1, {}};
      Lia lia = pattern;
      lia.name = stem.numbered(i);
      lia.a = string_.first + ends.a;
      lia.b = string_.first + ends.b;
      const bool is_plain = i <= cut_.masses;
      lia.stiffness = is_plain ? info.stiffness : Value{};
      lia.damping = is_plain ? info.damping : Value{};
      lia.rest_length = is_plain ? pattern.rest_length / finer_ : 0.0;
      lias.push_back(std::move(lia));
    }
    const auto first = to_.lias.begin() + string_.first_lia;
    const auto after = to_.lias.erase(first, first + linksOf(cutOf(string_)));
    to_.lias.insert(after, std::make_move_iterator(lias.begin()),
                    std::make_move_iterator(lias.end()));
  }

  /// Index of a module that is not an inner one of the string.
  int moved(int mat) const {
    return mat >= string_.first + string_.count - 1 ? mat + more_mats_ : mat;
  }

  /// Index of a link that is not one of the string's.
  int movedLia(int lia) const { return lia > string_.first_lia ? lia + more_lias_ : lia; }

  void moveOthers(int string) {
    for (Port& port : to_.ports) {
      port.mat = moved(port.mat);
      port.filter = moved(port.filter);
    }
    for (Connection& connection : to_.connections) {
      connection.mat = moved(connection.mat);
      connection.along.guide = moved(connection.along.guide);
      connection.across.guide = moved(connection.across.guide);
    }
    for (Tap& tap : to_.taps) {
      tap.mat = moved(tap.mat);
      for (Tap::Share& share : tap.shares) {
        share.mat = moved(share.mat);
      }
    }
    for (Tank& tank : to_.tanks) {
      tank.first_lia = movedLia(tank.first_lia);
      for (int& spring : tank.springs) {
        spring = movedLia(spring);
      }
    }
    for (Tuning& tuning : to_.tunings) {
      tuning.first_mat = moved(tuning.first_mat);
      tuning.first_lia = movedLia(tuning.first_lia);
    }
    for (Outline& outline : to_.outlines) {
      outline.first_mat = moved(outline.first_mat);
    }
    for (Grid& grid : to_.grids) {
      grid.first = moved(grid.first);
    }
    to_.grids[at(grid_)].columns = cut_.masses + 2;
    for (int s = 0; s < static_cast<int>(to_.strings.size()); ++s) {
      StringInfo& other = to_.strings[at(s)];
      other.first = moved(other.first);
      if (s != string && other.first_lia > string_.first_lia) {
        other.first_lia = movedLia(other.first_lia);
      }
    }
  }

  /// The module or point at the same position on the string, whatever is there now.
  int endAt(int mat, Place place) {
    if (!isInner(string_, mat)) {
      return moved(mat);
    }
    const double along = (mat - string_.first) / (string_.count - 1.0);
    const double index = along * (cut_.masses + 1);
    if (std::abs(index - std::round(index)) < 1e-9) {
      return string_.first + static_cast<int>(std::round(index));
    }
    for (const Connection& known : to_.connections) {
      const Value& there = known.along.at;
      const bool stays = known.along.guide < 0 && there.parameter < 0 && there.audio < 0;
      if (known.grid == grid_ && stays && there.factor == along) {
        return known.mat;
      }
    }
    return addPoint(along, place);
  }

  int addPoint(double along, Place place) {
    Connection connection;
    connection.mat = static_cast<int>(to_.mats.size());
    connection.grid = grid_;
    connection.along.at = {along};
    connection.place = place;
    const GridPlace around = placeOn(to_.grids[at(grid_)], along, 0.0);
    Mat point;
    point.name = string_.name + "@" + numberText(along);
    point.type = MatType::kPoint;
    point.section = to_.mats[at(string_.first)].section;
    point.place = place;
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < at(around.count); ++i) {
      const Mat& mat = to_.mats[at(around.mats[i])];
      point.rest += around.weights[i] * mat.rest;
      point.position += around.weights[i] * mat.position;
      velocity += around.weights[i] * mat.push->velocity;
    }
    setVelocity(point, velocity);
    to_.mats.push_back(std::move(point));
    to_.connections.push_back(connection);
    return connection.mat;
  }

  Point pointOf(const Point& point) const {
    const bool is_on_string =
        point.mat >= string_.first && point.mat < string_.first + string_.count;
    if (!is_on_string) {
      return {moved(point.mat), point.next < 0 ? -1 : moved(point.next), point.fraction};
    }
    const double fraction = point.next < 0 ? 0.0 : point.fraction;
    const double place = (point.mat - string_.first + fraction) * finer_;
    const int lower = static_cast<int>(place + 1e-9);
    const double rest = std::max(place - lower, 0.0);
    const int mat = string_.first + lower;
    return rest < 1e-9 ? Point{mat, -1, 0.0} : Point{mat, mat + 1, rest};
  }

  const Scene& from_;
  StringInfo string_;
  StringCut cut_;
  double finer_;  // new links along the string in an old one
  int more_mats_;
  int more_lias_;
  int grid_;
  Scene to_;
};

}  // namespace

StringCut cutOf(const StringInfo& string) {
  return {string.count - 2, string.coarse};
}

double idealPitchHz(const Scene& scene, const StringInfo& string) {
  if (string.frequency_hz > 0.0) {
    return string.frequency_hz;
  }
  const Mat& mat = scene.mats[at(string.first)];
  double stiffness = scene.valueOf(string.stiffness);
  if (dimensionsOf(scene.sectionOf(mat).geometry) > 1) {
    const Mat& last = scene.mats[at(string.first + string.count - 1)];
    const double link = (last.rest - mat.rest).norm() / (string.count - 1);
    stiffness *= 1.0 - scene.lias[at(string.first_lia)].rest_length / link;
  }
  return std::sqrt(stiffness / scene.valueOf(string.mass)) *
         std::sin(M_PI / (2.0 * (string.count - 1))) / (M_PI * scene.time_unit_s);
}

std::string reasonAgainstCutting(const Scene& scene, int string) {
  const StringInfo& info = scene.strings[at(string)];
  const Section& section = scene.sectionOf(scene.mats[at(info.first)]);
  if (scene.valueOf(section.medium) > 0.0) {
    return "the medium of section '" + section.name + "' brakes each of its masses";
  }
  const bool is_bridged =
      scene.lias[at(info.first_lia)].a != info.first ||
      scene.lias[at(info.first_lia + info.count - 2)].b != info.first + info.count - 1;
  if (is_bridged) {
    return "it ends on a bridge";
  }
  for (const Output& output : scene.outputs) {
    if (output.quantity == Quantity::kForce &&
        (isInner(info, output.point.mat) || isInner(info, output.point.next))) {
      return "output '" + output.name + "' hears the force on one of its masses";
    }
  }
  for (const Connection& connection : scene.connections) {
    if (isInner(info, connection.along.guide) || isInner(info, connection.across.guide)) {
      return "point '" + scene.mats[at(connection.mat)].name + "' is guided by one of its masses";
    }
  }
  for (const Tap& tap : scene.taps) {
    for (const Tap::Share& share : tap.shares) {
      if (isInner(info, share.mat)) {
        return "tap '" + scene.mats[at(tap.mat)].name + "' lies on one of its masses";
      }
    }
  }
  for (const Lia& lia : scene.lias) {
    if (lia.tank >= 0 && (isInner(info, lia.a) || isInner(info, lia.b))) {
      return "link '" + lia.name + "' hardens it from mass to mass";
    }
  }
  return {};
}

bool canBeCoarse(const Scene& scene, int string) {
  const StringInfo& info = scene.strings[at(string)];
  const bool is_scalar = scene.sectionOf(scene.mats[at(info.first)]).geometry == Geometry::kScalar;
  const bool is_tuned = info.stiffness.parameter == info.mass.parameter;  // none can detune it
  return is_scalar && is_tuned && info.stiffness.audio < 0;
}

Scene cutString(const Scene& scene, int string, const StringCut& cut) {
  return Cutter(scene, string, cut).run(string);
}

}  // namespace ergotic::scene
