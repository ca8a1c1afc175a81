// SPDX-License-Identifier: BSD-3-Clause
#include "advice/acting.hpp"

#include <algorithm>
#include <cmath>

#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;

/// Spans in which a table is not 0. Between two points that are 0 it is 0, straight or smooth.
std::vector<Span> spansOf(const scene::Table& table, bool holds_its_ends) {
  std::vector<Span> spans;
  const auto add = [&spans](double from, double to) {
    if (!spans.empty() && spans.back().to == from) {
      spans.back().to = to;
    } else {
      spans.push_back({from, to});
    }
  };
  const auto& points = table.points;
  if (holds_its_ends && points.front().second != 0.0) {
    add(-kEndless, points.front().first);
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (points[i].second != 0.0 || points[i + 1].second != 0.0) {
      add(points[i].first, points[i + 1].first);
    }
  }
  if (holds_its_ends && points.back().second != 0.0) {
    add(points.back().first, kEndless);
  }
  return spans;
}

/// Spans of the hand in which the distance is less than `most`.
std::vector<Span> within(const Separation& ends, double most) {
  if (most == kEndless) {
    return {{-kEndless, kEndless}};
  }
  const double a = ends.way.squaredNorm();
  const double b = ends.apart.dot(ends.way);
  const double c = ends.apart.squaredNorm() - most * most;
  const double root = b * b - a * c;
  if (!(most > 0.0) || !(root > 0.0)) {
    return {};
  }
  const double q = -(b + std::copysign(std::sqrt(root), b));
  return {{std::min(q / a, c / q), std::max(q / a, c / q)}};
}

void addScalar(const Span& acting, const Separation& ends, std::vector<Span>& spans) {
  const double first = (acting.from - ends.apart.x()) / ends.way.x();
  const double second = (acting.to - ends.apart.x()) / ends.way.x();
  spans.push_back({std::min(first, second), std::max(first, second)});
}

void addDistance(const Span& acting, const Separation& ends, std::vector<Span>& spans) {
  const std::vector<Span> outer = within(ends, acting.to);
  const std::vector<Span> inner = within(ends, acting.from);
  if (outer.empty()) {
    return;
  }
  if (inner.empty()) {
    spans.push_back(outer[0]);
    return;
  }
  spans.push_back({outer[0].from, inner[0].from});
  spans.push_back({inner[0].to, outer[0].to});
}

}  // namespace

std::vector<Span> actingSpans(const scene::Scene& scene, const scene::Lia& lia, bool is_scalar) {
  const double rest = lia.rest_length;
  const scene::Law& law = scene::lawOf(lia.type);
  if (law.kind == scene::Law::Kind::kGap) {
    const double threshold = scene.valueOf(lia.law->width);
    return {is_scalar ? Span{-threshold, kEndless} : Span{-kEndless, threshold}};
  }
  if (lia.type == LiaType::kPluck || lia.type == LiaType::kConditional) {
    const double width = scene.valueOf(lia.law->width);
    return {{rest - width, rest + width}};
  }
  if (lia.type == LiaType::kOneWayPluck) {
    return {{rest, rest + scene.valueOf(lia.law->width)}};
  }
  const bool is_elastic = lia.type == LiaType::kTable && lia.law->viscous_table.empty();
  if (lia.type != LiaType::kPluckTable && !is_elastic) {
    return {{-kEndless, kEndless}};
  }
  std::vector<Span> spans = spansOf(lia.law->table, is_elastic);
  for (Span& span : spans) {
    span = {span.from + rest, span.to + rest};
  }
  return spans;
}

std::vector<Span> handSpans(const std::vector<Span>& acting, const Separation& ends) {
  std::vector<Span> spans;
  for (const Span& one : acting) {
    (ends.is_scalar ? addScalar : addDistance)(one, ends, spans);
  }
  std::sort(spans.begin(), spans.end(),
            [](const Span& a, const Span& b) { return a.from < b.from; });
  return spans;
}

double nearestOf(const Separation& ends) {
  const double nearest = -ends.apart.dot(ends.way) / ends.way.squaredNorm();
  return (ends.apart + nearest * ends.way).norm();
}

}  // namespace ergotic::physics
