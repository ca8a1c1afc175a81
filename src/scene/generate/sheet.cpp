// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/sheet.hpp"

#include <utility>

#include "at.hpp"
#include "scene/generate/generated.hpp"

namespace ergotic::scene {

void addSheet(SceneBuilder& builder,
              const Sheet& sheet,
              const BodyWish& wish,
              const std::function<double(int row, int column)>& mass_at) {
  builder.reserve(at(sheet.rows) * at(sheet.columns), 0, sheet.place);
  const auto first = static_cast<int>(builder.scene().mats.size());
  const Name stem(sheet.name + ".");
  for (int row = 0; row < sheet.rows; ++row) {
    for (int column = 0; column < sheet.columns; ++column) {
      const Eigen::Vector3d rest = sheet.at + sheet.spacing * Eigen::Vector3d(0.0, column, row);
      Mat mat = generatedMat(builder, sheet.section, stem.numbered(row, column), rest, sheet.place);
      const double mass = mass_at(row, column);
      mat.type = mass > 0.0 ? massTypeOf(wish) : MatType::kGround;
      mat.matched = mat.type == MatType::kCell;
      mat.mass.factor = mass > 0.0 ? mass : 1.0;
      builder.add(std::move(mat));
    }
  }
  builder.add(Grid{sheet.name, first, sheet.columns, sheet.rows, sheet.place});
}

}  // namespace ergotic::scene
