// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/grid_selections.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "constants.hpp"
#include "scene/limits.hpp"
#include "scene/text/number.hpp"
#include "scene/text/quantity.hpp"
#include "scene/tree/yaml_map.hpp"

namespace ergotic::scene {
namespace {
constexpr Limits kRingLimits{"", 1.0, 1000.0};
constexpr double kRounding = 1e-9;  ///< part of a spacing: what lies on an edge is within

struct Word {
  const char* word;
  std::size_t fewest;
  std::size_t most;
  bool is_one;
  bool on_strings;
  bool on_meshes;
};
constexpr Word kWords[] = {
    {"all", 0, 0, false, true, true},      {"rim", 0, 0, false, true, true},
    {"corners", 0, 0, false, false, true}, {"middle", 0, 0, true, true, true},
    {"row", 1, 1, false, false, true},     {"column", 1, 1, false, false, true},
    {"range", 2, 2, false, true, false},   {"box", 4, 4, false, false, true},
    {"disc", 3, 3, false, false, true},    {"ring", 1, 2, false, false, true},
    {"near", 1, 3, true, true, true},
};

const Word* findWord(const std::string& word) {
  const auto* const found = std::find_if(std::begin(kWords), std::end(kWords),
                                         [&](const Word& each) { return word == each.word; });
  return found == std::end(kWords) ? nullptr : found;
}

/// Modules of a grid by column and row.
class Selector {
 public:
  Selector(const SceneBuilder& builder,
           const Grid& grid,
           const GridWords& words,
           const std::string& whole,
           Place place)
      : builder_(builder),
        scene_(builder.scene()),
        grid_(grid),
        words_(words),
        whole_(whole),
        place_(place) {
    columns_[0] = grid.columns;
    rows_[0] = grid.rows;
    for (int r = 0; r < grid.rows; ++r) {
      for (int c = 0; c < grid.columns; ++c) {
        if (moves(c, r)) {
          columns_[0] = std::min(columns_[0], c);
          columns_[1] = std::max(columns_[1], c);
          rows_[0] = std::min(rows_[0], r);
          rows_[1] = std::max(rows_[1], r);
        }
      }
    }
  }

  std::vector<int> run() const {
    const std::string& word = words_.word;
    if (word == "rim") {
      return rim();
    }
    if (word == "ring") {
      return ring();
    }
    if (word == "near") {
      return {near()};
    }
    if (word == "middle") {
      return {nearest([this](int c, int r) {
        return std::hypot(c - 0.5 * (columns_[0] + columns_[1]), r - 0.5 * (rows_[0] + rows_[1]));
      })};
    }
    return within(region());
  }

 private:
  using Test = std::function<bool(int column, int row)>;
  using Distance = std::function<double(int column, int row)>;

  int at(int column, int row) const { return grid_.first + row * grid_.columns + column; }
  const Mat& mat(int column, int row) const {
    return scene_.mats[static_cast<std::size_t>(at(column, row))];
  }
  bool moves(int column, int row) const {
    return column >= 0 && row >= 0 && column < grid_.columns && row < grid_.rows &&
           mat(column, row).type != MatType::kGround;
  }

  double number(std::size_t i, const Limits& limits) const {
    return numberIn(builder_, words_.arguments[i], "a number of " + quoted(whole_), limits, place_);
  }
  int whole(std::size_t i, const Limits& limits) const {
    const double given = number(i, limits);
    if (given != std::floor(given)) {
      builder_.fail(place_, "a number of " + quoted(whole_) + " = " + numberText(given) +
                                " is not a whole number, allowed: " + limits.text());
    }
    return static_cast<int>(given);
  }

