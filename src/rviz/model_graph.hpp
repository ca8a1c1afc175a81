// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>
#include <ergotic/ModelStructure.h>

namespace ergotic::panel {

using ModuleIndices = std::vector<std::uint32_t>;

/// Whether all lists of a structure have the lengths that they must have, and all indices are of
/// something.
bool isConsistent(const ModelStructure& structure);

/// Whether a module is a mode of a body whose outline is in the structure as well. Such a mode has
/// no place of its own in a picture.
/// \return [modules]; empty if names and types do not fit each other
std::vector<bool> modesOfOutlines(const ModelStructure& structure);

/// Whether a module is a place on the outline of a body. \return [modules]
std::vector<bool> placesOfOutlines(const ModelStructure& structure);

/// Rest position of a module in frame `model`, m.
Eigen::Vector3f restOf(const ModelStructure& structure, std::size_t module);

/// The neighbours of each module: those that a link of the structure joins to it and that lie in
/// the same section at another place. A link that passes over a module between its ends, as those
/// of stiff strings and bars do, joins no neighbours, nor does one that only touches, as a hammer
/// does. Grounds at the rim of a skin are neighbours
/// without a link, as nothing moves between them.
class LinkGraph {
 public:
  /// \param joins  says which modules take part. \pre isConsistent(structure)
  LinkGraph(const ModelStructure& structure, const std::function<bool(std::size_t)>& joins);

  /// Sorted.
  const ModuleIndices& of(std::size_t module) const { return neighbours_[module]; }
  std::size_t modules() const { return neighbours_.size(); }
  bool areNeighbours(std::uint32_t a, std::uint32_t b) const;
  /// Whether a link passes over this module.
  bool isBridged(std::size_t module) const { return is_bridged_[module]; }

 private:
  void dropBridges(const ModelStructure& structure);
  void joinRims(const ModelStructure& structure);
  void sortOut();

  std::vector<ModuleIndices> neighbours_;
  std::vector<bool> is_bridged_;
};

}  // namespace ergotic::panel
