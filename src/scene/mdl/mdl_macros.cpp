// SPDX-License-Identifier: BSD-3-Clause
#include "scene/mdl/mdl_macros.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scene/generate/generated.hpp"
#include "scene/generate/points.hpp"
#include "scene/limits.hpp"
#include "scene/text/number.hpp"

namespace ergotic::scene {
namespace {

/// kg m^2/sample^2 each second, that moving a point may bring: models have masses of about 1 and
/// move by about 1.
constexpr double kPointEnergyPerSecond = 100.0;

constexpr std::array<MdlMacro, 6> kMacros{{
    {"string", 1, false, MacroEdges::kFixed, 3.0, "N M K Z"},
    {"chain", 1, false, MacroEdges::kFree, 2.0, "N M K Z"},
    {"stiffString", 1, true, MacroEdges::kFixed, 3.0, "N M K K2 Z"},
    {"mesh", 2, false, MacroEdges::kFree, 2.0, "X Y M K Z"},
    {"cornerMesh", 2, false, MacroEdges::kCorners, 2.0, "X Y M K Z"},
    {"closedMesh", 2, false, MacroEdges::kFixed, 3.0, "X Y M K Z"},
}};

/// Writes one macro out.
class Expansion {
 public:
  Expansion(SceneBuilder& builder, MdlNumbers& numbers, const MdlLine& line, const MdlMacro& macro)
      : builder_(builder), numbers_(numbers), line_(line), macro_(macro) {}

  void read(const MdlDialect& dialect) {
    const std::size_t last = macro_.numbers();
    const bool is_old = dialect.isOld();
    expectArguments(builder_, line_, dialect, last + (is_old ? 1 : 2), last + (is_old ? 1 : 3),
                    std::string(macro_.usage) + (is_old ? " x0" : " [Zo] start end"));
    rows_ = macro_.sides == 1 ? 1 : side(0, "X");
    columns_ = side(macro_.sides - 1, macro_.sides == 1 ? "N" : "Y");
    const auto& arguments = line_.arguments;
    std::size_t at = macro_.sides;
    mass_ = {numbers_.number(arguments[at++], ofElement("mass", line_), kMassLimits)};
    stiffness_ = numbers_.value(arguments[at++], ofElement("stiffness K", line_), kStiffnessLimits);
    if (macro_.is_stiff) {
      const std::string what = ofElement("stiffness K2", line_);
      bending_ = numbers_.value(arguments[at++], what, kStiffnessLimits);
    }
    damping_ = numbers_.value(arguments[at++], ofElement("damping Z", line_), kDampingLimits);
    if (is_old) {
      start_ = numbers_.vector(arguments[at]);
      end_ = macro_.sides == 1 ? MdlNumbers::Vector{columns_ - 1.0, 0.0, 0.0}
                               : MdlNumbers::Vector{rows_ - 1.0, columns_ - 1.0, 0.0};
      return;
    }
    if (arguments.size() > last + 2) {
      loss_ = numbers_.value(arguments[at++], ofElement("damping Zo", line_), kDampingLimits);
    }
    start_ = numbers_.vector(arguments[at]);
    end_ = numbers_.vector(arguments[at + 1]);
  }

  std::size_t modules() const {
    return static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_);
  }

  void write() {
    builder_.reserve(modules(), 2 * modules(), line_.place);
    first_ = static_cast<int>(builder_.scene().mats.size());
    first_lia_ = static_cast<int>(builder_.scene().lias.size());
    addMats();
    addLinks();
    builder_.add(Grid{line_.name, first_, columns_, rows_, line_.place});
    if (line_.keyword.text == "string") {
      addInfo();
    }
  }

 private:
  int side(std::size_t argument, const char* what) {
    const Limits limits{"", macro_.fewest, kMaxMats};
    const MdlToken& token = line_.arguments[argument];
    const double value = numbers_.number(token, ofElement(what, line_), limits);
    if (value != std::floor(value)) {
      builder_.fail(token.place, ofElement(what, line_) + " = " + numberText(value) +
                                     ", allowed: a whole number, " + limits.text());
    }
    return static_cast<int>(value);
  }

  bool isFixed(int row, int column) const {
    const bool row_edge = row == 0 || row == rows_ - 1;
    const bool column_edge = column == 0 || column == columns_ - 1;
    switch (macro_.edges) {
      case MacroEdges::kFixed:
        return column_edge || (rows_ > 1 && row_edge);
      case MacroEdges::kCorners:
        return row_edge && column_edge;
      case MacroEdges::kFree:
        break;
    }
    return false;
  }

  Mat mat(int row, int column) const {
    Mat mat;
    mat.place = line_.place;
    // A string lies between the two places, a net is the rectangle of which they are corners.
    const double along = static_cast<double>(column) / (columns_ - 1);
    const double u = rows_ == 1 ? along : static_cast<double>(row) / (rows_ - 1);
    mat.rest.y() = (1.0 - u) * start_.x + u * end_.x;
    mat.rest.z() = (1.0 - along) * start_.y + along * end_.y;
    mat.position.x() = start_.z;
    if (isFixed(row, column)) {
      mat.type = MatType::kGround;
      mat.rest.x() = start_.z;
      return mat;
    }
    const bool is_free = loss_.factor == 0.0;
    mat.type = is_free ? MatType::kMass : MatType::kCell;
    mat.mass = mass_;
    mat.damping = loss_;
    setVelocity(mat, {end_.z / kMdlRateHz, 0.0, 0.0});
    return mat;
  }