  Test region() const {
    const std::string& word = words_.word;
    const double last_column = grid_.columns - 1;
    const double last_row = grid_.rows - 1;
    if (word == "row") {
      return [row = whole(0, {"", 0.0, last_row})](int, int r) { return r == row; };
    }
    if (word == "column") {
      return [column = whole(0, {"", 0.0, last_column})](int c, int) { return c == column; };
    }
    if (word == "corners") {
      return [this](int c, int r) {
        return (c == columns_[0] || c == columns_[1]) && (r == rows_[0] || r == rows_[1]);
      };
    }
    if (word == "range" || word == "box") {
      const bool is_box = word == "box";
      const double from = fraction(0) * last_column - kRounding;
      const double to = fraction(is_box ? 2 : 1) * last_column + kRounding;
      const double top = is_box ? fraction(1) * last_row - kRounding : 0.0;
      const double bottom = is_box ? fraction(3) * last_row + kRounding : 0.0;
      return [=](int c, int r) { return c >= from && c <= to && r >= top && r <= bottom; };
    }
    if (word == "disc") {
      const double column = fraction(0) * last_column;
      const double row = fraction(1) * last_row;
      const double radius = fraction(2) * last_column + kRounding;
      return [=](int c, int r) { return std::hypot(c - column, r - row) <= radius; };
    }
    return [](int, int) { return true; };
  }
  double fraction(std::size_t i) const { return number(i, kFractionLimits); }

  std::vector<int> within(const Test& test) const {
    std::vector<int> mats;
    for (int r = 0; r < grid_.rows; ++r) {
      for (int c = 0; c < grid_.columns; ++c) {
        if (moves(c, r) && test(c, r)) {
          mats.push_back(at(c, r));
        }
      }
    }
    return mats;
  }
  int nearest(const Distance& distance) const {
    int found = -1;
    double least = kInfinity;
    for (int r = 0; r < grid_.rows; ++r) {
      for (int c = 0; c < grid_.columns; ++c) {
        const double to = moves(c, r) ? distance(c, r) : kInfinity;
        if (to < least) {
          least = to;
          found = at(c, r);
        }
      }
    }
    return found;
  }

  /// Angle of a module about the middle, from the direction along on, 0...2 pi.
  double angleOf(int mat) const {
    const int index = mat - grid_.first;
    const double y = index / grid_.columns - 0.5 * (rows_[0] + rows_[1]);
    const double x = index % grid_.columns - 0.5 * (columns_[0] + columns_[1]);
    const double angle = std::atan2(y, x);
    return angle < 0.0 ? angle + 2.0 * kPi : angle;
  }
  /// Modules that move next to ones that do not, or next to none.
  std::vector<int> rim() const {
    const bool is_row = grid_.rows == 1;
    std::vector<int> mats = within([&](int c, int r) {
      return !moves(c - 1, r) || !moves(c + 1, r) ||
             (!is_row && (!moves(c, r - 1) || !moves(c, r + 1)));
    });
    if (!is_row) {
      std::stable_sort(mats.begin(), mats.end(),
                       [this](int a, int b) { return angleOf(a) < angleOf(b); });
    }
    return mats;
  }
  /// Modules evenly spaced on the rim, or at a fraction of the way from the middle to it.
  std::vector<int> ring() const {
    const int count = whole(0, kRingLimits);
    const std::vector<int> outer = rim();
    std::vector<int> mats;
    for (int k = 0; k < count && !outer.empty(); ++k) {
      const double angle = 2.0 * kPi * k / count;
      mats.push_back(words_.arguments.size() > 1
                         ? inner(angle, fraction(1))
                         : *std::min_element(outer.begin(), outer.end(), [&](int a, int b) {
                             return apart(a, angle) < apart(b, angle);
                           }));
    }
    if (std::set<int>(mats.begin(), mats.end()).size() < mats.size()) {
      builder_.fail(place_,
                    quoted(whole_) + " means a module twice, allowed: fewer, or further out");
    }
    return mats;
  }
  double apart(int mat, double angle) const {
    return std::abs(std::remainder(angleOf(mat) - angle, 2.0 * kPi));
  }
  int inner(double angle, double radius) const {
    const double column = 0.5 * (columns_[0] + columns_[1]) +
                          0.5 * radius * (columns_[1] - columns_[0]) * std::cos(angle);
    const double row =
        0.5 * (rows_[0] + rows_[1]) + 0.5 * radius * (rows_[1] - rows_[0]) * std::sin(angle);
    return nearest([=](int c, int r) { return std::hypot(c - column, r - row); });
  }

