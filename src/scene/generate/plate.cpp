// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/plate.hpp"

#include <utility>
#include <vector>

#include "at.hpp"
#include "scene/generate/bend.hpp"
#include "scene/generate/generated.hpp"
#include "scene/generate/sheet.hpp"

namespace ergotic::scene {
namespace {

/// Elements and losses as docs/physics/bodies.md has them, Bars and plates.
class Plate {
 public:
  Plate(SceneBuilder& builder, const PlateSpec& spec)
      : builder_(builder), spec_(spec), bend_stem_(spec.name + ".bend.") {}

  void add() {
    Tuning body = beginBody(builder_, spec_.name, spec_.place);
    first_ = body.first_mat;
    body.rigid = isFree() ? 3 : 0;
    addMats();
    if (isFree()) {
      addFreeBends();
      addTwists();
    } else {
      addCrosses();
    }
    addLinks();
    addHardLinks();
    finishBody(builder_, std::move(body), spec_.wish);
  }

 private:
  bool isFree() const { return spec_.edges == PlateEdges::kFree; }
  bool isEdge(int row, int column) const {
    return row == 0 || column == 0 || row == spec_.rows - 1 || column == spec_.columns - 1;
  }
  bool moves(int row, int column) const { return isFree() || !isEdge(row, column); }
  int matAt(int row, int column) const { return first_ + row * spec_.columns + column; }

  void addMats() {
    const int moving =
        isFree() ? spec_.rows * spec_.columns : (spec_.rows - 2) * (spec_.columns - 2);
    const Sheet sheet{spec_.name,    spec_.section, spec_.rows, spec_.columns,
                      spec_.spacing, spec_.at,      spec_.place};
    addSheet(builder_, sheet, spec_.wish,
             [&](int row, int column) { return moves(row, column) ? spec_.mass / moving : 0.0; });
  }

  void addBendOf(const std::vector<Bend::End>& ends, double share) {
    if (share == 0.0) {
      return;
    }
    Bend bend;
    bend.name = bend_stem_.numbered(bends_++);
    bend.ends = ends;
    bend.stiffness.factor = share * spec_.mass;
    bend.place = spec_.place;
    addBend(builder_, std::move(bend));
  }

  void addCross(int row, int column, double share) {
    addBendOf({{matAt(row, column - 1), 1.0},
               {matAt(row - 1, column), 1.0},
               {matAt(row, column), -4.0},
               {matAt(row + 1, column), 1.0},
               {matAt(row, column + 1), 1.0}},
              share);
  }
  void addCrosses() {
    for (int row = 1; row + 1 < spec_.rows; ++row) {
      for (int column = 1; column + 1 < spec_.columns; ++column) {
        addCross(row, column, 1.0);
      }
    }
  }

  void addFreeBends() {
    const double nu = spec_.poisson;
    for (int row = 0; row < spec_.rows; ++row) {
      for (int column = 0; column < spec_.columns; ++column) {
        const bool row_edge = row == 0 || row == spec_.rows - 1;
        const bool column_edge = column == 0 || column == spec_.columns - 1;
        if (!column_edge) {
          addBendOf({{matAt(row, column - 1), 1.0},
                     {matAt(row, column), -2.0},
                     {matAt(row, column + 1), 1.0}},
                    row_edge ? 1.0 - nu * nu : 1.0 - nu);
        }
        if (!row_edge) {
          addBendOf({{matAt(row - 1, column), 1.0},
                     {matAt(row, column), -2.0},
                     {matAt(row + 1, column), 1.0}},
                    column_edge ? 1.0 - nu * nu : 1.0 - nu);
        }
        if (!row_edge && !column_edge) {
          addCross(row, column, nu);
        }
      }
    }
  }

  /// Adds a bend against twist in each cell; stiffer in those at an edge, whose outer half has
  /// none.
  void addTwists() {
    for (int row = 0; row + 1 < spec_.rows; ++row) {
      for (int column = 0; column + 1 < spec_.columns; ++column) {
        const double area = (row == 0 || row == spec_.rows - 2 ? 1.5 : 1.0) *
                            (column == 0 || column == spec_.columns - 2 ? 1.5 : 1.0);
        addBendOf({{matAt(row, column), 1.0},
                   {matAt(row, column + 1), -1.0},
                   {matAt(row + 1, column), -1.0},
                   {matAt(row + 1, column + 1), 1.0}},
                  2.0 * (1.0 - spec_.poisson) * area);
      }
    }
  }

  /// Calls `each` with row and column of every module and of the next in each direction, unless
  /// both are grounds.
  template <class Each>
  void forEachPair(const Each& each) const {
    for (int row = 0; row < spec_.rows; ++row) {
      for (int column = 0; column < spec_.columns; ++column) {
        for (const auto& [to_row, to_column] :
             {std::pair{row, column + 1}, std::pair{row + 1, column}}) {
          if (to_row < spec_.rows && to_column < spec_.columns &&
              (moves(row, column) || moves(to_row, to_column))) {
            each(row, column, to_row, to_column);
          }
        }
      }
    }
  }

  /// Adds the links that stretch, beside those that bend, with D = K a^2 = E t^3/(12 (1 - nu^2)): a
  /// link that is drawn by e across a is longer by e^2/2a, which stores 6 K/t^2 e^4/4. By the mean
  /// over all places (Berger 1955) it is (3 K/(2 n t^2)) (sum e^2)^2, n the number of cells.
  void addHardLinks() {
    HardLinks links(builder_, spec_.name, spec_.hardening, spec_.place);
    if (spec_.hardening == Hardening::kNone) {
      return;
    }
    int pairs = 0;
    forEachPair([&](int, int, int, int) { ++pairs; });
    const int cells =
        isFree() ? spec_.rows * spec_.columns : (spec_.rows - 1) * (spec_.columns - 1);
    const double share =
        spec_.hardening == Hardening::kLocal ? 1.0 : static_cast<double>(pairs) / cells;
    const double nonlinearity = 6.0 * share * spec_.mass / (spec_.thickness * spec_.thickness);
    forEachPair([&](int row, int column, int to_row, int to_column) {
      links.add(matAt(row, column), matAt(to_row, to_column), nonlinearity);
    });
  }

  /// Adds links to the next column and row: dampers, and at a clamped edge, beyond which the plate
  /// is its own mirror image, a spring of twice the stiffness of a bend.
  void addLinks() {
    const bool is_damped = spec_.wish.t60.size() > 1;
    const Name stem = linkStem(spec_.name);
    forEachPair([&](int row, int column, int to_row, int to_column) {
      const bool at_ground = !moves(row, column) || !moves(to_row, to_column);
      const bool is_held = at_ground && spec_.edges == PlateEdges::kClamped;
      if (!is_damped && !is_held) {
        return;
      }
      Lia lia =
          generatedLink(stem, links_++, matAt(row, column), matAt(to_row, to_column), spec_.place);
      lia.stiffness.factor = is_held ? 2.0 * spec_.mass : 0.0;
      lia.damping.factor = is_damped ? spec_.mass : 0.0;
      builder_.add(std::move(lia));
    });
  }

  SceneBuilder& builder_;
  const PlateSpec& spec_;
  Name bend_stem_;
  int first_ = 0;
  int bends_ = 0;
  int links_ = 0;
};

}  // namespace

void addPlate(SceneBuilder& builder, const PlateSpec& spec) {
  Plate(builder, spec).add();
}

}  // namespace ergotic::scene
