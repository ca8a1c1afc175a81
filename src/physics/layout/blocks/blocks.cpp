// SPDX-License-Identifier: BSD-3-Clause
#include "physics/layout/blocks/blocks.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <utility>

#include "at.hpp"
#include "physics/layout/blocks/block_parts.hpp"
#include "physics/layout/blocks/lanes.hpp"
#include "physics/layout/blocks/sparse_program.hpp"

namespace ergotic::physics {
namespace {

// Costs in vectors of kLanes elements, measured (docs/performance.md): side by side pays from here
// on. The rest of a net may be this irregular, and a block must be this large to be worth a call.
constexpr double kLanesFilled = 0.4;
constexpr double kRegularShare = 0.75;
constexpr double kDiagonalShare = 0.2;
constexpr int kMaxMergedDiagonals = 2 * kMaxDiagonals;
constexpr int kSmallest = 12;
constexpr int kSmallestSparse = 24;

int roundUp(int n) {
  return (n + kLanes - 1) / kLanes * kLanes;
}

/// Diagonals 1, pitch - 1, pitch, pitch + 1 before all others, if they are there.
void putPlateFirst(std::vector<int>& offsets) {
  const auto has = [&](int offset) {
    return std::find(offsets.begin(), offsets.end(), offset) != offsets.end();
  };
  const auto middle = std::find_if(offsets.begin(), offsets.end(), [&](int offset) {
    return offset > 3 && has(1) && has(offset - 1) && has(offset + 1);
  });
  if (middle != offsets.end()) {
    const int pitch = *middle;
    std::stable_partition(offsets.begin(), offsets.end(),
                          [&](int offset) { return offset == 1 || std::abs(offset - pitch) <= 1; });
  }
}

/// A component in the order of its elements.
struct Ordered {
  std::vector<int> mats;
  std::vector<int> lias;
  std::vector<int> offsets;  // ascending
};

class Finder {
 public:
  explicit Finder(const scene::Scene& scene)
      : scene_(scene), places_(scene.mats.size(), -1), is_linked_(scene.mats.size(), false) {
    for (const scene::Lia& lia : scene.lias) {
      is_linked_[at(lia.a)] = is_linked_[at(lia.b)] = true;
    }
  }

  std::vector<Block> find() {
    for (const Component& component : findComponents(scene_)) {
      sort(component);
    }
    for (auto& [key, alike] : alike_) {
      layAside(key.first, alike);
    }
    for (auto& [section, chains] : single_) {
      layInARow(section, chains);
    }
    Classifier classifier(scene_);
    for (Block& block : blocks_) {
      classifier.classify(block);
    }
    return std::move(blocks_);
  }

 private:
  using Key = std::pair<int, std::vector<int>>;  // section, offsets

  void sort(const Component& component) {
    number(component);
    Ordered ordered{chainOrder(scene_, component, places_), component.lias, {1}};
    if (ordered.mats.empty()) {
      const Component whole = withIdleGrounds(component);
      number(whole);
      ordered.mats = whole.mats;
      if (!keepRegular(whole, ordered)) {
        number(component);
        addSparse(component);
        return;
      }
    }
    alike_[{component.section, ordered.offsets}].push_back(std::move(ordered));
  }

  void number(const Component& component) {
    for (int i = 0; i < static_cast<int>(component.mats.size()); ++i) {
      places_[at(component.mats[at(i)])] = i;
    }
  }

  /// Grounds without links among the modules of a net keep their places: as the corners of a
  /// clamped plate, without which its rows are not equally long.
  Component withIdleGrounds(const Component& component) const {
    const auto isIdle = [&](int m) {
      const scene::Mat& mat = scene_.mats[at(m)];
      return mat.type == scene::MatType::kGround && mat.section == component.section &&
             !is_linked_[at(m)];
    };
    Component whole = component;
    whole.mats.clear();
    for (const int m : component.mats) {
      const std::size_t known = whole.mats.size();
      for (int gap = known == 0 ? m : whole.mats.back() + 1; gap < m && isIdle(gap); ++gap) {
        whole.mats.push_back(gap);
      }
      if (known > 0 && whole.mats.back() + 1 < m) {
        whole.mats.resize(known);  // others lie there too
      }
      whole.mats.push_back(m);
    }
    return whole;
  }

  /// Keeps the links on few diagonals. \return false if too many others are left
  bool keepRegular(const Component& component, Ordered& ordered) const {
    const double elements = static_cast<double>(component.mats.size());
    ordered.offsets.clear();
    int kept = 0;
    for (const OffsetCount& count : offsetsOf(scene_, component, places_)) {
      if (static_cast<int>(ordered.offsets.size()) < kMaxMergedDiagonals &&
          count.links >= kDiagonalShare * elements) {
        ordered.offsets.push_back(count.offset);
        kept += count.links;
      }
    }
    if (kept < kRegularShare * static_cast<double>(component.lias.size())) {
      return false;
    }
    std::sort(ordered.offsets.begin(), ordered.offsets.end());
    ordered.lias.clear();
    for (const int l : component.lias) {
      const scene::Lia& lia = scene_.lias[at(l)];
      const int offset = std::abs(places_[at(lia.a)] - places_[at(lia.b)]);
      if (std::binary_search(ordered.offsets.begin(), ordered.offsets.end(), offset)) {
        ordered.lias.push_back(l);
      }
    }
    return true;
  }

