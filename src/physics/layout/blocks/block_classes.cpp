// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "at.hpp"
#include "physics/layout/blocks/block_parts.hpp"
#include "physics/layout/blocks/lanes.hpp"
#include "scene/laws/bend_parts.hpp"

namespace ergotic::physics {
namespace {

using scene::Value;

constexpr double kSameRatio = 1e-12;      // relative
constexpr int kWorthACall = 12 * kLanes;  // elements

bool same(const Value& a, const Value& b) {
  return a.factor == b.factor && a.parameter == b.parameter;
}
bool same(const scene::Lia& a, const scene::Lia& b) {
  return same(a.stiffness, b.stiffness) && same(a.damping, b.damping);
}

bool isNeverZero(const scene::Scene& scene, const Value& value) {
  return value.factor != 0.0 &&
         (value.parameter < 0 || scene.parameters[at(value.parameter)].minimum > 0.0);
}

/// Links that lie side by side, in the order of the scene.
struct Beside {
  const int* first = nullptr;
  const int* last = nullptr;

  const int* begin() const { return first; }
  const int* end() const { return last; }
  bool empty() const { return first == last; }
};

bool same(const scene::Scene& scene, const Beside& a, const Beside& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](int one, int other) {
    return same(scene.lias[at(one)], scene.lias[at(other)]);
  });
}

