// SPDX-License-Identifier: BSD-3-Clause
#include "sparse_program.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <utility>

#include "ergotic/exception.hpp"
#include "sparse_order.hpp"

namespace ergotic::physics {
namespace {

constexpr int kLanes = SparseProgram::kLanes;
/// Time of a slot of picks, and of having any in a group, in slots of windows (measured, AVX-512).
constexpr double kPickCost = 2.3;
constexpr double kPickStart = 5.0;

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

/// A neighbour of a node of the group at hand.
struct Side {
  int lane = 0;
  int node = 0;
  std::size_t* where = nullptr;  ///< of its coefficients
  int window = -1;               ///< that serves it, index in windows of the group
  int block() const { return node / kLanes; }
};

/// Writes the slots of one group after the other.
class Writer {
 public:
  Writer(int nodes, std::size_t links) {
    program_.nodes = nodes;
    program_.groups = (nodes + kLanes - 1) / kLanes;
    program_.first_window.push_back(0);
    program_.first_pick.push_back(0);
    program_.sides.resize(links);
  }
  std::vector<SparseProgram::Sides>& sides() { return program_.sides; }

  void add(int group, std::vector<Side>& sides) {
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      return a.node != b.node ? a.node < b.node : a.where < b.where;
    });
    const std::vector<int> windows = serve(sides);
    const std::vector<int> kept = keepFull(windows.size(), sides);
    writeWindows(group, windows, kept, sides);
    writePicks(group, sides);
    program_.first_window.push_back(static_cast<std::uint32_t>(program_.window.size()));
    program_.first_pick.push_back(static_cast<std::uint32_t>(program_.pick.size() / kLanes));
  }
  SparseProgram take() { return std::move(program_); }

 private:
  /// Serves all neighbours with the fewest windows: each begins with the first block that is left,
  /// and takes of each lane the first neighbour that is left in this block and the next.
  /// \return first block of each window
  static std::vector<int> serve(std::vector<Side>& sides) {
    std::vector<int> windows;
    for (std::size_t first = 0; first < sides.size(); ++first) {
      if (sides[first].window >= 0) {
        continue;
      }
      const int block = sides[first].block();
      std::array<bool, kLanes> taken{};
      for (std::size_t s = first; s < sides.size() && sides[s].block() <= block + 1; ++s) {
        if (sides[s].window < 0 && !taken[at(sides[s].lane)]) {
          sides[s].window = static_cast<int>(windows.size());
          taken[at(sides[s].lane)] = true;
        }
      }
      windows.push_back(block);
    }
    return windows;
  }

  /// Gives up the emptiest windows as long as picks are cheaper.
  /// \return new number of each window, -1: its neighbours are picked
  static std::vector<int> keepFull(std::size_t windows, const std::vector<Side>& sides) {
    std::vector<int> filled(windows, 0);
    for (const Side& side : sides) {
      ++filled[at(side.window)];
    }
    std::vector<std::vector<int>> lanes(windows);
    for (const Side& side : sides) {
      lanes[at(side.window)].push_back(side.lane);
    }
    std::vector<int> emptiest(windows);
    std::iota(emptiest.begin(), emptiest.end(), 0);
    std::stable_sort(emptiest.begin(), emptiest.end(),
                     [&](int a, int b) { return filled[at(a)] < filled[at(b)]; });
    std::array<int, kLanes> picks{};
    double least = static_cast<double>(windows);
    std::size_t given_up = 0;
    for (std::size_t n = 0; n < windows; ++n) {
      for (const int lane : lanes[at(emptiest[n])]) {
        ++picks[at(lane)];
      }
      const double cost = static_cast<double>(windows - n - 1) + kPickStart +
                          kPickCost * *std::max_element(picks.begin(), picks.end());
      if (cost < least) {
        least = cost;
        given_up = n + 1;
      }
    }
    std::vector<int> kept(windows, 0);
    for (std::size_t n = 0; n < given_up; ++n) {
      kept[at(emptiest[n])] = -1;
    }
    int next = 0;
    for (int& number : kept) {
      number = number < 0 ? -1 : next++;
    }
    return kept;
  }

