// SPDX-License-Identifier: BSD-3-Clause
#include "physics/layout/blocks/sparse_order.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "at.hpp"
#include "ergotic/exception.hpp"

namespace ergotic::physics {
namespace {

/// The neighbours of each node, one list after the other.
class Neighbours {
 public:
  Neighbours(int nodes, const std::vector<LinkEnds>& links)
      : first_(at(nodes) + 1, 0), node_(2 * links.size()) {
    for (const LinkEnds& link : links) {
      check(link.a, nodes);
      check(link.b, nodes);
      ++first_[at(link.a) + 1];
      ++first_[at(link.b) + 1];
    }
    for (std::size_t n = 1; n < first_.size(); ++n) {
      first_[n] += first_[n - 1];
    }
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const LinkEnds& link : links) {
      node_[next[at(link.a)]++] = link.b;
      node_[next[at(link.b)]++] = link.a;
    }
  }
  const int* begin(int node) const { return node_.data() + first_[at(node)]; }
  const int* end(int node) const { return node_.data() + first_[at(node) + 1]; }
  std::size_t count(int node) const { return first_[at(node) + 1] - first_[at(node)]; }

 private:
  static void check(int node, int nodes) {
    if (node < 0 || node >= nodes) {
      throw Exception("link to node " + std::to_string(node) + " of a network of 0..." +
                      std::to_string(nodes - 1));
    }
  }
  std::vector<std::size_t> first_;
  std::vector<int> node_;
};

/// Steps from some nodes to every other that they are joined with.
class Distances {
 public:
  explicit Distances(int nodes) : steps_(at(nodes), -1) {}

  /// Forgets the last walk; reaches the nearest first, of one family those with few neighbours.
  void walk(const Neighbours& neighbours, const std::vector<int>& from) {
    for (const int node : reached_) {
      steps_[at(node)] = -1;
    }
    reached_ = from;
    for (const int node : from) {
      steps_[at(node)] = 0;
    }
    for (std::size_t i = 0; i < reached_.size(); ++i) {
      const int node = reached_[i];
      const std::size_t family = reached_.size();
      for (const int* to = neighbours.begin(node); to != neighbours.end(node); ++to) {
        if (steps_[at(*to)] < 0) {
          steps_[at(*to)] = steps_[at(node)] + 1;
          reached_.push_back(*to);
        }
      }
      std::sort(reached_.begin() + static_cast<std::ptrdiff_t>(family), reached_.end(),
                [&](int a, int b) {
                  const std::size_t of_a = neighbours.count(a);
                  const std::size_t of_b = neighbours.count(b);
                  return of_a != of_b ? of_a < of_b : a < b;
                });
    }
  }
  const std::vector<int>& reached() const { return reached_; }
  int to(int node) const { return steps_[at(node)]; }
  int farthest() const { return reached_.back(); }

 private:
  std::vector<int> steps_;
  std::vector<int> reached_;
};

/// Orders one network after the other.
class Sweeper {
 public:
  Sweeper(int nodes, const std::vector<LinkEnds>& links, SparseSweep sweep)
      : sweep_(sweep),
        neighbours_(nodes, links),
        from_end_(nodes),
        to_end_(nodes),
        from_corner_(nodes),
        other_(nodes),
        across_(at(nodes)) {}

  /// Appends what is joined with `node`.
  void append(int node, std::vector<int>& order) {
    walkFromEnd(node);
    to_end_.walk(neighbours_, {from_end_.farthest()});
    const int corner = mostAside();
    from_corner_.walk(neighbours_, {corner});
    const bool from_side = sweep_ == SparseSweep::kFromSide;
    other_.walk(neighbours_,
                from_side ? sideFrom(corner) : std::vector<int>{from_corner_.farthest()});
    const Distances& level = from_side ? other_ : from_end_;
    const Distances& opposite = from_side ? from_end_ : other_;
    std::vector<int> nodes = level.reached();
    for (const int n : nodes) {
      across_[at(n)] = meanAcross(opposite, n);
    }
    std::stable_sort(nodes.begin(), nodes.end(), [&](int a, int b) {
      const int of_a = level.to(a);
      const int of_b = level.to(b);
      return of_a != of_b ? of_a < of_b : across_[at(a)] < across_[at(b)];
    });
    order.insert(order.end(), nodes.begin(), nodes.end());
  }

 private:
  /// Walks from a peripheral node: one about as far from the farthest one as any node can be.
  void walkFromEnd(int node) {
    constexpr int kTurns = 4;
    int depth = -1;
    for (int turn = 0; turn < kTurns; ++turn) {
      from_end_.walk(neighbours_, {node});
      const int farthest = from_end_.farthest();
      if (from_end_.to(farthest) <= depth) {
        return;
      }
      depth = from_end_.to(farthest);
      node = farthest;
    }
  }

  /// The node that lies most aside of the ways from end to end.
  int mostAside() const {
    int best = from_end_.reached().front();
    int most = 0;
    for (const int node : from_end_.reached()) {
      const int from = from_end_.to(node);
      const int to = to_end_.to(node);
      const int aside = std::min(from, to) - std::abs(from - to);
      if (aside > most) {
        best = node;
        most = aside;
      }
    }
    return best;
  }

  /// The shortest way from a corner to the first end that keeps away from the other end, and to
  /// nodes with few neighbours: along the rim.
  std::vector<int> sideFrom(int corner) const {
    std::vector<int> side{corner};
    while (from_end_.to(side.back()) > 0) {
      const int here = side.back();
      int best = -1;
      for (const int* to = neighbours_.begin(here); to != neighbours_.end(here); ++to) {
        if (from_end_.to(*to) < from_end_.to(here) && (best < 0 || isRather(*to, best))) {
          best = *to;
        }
      }
      side.push_back(best);
    }
    return side;
  }
  bool isRather(int node, int than) const {
    const int away = to_end_.to(node) - to_end_.to(than);
    return away != 0 ? away > 0 : neighbours_.count(node) < neighbours_.count(than);
  }

  /// How far across a node lies: steps from the corner less steps from what is opposite, evened out
  /// among the neighbours, as many nodes of a level have the same.
  double meanAcross(const Distances& opposite, int node) const {
    const auto across = [&](int n) { return from_corner_.to(n) - opposite.to(n); };
    double sum = 0.0;
    for (const int* to = neighbours_.begin(node); to != neighbours_.end(node); ++to) {
      sum += across(*to);
    }
    const auto count = static_cast<double>(neighbours_.count(node));
    return count == 0.0 ? 0.0 : across(node) + sum / count;
  }

  SparseSweep sweep_;
  Neighbours neighbours_;
  Distances from_end_;
  Distances to_end_;
  Distances from_corner_;
  Distances other_;             ///< distances from a side, or from the corner opposite
  std::vector<double> across_;  ///< [nodes]
};

}  // namespace

std::vector<int> sparseOrder(int nodes, const std::vector<LinkEnds>& links, SparseSweep sweep) {
  Sweeper sweeper(nodes, links, sweep);
  std::vector<int> order;
  order.reserve(at(nodes));
  std::vector<bool> done(at(nodes), false);
  for (int node = 0; node < nodes; ++node) {
    if (done[at(node)]) {
      continue;
    }
    const std::size_t first = order.size();
    sweeper.append(node, order);
    for (std::size_t i = first; i < order.size(); ++i) {
      done[at(order[i])] = true;
    }
  }
  return order;
}

}  // namespace ergotic::physics
