// SPDX-License-Identifier: BSD-3-Clause
#include "sparse_order.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "ergotic/exception.hpp"

namespace ergotic::physics {
namespace {

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

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

/// Steps from a node to every other that it hangs together with.
class Distances {
 public:
  explicit Distances(int nodes) : steps_(at(nodes), -1) {}

  /// Forgets the last walk. \return the nodes reached, the nearest first; of one family those with
  /// few neighbours first
  const std::vector<int>& walk(const Neighbours& neighbours, int from) {
    for (const int node : reached_) {
      steps_[at(node)] = -1;
    }
    reached_.assign(1, from);
    steps_[at(from)] = 0;
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
    return reached_;
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
  Sweeper(int nodes, const std::vector<LinkEnds>& links)
      : neighbours_(nodes, links),
        from_end_(nodes),
        to_end_(nodes),
        from_side_(nodes),
        to_side_(nodes),
        across_(at(nodes)) {}

  /// Appends what hangs together with `node`.
  void append(int node, std::vector<int>& order) {
    walkFromEnd(node);
    to_end_.walk(neighbours_, from_end_.farthest());
    from_side_.walk(neighbours_, side());
    to_side_.walk(neighbours_, from_side_.farthest());
    std::vector<int> nodes = from_end_.reached();
    for (const int n : nodes) {
      across_[at(n)] = meanAcross(n);
    }
    std::stable_sort(nodes.begin(), nodes.end(), [&](int a, int b) {
      const int from_a = from_end_.to(a);
      const int from_b = from_end_.to(b);
      return from_a != from_b ? from_a < from_b : across_[at(a)] < across_[at(b)];
    });
    order.insert(order.end(), nodes.begin(), nodes.end());
  }

 private:
  /// From a node that is about as far as can be from the farthest one.
  void walkFromEnd(int node) {
    constexpr int kTurns = 4;
    int depth = -1;
    for (int turn = 0; turn < kTurns; ++turn) {
      from_end_.walk(neighbours_, node);
      const int farthest = from_end_.farthest();
      if (from_end_.to(farthest) <= depth) {
        return;
      }
      depth = from_end_.to(farthest);
      node = farthest;
    }
  }

  /// The node that lies most aside of the ways from end to end.
  int side() const {
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

  /// How far across a node lies: steps from one side less steps to the other, evened out among the
  /// neighbours, as many nodes of a level have the same.
  double meanAcross(int node) const {
    const auto across = [this](int n) { return from_side_.to(n) - to_side_.to(n); };
    double sum = 0.0;
    for (const int* to = neighbours_.begin(node); to != neighbours_.end(node); ++to) {
      sum += across(*to);
    }
    const auto count = static_cast<double>(neighbours_.count(node));
    return count == 0.0 ? 0.0 : across(node) + sum / count;
  }

  Neighbours neighbours_;
  Distances from_end_;
  Distances to_end_;
  Distances from_side_;
  Distances to_side_;
  std::vector<double> across_;  ///< [nodes]
};

}  // namespace

std::vector<int> sparseOrder(int nodes, const std::vector<LinkEnds>& links) {
  Sweeper sweeper(nodes, links);
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