  void writeWindows(int group,
                    const std::vector<int>& windows,
                    const std::vector<int>& kept,
                    std::vector<Side>& sides) {
    const std::size_t first = program_.window.size();
    for (std::size_t w = 0; w < windows.size(); ++w) {
      if (kept[w] >= 0) {
        // The window of the last block begins one earlier, so that it ends with the nodes.
        const int block = std::max(0, std::min(windows[w], program_.groups - 2));
        program_.window.push_back(static_cast<std::uint32_t>(block * kLanes));
      }
    }
    program_.lane.resize(program_.window.size() * kLanes, 0);
    for (Side& side : sides) {
      side.window = kept[at(side.window)];
      if (side.window >= 0) {
        const std::size_t slot = first + at(side.window);
        program_.lane[slot * kLanes + at(side.lane)] =
            static_cast<std::uint8_t>(at(side.node) - program_.window[slot]);
        *side.where = (slot + program_.first_pick[at(group)]) * kLanes + at(side.lane);
      }
    }
  }

  void writePicks(int group, std::vector<Side>& sides) {
    const std::size_t first = program_.pick.size() / kLanes;
    std::array<int, kLanes> picks{};
    for (Side& side : sides) {
      if (side.window >= 0) {
        continue;
      }
      const std::size_t slot = first + at(picks[at(side.lane)]++);
      if ((slot + 1) * kLanes > program_.pick.size()) {
        for (int lane = 0; lane < kLanes; ++lane) {  // those without a neighbour pick themselves
          program_.pick.push_back(static_cast<std::uint32_t>(group * kLanes + lane));
        }
      }
      program_.pick[slot * kLanes + at(side.lane)] = static_cast<std::uint32_t>(side.node);
      *side.where = (slot + program_.window.size()) * kLanes + at(side.lane);
    }
  }

  SparseProgram program_;
};

void check(int node, int nodes) {
  if (node < 0 || node >= nodes) {
    throw Exception("link to node " + std::to_string(node) + " of a network of 0..." +
                    std::to_string(nodes - 1));
  }
}

}  // namespace

double SparseProgram::cost() const {
  double sum =
      static_cast<double>(window.size()) + kPickCost * static_cast<double>(pick.size() / kLanes);
  for (std::size_t g = 0; g < at(groups); ++g) {
    sum += first_pick[g + 1] > first_pick[g] ? kPickStart : 0.0;
  }
  return sum;
}

SparseProgram makeSparseProgram(int nodes, const std::vector<LinkEnds>& links) {
  Writer writer(nodes, links.size());
  std::vector<std::vector<Side>> of_group(at((nodes + kLanes - 1) / kLanes));
  for (std::size_t l = 0; l < links.size(); ++l) {
    const auto [a, b] = links[l];
    check(a, nodes);
    check(b, nodes);
    of_group[at(a / kLanes)].push_back({a % kLanes, b, &writer.sides()[l].a});
    of_group[at(b / kLanes)].push_back({b % kLanes, a, &writer.sides()[l].b});
  }
  for (std::size_t g = 0; g < of_group.size(); ++g) {
    writer.add(static_cast<int>(g), of_group[g]);
  }
  SparseProgram program = writer.take();
  program.present.assign(program.slots(), 0);
  for (const SparseProgram::Sides& sides : program.sides) {
    for (const std::size_t where : {sides.a, sides.b}) {
      program.present[where / kLanes] |= static_cast<std::uint16_t>(1U << (where % kLanes));
    }
  }
  return program;
}

SparsePlan planSparse(int nodes, const std::vector<LinkEnds>& links) {
  SparsePlan given{std::vector<int>(at(nodes)), makeSparseProgram(nodes, links)};
  std::iota(given.order.begin(), given.order.end(), 0);
  SparsePlan swept{sparseOrder(nodes, links), {}};
  std::vector<int> place(at(nodes));
  for (std::size_t i = 0; i < place.size(); ++i) {
    place[at(swept.order[i])] = static_cast<int>(i);
  }
  std::vector<LinkEnds> moved = links;
  for (LinkEnds& link : moved) {
    link = {place[at(link.a)], place[at(link.b)]};
  }
  swept.program = makeSparseProgram(nodes, moved);
  return swept.program.cost() < given.program.cost() ? std::move(swept) : std::move(given);
}

}  // namespace ergotic::physics
