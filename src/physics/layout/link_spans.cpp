// SPDX-License-Identifier: BSD-3-Clause
#include "physics/layout/link_spans.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace ergotic::physics {
namespace {

using scene::LiaType;

constexpr std::size_t kShortest = 8;  // below it ends are sooner gathered one by one

bool isForSpans(const LinkRun& run) {
  const bool is_spatial = (run.law == LiaType::kSpringDamper || run.law == LiaType::kContact) &&
                          !run.energy_stable && run.dimensions > 0 &&
                          run.section_a == run.section_b && run.slow_section < 0 &&
                          run.stride_a == run.stride_b;
  return is_spatial || run.tank >= 0;
}

/// \return one past the last link from `first` on whose ends follow those of the one before
std::size_t endOfSpan(const std::vector<LinkEnds>& ends,
                      const std::vector<std::size_t>& order,
                      std::size_t first) {
  std::size_t next = first + 1;
  while (next < order.size() && ends[order[next]].a == ends[order[next - 1]].a + 1 &&
         ends[order[next]].b == ends[order[next - 1]].b + 1) {
    ++next;
  }
  return next;
}

template <class Item>
void permute(std::vector<Item>& items, const std::vector<std::size_t>& order) {
  std::vector<Item> sorted;
  sorted.reserve(items.size());
  for (const std::size_t i : order) {
    sorted.push_back(items[i]);
  }
  items = std::move(sorted);
}

}  // namespace

void arrangeInSpans(LinkRun& run) {
  if (!isForSpans(run)) {
    return;
  }
  const std::vector<LinkEnds>& ends = run.ends;
  std::vector<std::size_t> order(ends.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&ends](std::size_t i, std::size_t j) {
    return std::make_tuple(ends[i].b - ends[i].a, ends[i].a) <
           std::make_tuple(ends[j].b - ends[j].a, ends[j].a);
  });
  std::vector<std::size_t> arranged;
  std::vector<std::size_t> others;
  for (std::size_t first = 0; first < order.size();) {
    const std::size_t next = endOfSpan(ends, order, first);
    const bool is_span = next - first >= kShortest;
    if (is_span) {
      run.spans.push_back({static_cast<int>(arranged.size()), static_cast<int>(next - first),
                           ends[order[first]].a, ends[order[first]].b});
    }
    auto& to = is_span ? arranged : others;
    for (; first < next; ++first) {
      to.push_back(order[first]);
    }
  }
  if (!others.empty()) {
    run.spans.push_back(
        {static_cast<int>(arranged.size()), static_cast<int>(others.size()), -1, -1});
    arranged.insert(arranged.end(), others.begin(), others.end());
  }
  permute(run.lias, arranged);
  permute(run.rests, arranged);
  permute(run.ends, arranged);
}

}  // namespace ergotic::physics
