// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/morph.hpp"

#include <algorithm>
#include <cmath>

#include "constants.hpp"

namespace ergotic::node {
namespace {

constexpr double kEvenUpTo = 100.0;  // ratio of the ends of a range, as in SliderScale of the panel

}  // namespace

Morph::Morph(const std::vector<scene::Parameter>& parameters,
             const std::vector<double>& from,
             const std::map<std::size_t, double>& to,
             std::int64_t begin_ns,
             double seconds)
    : begin_ns_(begin_ns), seconds_(seconds) {
  for (const auto& [index, value] : to) {
    if (value != from[index]) {
      const scene::Parameter& parameter = parameters[index];
      ways_.push_back(
          {index, from[index], value,
           parameter.minimum > 0.0 && parameter.maximum > kEvenUpTo * parameter.minimum});
    }
  }
}

void Morph::leave(std::size_t parameter) {
  ways_.erase(std::remove_if(ways_.begin(), ways_.end(),
                             [parameter](const Way& way) { return way.parameter == parameter; }),
              ways_.end());
}

double Morph::valueAt(const Way& way, double share) {
  const double value = way.by_logarithm ? way.from * std::pow(way.to / way.from, share)
                                        : way.from + share * (way.to - way.from);
  return std::clamp(value, std::min(way.from, way.to), std::max(way.from, way.to));
}

void Morph::step(std::int64_t now_ns, const Set& set) {
  const double passed_s = static_cast<double>(now_ns - begin_ns_) / kNsPerS;
  const bool arrives = passed_s >= seconds_;
  const std::size_t count = ways_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Way way = ways_.front();
    if (!set(way.parameter, arrives ? way.to : valueAt(way, passed_s / seconds_))) {
      return;
    }
    ways_.pop_front();
    if (!arrives) {
      ways_.push_back(way);
    }
  }
}

}  // namespace ergotic::node