  /// Adds a component without any regularity, in an order of its own.
  void addSparse(const Component& component) {
    const int nodes = static_cast<int>(component.mats.size());
    if (nodes < kSmallestSparse) {
      return;
    }
    std::vector<LinkEnds> ends;
    for (const int l : component.lias) {
      const scene::Lia& lia = scene_.lias[at(l)];
      ends.push_back({places_[at(lia.a)], places_[at(lia.b)]});
    }
    SparsePlan plan = planSparse(nodes, ends);
    Block block;
    block.kind = Block::Kind::kSparse;
    block.section = component.section;
    block.lias = component.lias;
    for (const int node : plan.order) {
      block.mats.push_back(component.mats[at(node)]);
    }
    block.elements = std::max(roundUp(nodes), plan.program.reach());
    block.mats.resize(at(block.elements), -1);
    const auto windows = static_cast<int>(plan.program.window.size());
    block.shape = "irregular net, its neighbours from " + std::to_string(windows) +
                  " windows and " +
                  std::to_string(plan.program.slots() - plan.program.window.size()) +
                  " lists for " + std::to_string(plan.program.groups) + " x 16 modules";
    block.program = std::make_shared<const SparseProgram>(std::move(plan.program));
    blocks_.push_back(std::move(block));
  }

  /// Components of one shape, side by side where enough are of about one length.
  void layAside(int section, std::vector<Ordered>& alike) {
    std::stable_sort(alike.begin(), alike.end(), [](const Ordered& a, const Ordered& b) {
      return a.mats.size() > b.mats.size();
    });
    for (std::size_t from = 0; from < alike.size();) {
      std::size_t to = from;
      std::size_t elements = 0;
      for (; to < alike.size() && to < from + kLanes; ++to) {
        elements += alike[to].mats.size();
      }
      const std::size_t rows = alike[from].mats.size();
      if (static_cast<double>(elements) >= kLanesFilled * kLanes * static_cast<double>(rows)) {
        addLanes(section, alike, from, to);
        from = to;
      } else {
        single_[section].push_back(std::move(alike[from++]));
      }
    }
  }

  void addLanes(int section, std::vector<Ordered>& alike, std::size_t from, std::size_t to) {
    Block block;
    block.section = section;
    block.kind =
        alike[from].offsets == std::vector<int>{1} ? Block::Kind::kChains : Block::Kind::kLattice;
    block.elements = kLanes * static_cast<int>(alike[from].mats.size());
    block.mats.assign(at(block.elements), -1);
    for (std::size_t lane = 0; lane < to - from; ++lane) {
      Ordered& one = alike[from + lane];
      for (std::size_t i = 0; i < one.mats.size(); ++i) {
        block.mats[i * kLanes + lane] = one.mats[i];
      }
      block.lias.insert(block.lias.end(), one.lias.begin(), one.lias.end());
    }
    for (const int offset : alike[from].offsets) {
      block.offsets.push_back(kLanes * offset);
    }
    block.shape = std::to_string(to - from) + " alike of up to " +
                  std::to_string(alike[from].mats.size()) + " modules side by side";
    blocks_.push_back(std::move(block));
  }

  /// Adds components that have no equal: chains in one row, every other net as a block of its own.
  void layInARow(int section, std::vector<Ordered>& singles) {
    Block row;
    row.section = section;
    row.offsets = {1};
    for (Ordered& one : singles) {
      if (static_cast<int>(one.mats.size()) < kSmallest) {
        continue;
      }
      Block own;
      own.section = section;
      own.offsets = one.offsets;
      Block& to = one.offsets == row.offsets ? row : own;
      to.mats.insert(to.mats.end(), one.mats.begin(), one.mats.end());
      to.lias.insert(to.lias.end(), one.lias.begin(), one.lias.end());
      addRow(own, "net of one shape");
    }
    addRow(row, "chains in a row");
  }

  void addRow(Block& block, const char* name) {
    if (block.mats.empty()) {
      return;
    }
    putPlateFirst(block.offsets);
    block.shape = std::string(name) + ", " + std::to_string(block.offsets.size()) +
                  (block.offsets.size() == 1 ? " diagonal" : " diagonals");
    block.elements = roundUp(static_cast<int>(block.mats.size()));
    block.mats.resize(at(block.elements), -1);
    blocks_.push_back(std::move(block));
  }

  const scene::Scene& scene_;
  std::vector<int> places_;      // [mats] in their component
  std::vector<bool> is_linked_;  // [mats]
  std::map<Key, std::vector<Ordered>> alike_;
  std::map<int, std::vector<Ordered>> single_;
  std::vector<Block> blocks_;
};

}  // namespace

std::string describeBlock(const Block& block) {
  std::string text = block.shape + (block.is_alone ? ", a tick at a time" : "");
  if (block.kind == Block::Kind::kSparse) {
    return text;
  }
  if (block.kind == Block::Kind::kChains) {
    return text + (block.per_lane ? ", one coefficient a chain" : ", a coefficient for each link");
  }
  int uniform = 0;
  for (const Block::Segment& segment : block.segments) {
    uniform += segment.uniform ? segment.end - segment.begin : 0;
  }
  text += ", " + std::to_string(100 * uniform / block.elements) + " % with constant coefficients";
  text += block.pitch > 0 ? " (rows of " + std::to_string(block.pitch) + ")" : "";
  return text + (block.one_ratio ? ", one damping ratio" : "");
}

std::vector<Block> findBlocks(const scene::Scene& scene) {
  return Finder(scene).find();
}

}  // namespace ergotic::physics
