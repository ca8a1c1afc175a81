// SPDX-License-Identifier: BSD-3-Clause
#include "physics/layout/blocks/sparse_program.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cstdlib>
#include <numeric>
#include <string>
#include <utility>

#include "at.hpp"
#include "ergotic/exception.hpp"
#include "physics/layout/blocks/sparse_order.hpp"

namespace ergotic::physics {
namespace {

/// Time of a slot of picks, and of having any in a group, in slots of windows. As measured with
/// AVX-512 for float, a little less, as windows gain less for double and at other levels.
constexpr double kPickCost = 1.7;
constexpr double kPickStart = 5.0;

/// A neighbour of a node of the group at hand.
struct Side {
  int lane = 0;
  int node = 0;
  std::size_t* where = nullptr;  ///< where to store the index of its coefficients
  int window = -1;               ///< window that serves it, index in windows of the group
  int block() const { return node / kLanes; }
};

/// Serves two blocks, one neighbour of each lane.
struct Window {
  int block = 0;  ///< first
  std::bitset<kLanes> lanes;
  bool given_up = false;  ///< its neighbours are picked
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
    serve(sides);
    giveUpEmpty();
    writeWindows(group, sides);
    writePicks(group, sides);
    program_.first_window.push_back(static_cast<std::uint32_t>(program_.window.size()));
    program_.first_pick.push_back(static_cast<std::uint32_t>(program_.pick.size() / kLanes));
  }
  SparseProgram take() { return std::move(program_); }

 private:
  /// Serves all neighbours with the fewest windows: each begins with the first block that is left,
  /// and takes of each lane the first neighbour that is left in this block and the next.
  void serve(std::vector<Side>& sides) {
    windows_.clear();
    for (std::size_t first = 0; first < sides.size(); ++first) {
      if (sides[first].window >= 0) {
        continue;
      }
      Window window{sides[first].block(), {}, false};
      for (std::size_t s = first; s < sides.size() && sides[s].block() <= window.block + 1; ++s) {
        if (sides[s].window < 0 && !window.lanes[at(sides[s].lane)]) {
          sides[s].window = static_cast<int>(windows_.size());
          window.lanes.set(at(sides[s].lane));
        }
      }
      windows_.push_back(window);
    }
  }