  void addMats() {
    const Name stem(line_.name + ".");
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        Mat made = mat(row, column);
        made.name = rows_ == 1 ? stem.numbered(column) : stem.numbered(row, column);
        builder_.add(std::move(made));
      }
    }
  }

  /// Adds the links as published: a stiff string has its second springs from module to second
  /// neighbour, and at either end one more to the next.
  void addLinks() {
    const Name stem = linkStem(line_.name);
    const int count = rows_ * columns_;
    for (int i = 0; i < count; ++i) {
      if (i % columns_ < columns_ - 1) {
        addLink(stem, i, i + 1, stiffness_, damping_);
      }
      if (i + columns_ < count) {
        addLink(stem, i, i + columns_, stiffness_, damping_);
      }
    }
    if (macro_.is_stiff) {
      addLink(stem, 0, 1, bending_, {});
      for (int i = 0; i + 2 < count; ++i) {
        addLink(stem, i, i + 2, bending_, {});
      }
      addLink(stem, count - 2, count - 1, bending_, {});
    }
  }

  void addLink(const Name& stem, int a, int b, const Value& stiffness, const Value& damping) {
    const auto isGround = [&](int module) {
      return builder_.scene().mats[static_cast<std::size_t>(first_ + module)].type ==
             MatType::kGround;
    };
    if (isGround(a) && isGround(b)) {
      return;
    }
    const int number = static_cast<int>(builder_.scene().lias.size()) - first_lia_;
    Lia lia = generatedLink(stem, number, first_ + a, first_ + b, line_.place);
    lia.stiffness = stiffness;
    lia.damping = damping;
    builder_.add(std::move(lia));
  }

  void addInfo() {
    StringInfo info;
    info.name = line_.name;
    info.first = first_;
    info.first_lia = first_lia_;
    info.count = columns_;
    info.mass = mass_;
    info.stiffness = stiffness_;
    info.damping = damping_;
    info.loss = loss_;
    builder_.add(std::move(info));
  }

  SceneBuilder& builder_;
  MdlNumbers& numbers_;
  const MdlLine& line_;
  const MdlMacro& macro_;
  int rows_ = 1;
  int columns_ = 2;
  Value mass_;
  Value stiffness_;
  Value bending_;
  Value damping_;
  Value loss_;
  MdlNumbers::Vector start_;
  MdlNumbers::Vector end_;
  int first_ = 0;
  int first_lia_ = 0;
};

/// A coordinate, and what it is called in the name of a point.
struct Fraction {
  Value at;
  std::string name;
};

/// A coordinate from 0 to 1; one that follows an audio input is clamped while it plays.
Fraction fraction(SceneBuilder& builder, MdlNumbers& numbers, const MdlToken& token) {
  const Value value = numbers.value(token, "coordinate", {});
  if (value.audio >= 0) {
    return {value, token.text};
  }
  const double cut = std::clamp(value.factor, 0.0, 1.0);
  if (cut != value.factor) {
    builder.warn(token.place, "coordinate " + numberText(value.factor) + " is taken as " +
                                  numberText(cut) + ", allowed: 0...1");
  }
  return {{cut}, shortest(cut)};
}

}  // namespace

const MdlMacro* findMacro(const std::string& keyword) {
  const auto found = std::find_if(kMacros.begin(), kMacros.end(),
                                  [&](const MdlMacro& m) { return keyword == m.keyword; });
  return found == kMacros.end() ? nullptr : &*found;
}

std::size_t macroModules(SceneBuilder& builder,
                         MdlNumbers& numbers,
                         const MdlLine& line,
                         const MdlDialect& dialect) {
  const MdlMacro* const macro = findMacro(line.keyword.text);
  if (macro == nullptr) {
    return 0;
  }
  Expansion expansion(builder, numbers, line, *macro);
  expansion.read(dialect);
  return expansion.modules();
}

void addMacro(SceneBuilder& builder,
              MdlNumbers& numbers,
              const MdlLine& line,
              const MdlDialect& dialect) {
  Expansion expansion(builder, numbers, line, *findMacro(line.keyword.text));
  expansion.read(dialect);
  expansion.write();
}

int macroPoint(SceneBuilder& builder, MdlNumbers& numbers, const MdlToken& at) {
  const std::string macro = at.text.substr(1);
  Connection connection;
  connection.place = at.place;
  connection.grid = builder.grid(macro, at.place);
  const bool is_row = builder.scene().grids[static_cast<std::size_t>(connection.grid)].rows == 1;
  const std::size_t wanted = is_row ? 1 : 2;
  if (at.at.size() != wanted) {
    builder.fail(at.place, quoted(at.text) + " has " + std::to_string(at.at.size()) +
                               " coordinates, allowed: " + std::to_string(wanted) + ", as in [" +
                               at.text + (is_row ? " 0.3]" : " 0.3 0.7]"));
  }
  // The first counts along X, which are the rows.
  const Fraction first = fraction(builder, numbers, at.at[0]);
  std::string name = macro + "@" + first.name;
  if (is_row) {
    connection.along.at = first.at;
  } else {
    const Fraction second = fraction(builder, numbers, at.at[1]);
    name += ":" + second.name;
    connection.across.at = first.at;
    connection.along.at = second.at;
  }
  const double sample_s = 1.0 / kMdlRateHz;
  connection.power = kPointEnergyPerSecond / (sample_s * sample_s);
  const int known = builder.findMat(name);
  return known >= 0 ? known : addPoint(builder, name, connection);
}

}  // namespace ergotic::scene
