// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <ergotic/ModelStructure.h>

namespace ergotic::panel {

/// Builds structures as a station sends them, with one section at first.
class StructureMaker {
 public:
  StructureMaker() { section(1); }

  StructureMaker& section(int dimensions) {
    geometry_msgs::Pose pose;
    pose.orientation.w = 1.0;
    structure.section_names.push_back("section " + std::to_string(structure.section_names.size()));
    structure.section_poses.push_back(pose);
    structure.section_dimensions.push_back(static_cast<std::uint8_t>(dimensions));
    return *this;
  }
  /// \return its index
  std::uint32_t module(std::uint8_t type, float x, float y, float z, const std::string& name = "") {
    const auto index = static_cast<std::uint32_t>(structure.module_names.size());
    structure.module_names.push_back(name.empty() ? "m" + std::to_string(index) : name);
    structure.module_types.push_back(type);
    structure.module_sections.push_back(
        static_cast<std::uint32_t>(structure.section_names.size() - 1));
    structure.rest_positions.insert(structure.rest_positions.end(), {x, y, z});
    return index;
  }
  void link(std::uint32_t a, std::uint32_t b) {
    structure.links.insert(structure.links.end(), {a, b});
    structure.link_types.push_back(0);
  }
  /// Along y, 1 cm apart. \return the first
  std::uint32_t row(std::uint32_t count, float z, const std::string& stem = "") {
    const auto type = stem.empty() ? ModelStructure::MASS : ModelStructure::POINT;
    const auto first = static_cast<std::uint32_t>(structure.module_names.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      module(type, 0.0F, 0.01F * static_cast<float>(i), z,
             stem.empty() ? "" : stem + std::to_string(i));
      if (i > 0) {
        link(first + i - 1, first + i);
      }
    }
    return first;
  }
  std::uint32_t string(std::uint32_t count, float z) {
    const std::uint32_t first = row(count, z);
    structure.string_names.push_back("string");
    structure.string_first.push_back(first);
    structure.string_count.push_back(count);
    return first;
  }
  /// In the y-z plane. \return the first
  std::uint32_t net(std::uint32_t rows, std::uint32_t columns, float width, float height) {
    const auto first = static_cast<std::uint32_t>(structure.module_names.size());
    for (std::uint32_t i = 0; i < rows * columns; ++i) {
      const std::uint32_t row = i / columns;
      const std::uint32_t column = i % columns;
      module(ModelStructure::MASS, 0.0F, width * static_cast<float>(column),
             height * static_cast<float>(row));
      if (column > 0) {
        link(first + i - 1, first + i);
      }
      if (row > 0) {
        link(first + i - columns, first + i);
      }
    }
    return first;
  }

  ModelStructure structure;
};

}  // namespace ergotic::panel