/// The links of a block by element and diagonal.
class Links {
 public:
  /// \param element  [mats] scratch
  Links(const scene::Scene& scene, const Block& block, std::vector<int>& element)
      : scene_(scene), block_(block), first_(block.offsets.size() * block.mats.size() + 1, 0) {
    for (int e = 0; e < block.elements; ++e) {
      if (block.mats[at(e)] >= 0) {
        element[at(block.mats[at(e)])] = e;
      }
    }
    const auto placeOf = [&](int l) {
      const int a = element[at(scene.lias[at(l)].a)];
      const int b = element[at(scene.lias[at(l)].b)];
      const auto diagonal = std::find(block.offsets.begin(), block.offsets.end(), std::abs(a - b));
      return at(static_cast<int>(diagonal - block.offsets.begin())) * block.mats.size() +
             at(std::min(a, b));
    };
    for (const int l : block.lias) {
      ++first_[placeOf(l)];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    links_.resize(block.lias.size());
    for (auto l = block.lias.rbegin(); l != block.lias.rend(); ++l) {
      links_[at(--first_[placeOf(*l)])] = *l;
    }
  }

  /// Links of a diagonal that begin at an element; none outside.
  Beside of(std::size_t diagonal, int element) const {
    if (element < 0) {
      return {};
    }
    const std::size_t place = diagonal * block_.mats.size() + at(element);
    return {links_.data() + first_[place], links_.data() + first_[place + 1]};
  }

  /// Finds, for each diagonal, the links whose coefficients are most frequent among its first.
  std::vector<std::vector<int>> reference() const {
    std::vector<std::vector<int>> best;
    for (std::size_t k = 0; k < block_.offsets.size(); ++k) {
      std::vector<std::pair<Beside, int>> found;  // links, how many are like them
      for (int e = 0; e < block_.elements; ++e) {
        const Beside here = of(k, e);
        if (here.empty()) {
          continue;
        }
        const auto known = std::find_if(found.begin(), found.end(),
                                        [&](const auto& f) { return same(scene_, f.first, here); });
        if (known != found.end()) {
          ++known->second;
        } else if (found.size() < 8) {
          found.push_back({here, 1});
        }
      }
      const auto most =
          std::max_element(found.begin(), found.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      best.emplace_back();
      if (most != found.end()) {
        best.back().assign(most->first.begin(), most->first.end());
      }
    }
    return best;
  }

 private:
  const scene::Scene& scene_;
  const Block& block_;
  std::vector<int> first_;  // [diagonals][elements] in links_
  std::vector<int> links_;
};

/// Links of a diagonal whose coefficients uniform segments share.
Beside referenceOf(const Block& block, std::size_t diagonal) {
  const std::vector<int>& links = block.reference[diagonal];
  return {links.data(), links.data() + links.size()};
}

/// True if forces on an element do not matter: nothing, or a ground that nobody listens to.
bool isIndifferent(const scene::Scene& scene, const std::vector<unsigned char>& heard, int mat) {
  return mat < 0 || (scene.mats[at(mat)].type == scene::MatType::kGround && heard[at(mat)] == 0);
}

/// True if a link from here to nothing would give no force.
bool endsAtRest(const scene::Scene& scene, int mat) {
  return mat < 0 || (scene.mats[at(mat)].type == scene::MatType::kGround &&
                     scene.mats[at(mat)].position.x() == scene.mats[at(mat)].rest.x());
}

/// Elements in groups of kLanes that all have their links, with the coefficients of `reference`.
void findSegments(const scene::Scene& scene,
                  const std::vector<unsigned char>& heard,
                  const Links& links,
                  Block& block) {
  const auto isUniform = [&](int element) {
    for (std::size_t k = 0; k < block.offsets.size(); ++k) {
      for (const Beside& here : {links.of(k, element), links.of(k, element - block.offsets[k])}) {
        if (here.empty() || !same(scene, here, referenceOf(block, k))) {
          return false;
        }
      }
    }
    return true;
  };
  const auto hasNoModule = [&](int group) {
    return std::all_of(block.mats.begin() + group, block.mats.begin() + group + kLanes, [&](int m) {
      return isIndifferent(scene, heard, m) && endsAtRest(scene, m);
    });
  };
  int begin = 0;
  int end = block.elements;
  while (begin < end && hasNoModule(begin)) {
    begin += kLanes;
  }
  while (end > begin && hasNoModule(end - kLanes)) {
    end -= kLanes;
  }
  std::vector<Block::Segment> runs;
  for (int group = begin; group < end; group += kLanes) {
    bool all = true;
    for (int e = group; e < group + kLanes && all; ++e) {
      all = isIndifferent(scene, heard, block.mats[at(e)]) || isUniform(e);
    }
    if (runs.empty() || runs.back().uniform != all) {
      runs.push_back({group, group, all});
    }
    runs.back().end = group + kLanes;
  }
  // A short uniform run between others costs more calls than it saves.
  const bool is_one = runs.size() == 1;
  for (const Block::Segment& run : runs) {
    const bool uniform = run.uniform && (is_one || run.end - run.begin >= kWorthACall);
    if (block.segments.empty() || block.segments.back().uniform != uniform) {
      block.segments.push_back({run.begin, run.begin, uniform});
    }
    block.segments.back().end = run.end;
  }
}

bool hasOneRatio(const scene::Scene& scene, const Block& block) {
  const scene::Lia& first = scene.lias[at(block.lias.front())];
  const double ratio = first.damping.factor / first.stiffness.factor;
  return std::all_of(block.lias.begin(), block.lias.end(), [&](int l) {
    const scene::Lia& lia = scene.lias[at(l)];
    return isNeverZero(scene, lia.stiffness) &&
           lia.stiffness.parameter == first.stiffness.parameter &&
           lia.damping.parameter == first.damping.parameter &&
           std::abs(lia.damping.factor / lia.stiffness.factor - ratio) <=
               kSameRatio * std::abs(ratio);
  });
}

bool isPerLane(const scene::Scene& scene, const Links& links, const Block& block) {
  for (int lane = 0; lane < kLanes; ++lane) {
    const Beside first = links.of(0, lane);
    for (int e = lane; e < block.elements; e += kLanes) {
      const Beside here = links.of(0, e);
      if (here.empty() && (e + kLanes >= block.elements || endsAtRest(scene, block.mats[at(e)]))) {
        continue;
      }
      if (here.end() - here.begin() != 1 || !same(scene, here, first)) {
        return false;
      }
    }
  }
  return true;
}

/// \return elements of a row if the first diagonals are those of a plate, else 0
int pitchOf(const scene::Scene& scene, const Block& block) {
  const std::vector<int>& o = block.offsets;
  const bool is_known = std::none_of(block.reference.begin(), block.reference.end(),
                                     [](const std::vector<int>& links) { return links.empty(); });
  if (block.has_bias || !is_known || o.size() < 2 || o[0] != 1) {
    return 0;
  }
  if (o.size() == 2) {
    return o[1];
  }
  const bool has_corners = o.size() >= 4 && o[1] == o[2] - 1 && o[3] == o[2] + 1 &&
                           same(scene, referenceOf(block, 1), referenceOf(block, 3));
  return has_corners ? o[2] : 0;
}

void lookAtModules(const scene::Scene& scene, Block& block) {
  for (const int m : block.mats) {
    if (m < 0 || scene.mats[at(m)].type == scene::MatType::kGround) {
      continue;
    }
    const scene::Mat& mat = scene.mats[at(m)];
    const scene::Section& section = scene.sectionOf(mat);
    block.has_cells =
        block.has_cells || mat.type == scene::MatType::kCell || section.medium.factor != 0.0;
    block.has_drift = block.has_drift || mat.push->force.x() != 0.0 || section.gravity.x() != 0.0;
  }
  block.has_bias = std::any_of(block.lias.begin(), block.lias.end(), [&](int l) {
    const scene::Lia& lia = scene.lias[at(l)];
    return scene::restApart(scene, lia).x() != lia.rest_length;
  });
}

}  // namespace

Classifier::Classifier(const scene::Scene& scene)
    : scene_(scene), element_(scene.mats.size(), -1), heard_(scene.mats.size(), 0) {
  for (const scene::Output& output : scene.outputs) {
    heard_[at(output.point.mat)] = 1;
    if (output.point.next >= 0) {
      heard_[at(output.point.next)] = 1;
    }
  }
}

void Classifier::classify(Block& block) {
  lookAtModules(scene_, block);
  if (block.kind == Block::Kind::kSparse) {
    return;
  }
  const Links links(scene_, block, element_);
  if (block.kind == Block::Kind::kChains) {
    // The kernel of chains knows no bias, and of masses no constant force.
    if (!block.has_bias && (block.has_cells || !block.has_drift)) {
      block.per_lane = isPerLane(scene_, links, block);
      return;
    }
    block.kind = Block::Kind::kLattice;
  }
  const int reach = *std::max_element(block.offsets.begin(), block.offsets.end());
  block.guard = (reach + 2 * kLanes - 1) / kLanes * kLanes;
  block.one_ratio = hasOneRatio(scene_, block);
  block.reference = links.reference();
  block.pitch = pitchOf(scene_, block);
  findSegments(scene_, heard_, links, block);
}

}  // namespace ergotic::physics
