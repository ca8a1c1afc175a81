// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "physics/layout/blocks/sparse_program.hpp"

/// Irregular networks for the tests of sparse programs and kernels.
namespace ergotic::physics {

inline std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

struct SparseNetwork {
  std::string name;
  int nodes = 0;
  std::vector<LinkEnds> links;
};

/// Squares with one random diagonal each, as nets of triangles; nodes in random order.
inline SparseNetwork meshOf(int side, unsigned seed) {
  std::mt19937 random(seed);
  SparseNetwork mesh{"mesh " + std::to_string(side), side * side, {}};
  std::vector<int> id(at(mesh.nodes));
  std::iota(id.begin(), id.end(), 0);
  std::shuffle(id.begin(), id.end(), random);
  const auto node = [&](int row, int column) { return id[at(row * side + column)]; };
  for (int r = 0; r < side; ++r) {
    for (int c = 0; c < side; ++c) {
      if (c + 1 < side) {
        mesh.links.push_back({node(r, c), node(r, c + 1)});
      }
      if (r + 1 < side) {
        mesh.links.push_back({node(r, c), node(r + 1, c)});
      }
      if (r + 1 < side && c + 1 < side) {
        mesh.links.push_back(random() % 2 == 0 ? LinkEnds{node(r, c), node(r + 1, c + 1)}
                                               : LinkEnds{node(r, c + 1), node(r + 1, c)});
      }
    }
  }
  return mesh;
}

/// Any node with any other; with few nodes, some twice, and some with nobody.
inline SparseNetwork randomOf(int nodes, int links, unsigned seed) {
  std::mt19937 random(seed);
  SparseNetwork net{"random " + std::to_string(nodes) + " " + std::to_string(links), nodes, {}};
  const auto any = [&] { return static_cast<int>(random() % static_cast<unsigned>(nodes)); };
  while (net.links.size() < at(links)) {
    const LinkEnds link{any(), any()};
    if (link.a != link.b) {
      net.links.push_back(link);
    }
  }
  return net;
}

inline SparseNetwork starOf(int rays) {
  SparseNetwork star{"star " + std::to_string(rays), rays + 1, {}};
  for (int i = 0; i < rays; ++i) {
    star.links.push_back({i, rays});
  }
  return star;
}

inline std::vector<SparseNetwork> networks() {
  std::vector<SparseNetwork> all{meshOf(5, 1),
                                 meshOf(40, 2),
                                 randomOf(3, 9, 3),
                                 randomOf(30, 20, 4),
                                 randomOf(500, 1500, 5),
                                 randomOf(3000, 9000, 6),
                                 starOf(3),
                                 starOf(300),
                                 {"lone node", 1, {}},
                                 {"nothing", 0, {}},
                                 {"apart", 100, {}},
                                 {"parallel", 40, std::vector<LinkEnds>(5, LinkEnds{7, 33})}};
  SparseNetwork mixed = meshOf(40, 7);  // a mesh with strays: windows and picks
  mixed.name = "mixed";
  for (const LinkEnds& link : randomOf(mixed.nodes, 400, 8).links) {
    mixed.links.push_back(link);
  }
  all.push_back(mixed);
  return all;
}

inline SparseNetwork inOrder(const SparseNetwork& net, const std::vector<int>& order) {
  std::vector<int> place(at(net.nodes));
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[at(order[i])] = static_cast<int>(i);
  }
  SparseNetwork moved = net;
  for (LinkEnds& link : moved.links) {
    link = {place[at(link.a)], place[at(link.b)]};
  }
  return moved;
}

}  // namespace ergotic::physics
