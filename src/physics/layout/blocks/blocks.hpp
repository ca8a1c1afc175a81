// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ergotic/scene/scene.hpp"

namespace ergotic::physics {

struct SparseProgram;

/// Modules of one section in consecutive slots, with the linear links among them, that kernels step
/// as arrays: a sweep moves the modules and then knows the forces of these links
/// (kernels/block_kernels.hpp). Everything else adds its forces to them afterwards.
struct Block {
  enum class Kind {
    kChains,   ///< chains side by side, one per lane: module i of lane j is i * kLanes + j
    kLattice,  ///< every link joins s and s + one of few offsets: strings, plates, nets
    kSparse,   ///< anything else
  };
  /// Elements that a kernel takes in one go; multiples of kLanes.
  struct Segment {
    int begin = 0;
    int end = 0;
    bool uniform = false;  ///< all links are there, with the coefficients of `reference`
  };

  Kind kind = Kind::kLattice;
  int section = 0;
  int first = 0;             ///< slot of the first element
  int guard = 0;             ///< slots before and after that are always 0
  int elements = 0;          ///< a multiple of kLanes
  std::vector<int> mats;     ///< [elements] -1: none, always 0; until slots are given
  std::vector<int> lias;     ///< links among them; until they are in runs
  std::vector<int> offsets;  ///< in elements, > 0; those of a plate first, else ascending
  /// [offsets] links side by side whose coefficients uniform segments share
  std::vector<std::vector<int>> reference;
  std::vector<Segment> segments;  ///< from the first free module to the last
  bool has_cells = false;         ///< or masses in a medium
  bool has_drift = false;         ///< constant forces or gravity
  bool has_bias = false;          ///< links that are not at rest where their modules are
  bool one_ratio = false;         ///< Z / K of all links is one number, whatever the parameters are
  int pitch = 0;          ///< > 0: the first diagonals are those of a plate with rows this long
  bool is_alone = false;  ///< nothing else acts on it while it runs: it goes through a tick alone
  bool per_lane = false;  ///< chains: all links of a lane have the same coefficients
  std::shared_ptr<const SparseProgram> program;  ///< of kSparse, links in the order of `lias`
  std::string shape;                             ///< for people: what it is and why
};

/// Describes what a block is and which kernels step it, for people.
std::string describeBlock(const Block& block);

/// The blocks of a scene: what is linear, scalar, inside one section, and regular enough. `first`
/// is not set yet. A module or link is in one block at most; the rest is stepped one by one.
std::vector<Block> findBlocks(const scene::Scene& scene);

}  // namespace ergotic::physics