  /// Gives up as many of the emptiest windows as make the group cheapest.
  void giveUpEmpty() {
    emptiest_.resize(windows_.size());
    std::iota(emptiest_.begin(), emptiest_.end(), std::size_t{0});
    std::stable_sort(emptiest_.begin(), emptiest_.end(), [this](std::size_t a, std::size_t b) {
      return windows_[a].lanes.count() < windows_[b].lanes.count();
    });
    std::array<int, kLanes> picks{};
    int most_picks = 0;
    auto least = static_cast<double>(windows_.size());
    std::size_t given_up = 0;
    for (std::size_t n = 0; n < emptiest_.size(); ++n) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        picks[lane] += windows_[emptiest_[n]].lanes[lane] ? 1 : 0;
        most_picks = std::max(most_picks, picks[lane]);
      }
      const double cost =
          static_cast<double>(windows_.size() - n - 1) + kPickStart + kPickCost * most_picks;
      if (cost < least) {
        least = cost;
        given_up = n + 1;
      }
    }
    for (std::size_t n = 0; n < given_up; ++n) {
      windows_[emptiest_[n]].given_up = true;
    }
  }

  void writeWindows(int group, const std::vector<Side>& sides) {
    slot_of_window_.resize(windows_.size());
    for (std::size_t w = 0; w < windows_.size(); ++w) {
      slot_of_window_[w] = program_.window.size();
      if (!windows_[w].given_up) {
        // The window of the last block begins one earlier, so that it ends with the nodes.
        const int block = std::max(0, std::min(windows_[w].block, program_.groups - 2));
        program_.window.push_back(static_cast<std::uint32_t>(block * kLanes));
      }
    }
    program_.lane.resize(program_.window.size() * kLanes, 0);
    for (const Side& side : sides) {
      if (!windows_[at(side.window)].given_up) {
        const std::size_t slot = slot_of_window_[at(side.window)];
        program_.lane[slot * kLanes + at(side.lane)] =
            static_cast<std::uint8_t>(at(side.node) - program_.window[slot]);
        *side.where = (slot + program_.first_pick[at(group)]) * kLanes + at(side.lane);
      }
    }
  }

  void writePicks(int group, const std::vector<Side>& sides) {
    const std::size_t first = program_.pick.size() / kLanes;
    std::array<int, kLanes> picks{};
    for (const Side& side : sides) {
      if (!windows_[at(side.window)].given_up) {
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
  // Of the group at hand:
  std::vector<Window> windows_;
  std::vector<std::size_t> emptiest_;
  std::vector<std::size_t> slot_of_window_;
};

void check(int node, int nodes) {
  if (node < 0 || node >= nodes) {
    throw Exception("link to node " + std::to_string(node) + " of a network of 0..." +
                    std::to_string(nodes - 1));
  }
}

/// The neighbours of the nodes of each group.
std::vector<std::vector<Side>> sidesOfGroups(int nodes,
                                             const std::vector<LinkEnds>& links,
                                             std::vector<SparseProgram::Sides>& where) {
  std::vector<std::size_t> count(at((nodes + kLanes - 1) / kLanes), 0);
  for (const LinkEnds& link : links) {
    check(link.a, nodes);
    check(link.b, nodes);
    ++count[at(link.a / kLanes)];
    ++count[at(link.b / kLanes)];
  }
  std::vector<std::vector<Side>> of_group(count.size());
  for (std::size_t g = 0; g < count.size(); ++g) {
    of_group[g].reserve(count[g]);
  }
  for (std::size_t l = 0; l < links.size(); ++l) {
    const auto [a, b] = links[l];
    of_group[at(a / kLanes)].push_back({a % kLanes, b, &where[l].a, -1});
    of_group[at(b / kLanes)].push_back({b % kLanes, a, &where[l].b, -1});
  }
  return of_group;
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
  std::vector<std::vector<Side>> of_group = sidesOfGroups(nodes, links, writer.sides());
  for (std::size_t g = 0; g < of_group.size(); ++g) {
    writer.add(static_cast<int>(g), of_group[g]);
  }
  SparseProgram program = writer.take();
  for (const auto& [a, b] : links) {
    program.span = std::max(program.span, std::abs(a / kLanes - b / kLanes));
  }
  program.present.assign(program.slots(), 0);
  for (const SparseProgram::Sides& sides : program.sides) {
    for (const std::size_t where : {sides.a, sides.b}) {
      program.present[where / kLanes] |= static_cast<std::uint16_t>(1U << (where % kLanes));
    }
  }
  return program;
}

SparsePlan planSparse(int nodes, const std::vector<LinkEnds>& links) {
  SparsePlan best{std::vector<int>(at(nodes)), makeSparseProgram(nodes, links)};
  std::iota(best.order.begin(), best.order.end(), 0);
  std::vector<int> place(at(nodes));
  std::vector<LinkEnds> moved(links.size());
  for (const SparseSweep sweep : {SparseSweep::kFromEnd, SparseSweep::kFromSide}) {
    std::vector<int> order = sparseOrder(nodes, links, sweep);
    for (std::size_t i = 0; i < place.size(); ++i) {
      place[at(order[i])] = static_cast<int>(i);
    }
    std::transform(links.begin(), links.end(), moved.begin(), [&](const LinkEnds& link) {
      return LinkEnds{place[at(link.a)], place[at(link.b)]};
    });
    SparseProgram program = makeSparseProgram(nodes, moved);
    if (program.cost() < best.program.cost()) {
      best = {std::move(order), std::move(program)};
    }
  }
  return best;
}

}  // namespace ergotic::physics
