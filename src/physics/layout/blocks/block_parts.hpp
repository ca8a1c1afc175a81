// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "physics/layout/blocks/blocks.hpp"

/// Steps of findBlocks.
namespace ergotic::physics {

/// Free modules joined by linear links, with the grounds that only they are joined to.
struct Component {
  int section = 0;
  std::vector<int> mats;  ///< ascending
  std::vector<int> lias;
};

/// Components of all scalar sections that have links.
std::vector<Component> findComponents(const scene::Scene& scene);

/// The modules from one end to the other, if a component is a chain, else nothing.
/// \param places  [mats] index of each in its component's mats
std::vector<int> chainOrder(const scene::Scene& scene,
                            const Component& component,
                            const std::vector<int>& places);

/// Difference of places that links join, and how many do, the most frequent first.
struct OffsetCount {
  int offset = 0;
  int links = 0;
};
std::vector<OffsetCount> offsetsOf(const scene::Scene& scene,
                                   const Component& component,
                                   const std::vector<int>& places);

/// Finds what kernels need to know of a block's links and modules: the segments that are uniform,
/// cells, drift, bias, ratio. \pre kind, section, mats, lias and offsets are set
class Classifier {
 public:
  explicit Classifier(const scene::Scene& scene);
  void classify(Block& block);

 private:
  const scene::Scene& scene_;
  std::vector<int> element_;          // [mats] of the present block
  std::vector<unsigned char> heard_;  // [mats]
};

}  // namespace ergotic::physics