  /// The module nearest to a position in m, given as in `at` of modules, or to another module.
  int near() const {
    const Section& section = scene_.sectionOf(mat(0, 0));
    const bool is_scalar = section.geometry == Geometry::kScalar;
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    Eigen::Index first = is_scalar ? 1 : 0;
    Eigen::Index count = static_cast<Eigen::Index>(words_.arguments.size());
    if (words_.arguments.size() == 1 && !parseAnyQuantity(words_.arguments[0])) {
      const Mat& other =
          scene_.mats[static_cast<std::size_t>(builder_.mat(words_.arguments[0], place_))];
      place = section.pose.inverse() * (scene_.sectionOf(other).pose * other.rest);
      count = 3 - first;
    } else if (count > 3 - first) {
      builder_.fail(place_, quoted(whole_) + " has 3 numbers, allowed in a scalar section: [y, z]");
    } else {
      for (Eigen::Index i = 0; i < count; ++i) {
        place[first + i] = number(static_cast<std::size_t>(i), kMetreLimits);
      }
    }
    return nearest(
        [&](int c, int r) { return (mat(c, r).rest - place).segment(first, count).norm(); });
  }

  const SceneBuilder& builder_;
  const Scene& scene_;
  const Grid& grid_;
  const GridWords& words_;
  const std::string& whole_;
  const Place place_;
  int columns_[2] = {0, -1};  // first and last that moves
  int rows_[2] = {0, -1};
};

std::vector<std::string> knownWords(const Grid& grid) {
  std::vector<std::string> known;
  for (const Word& each : kWords) {
    if (grid.rows == 1 ? each.on_strings : each.on_meshes) {
      known.emplace_back(each.word);
    }
  }
  return known;
}

}  // namespace

GridWords gridWordsOf(const SceneBuilder& builder, const std::string& text, Place place) {
  GridWords words;
  const std::size_t open = text.find('(');
  words.word = trimmed(text.substr(0, open));
  if (open != std::string::npos) {
    if (text.back() != ')') {
      builder.fail(place, quoted(text) + " has a '(' without ')'");
    }
    std::string inside = text.substr(open + 1, text.size() - open - 2);
    while (true) {
      const std::size_t comma = inside.find(',');
      words.arguments.push_back(trimmed(inside.substr(0, comma)));
      if (comma == std::string::npos) {
        break;
      }
      inside.erase(0, comma + 1);
    }
  }
  const Word* const known = findWord(words.word);
  if (known == nullptr) {
    std::vector<std::string> all;
    for (const Word& each : kWords) {
      all.emplace_back(each.word);
    }
    builder.fail(place, "unknown selection " + quoted(words.word) + suggestion(words.word, all));
  }
  const std::size_t count = words.arguments.size();
  if (count < known->fewest || count > known->most) {
    builder.fail(place,
                 quoted(words.word) + " has " + std::to_string(count) +
                     " numbers, allowed: " + std::to_string(known->fewest) +
                     (known->most > known->fewest ? "..." + std::to_string(known->most) : ""));
  }
  return words;
}

bool isOne(const GridWords& words) {
  return findWord(words.word)->is_one;
}

std::vector<int> selectedOn(const SceneBuilder& builder,
                            const Grid& grid,
                            const GridWords& words,
                            const std::string& whole,
                            Place place) {
  const Word& word = *findWord(words.word);
  if (!(grid.rows == 1 ? word.on_strings : word.on_meshes)) {
    builder.fail(place, quoted(words.word) + " means nothing on " +
                            (grid.rows == 1 ? "string " : "mesh ") + quoted(grid.name) +
                            suggestion("", knownWords(grid)));
  }
  std::vector<int> mats = Selector(builder, grid, words, whole, place).run();
  if (mats.empty() || mats.front() < 0) {
    builder.fail(place, quoted(whole) + " means none of the modules that move");
  }
  return mats;
}

}  // namespace ergotic::scene
