// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/advice/ranges.hpp"

#include <algorithm>
#include <cmath>

#include "at.hpp"
#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/physics/settling/settle.hpp"

namespace ergotic::physics {
namespace {
constexpr double kRangePrecision = 1e-3;
constexpr int kMaxRangeHalvings = 60;
constexpr double kUnbounded = 1e9;  // times the size of a range: nothing ends it

struct Judged {
  Verdict verdict = Verdict::kUnstable;
  double margin = -kInfinity;
};

class RangeJudge {
 public:
  RangeJudge(const scene::Scene& scene, const Rates& rates, const DeviceTraits& device)
      : scene_(scene), rates_(rates), device_(device), wanted_(judge(scene).verdict) {
    wanted_ = wanted_ <= Verdict::kBounded ? wanted_ : Verdict::kBounded;
  }

  JudgedRange judge(std::size_t index) const {
    const scene::Parameter& parameter = scene_.parameters[index];
    JudgedRange judged;
    judged.name = parameter.name;
    judged.decides = decidingEnd(index);
    double low = parameter.minimum;
    double high = parameter.maximum;
    if (!isCertified(index, low, high)) {
      low = high = parameter.value;
    }
    judged.holds = isCertified(index, low, high);
    if (judged.holds) {
      const double size = std::max({std::abs(low), std::abs(high), high - low, 1e-300});
      judged.highest = farthest(high, size, [&](double x) { return isCertified(index, low, x); });
      judged.lowest = farthest(low, -size, [&](double x) { return isCertified(index, x, high); });
    }
    return judged;
  }

 private:
  Judged judge(const scene::Scene& scene) const {
    try {
      validate(scene);
      const Certificate certificate = certify(settle(scene, rates_).scene, rates_, device_);
      return {certificate.verdict, certificate.margin()};
    } catch (const Exception&) {
      return {};  // a value that cannot stand there
    }
  }

  Judged judge(std::size_t index, double minimum, double maximum) const {
    scene::Scene scene = scene_;
    scene::Parameter& parameter = scene.parameters[index];
    parameter.minimum = minimum;
    parameter.maximum = maximum;
    parameter.value = std::clamp(parameter.value, minimum, maximum);
    return judge(scene);
  }

  bool isCertified(std::size_t index, double minimum, double maximum) const {
    return judge(index, minimum, maximum).verdict <= wanted_;
  }

  JudgedRange::End decidingEnd(std::size_t index) const {
    const scene::Parameter& parameter = scene_.parameters[index];
    const Judged low = judge(index, parameter.minimum, parameter.minimum);
    const Judged high = judge(index, parameter.maximum, parameter.maximum);
    if (low.verdict != high.verdict) {
      return low.verdict > high.verdict ? JudgedRange::End::kMinimum : JudgedRange::End::kMaximum;
    }
    if (std::abs(low.margin - high.margin) <= 1e-9) {
      return JudgedRange::End::kNone;
    }
    return low.margin < high.margin ? JudgedRange::End::kMinimum : JudgedRange::End::kMaximum;
  }

  /// How far from `from`, where `holds`, in the direction of `size` it still does.
  template <class Holds>
  static double farthest(double from, double size, const Holds& holds) {
    double good = 0.0;
    double bad = 1.0;
    while (bad < kUnbounded && holds(from + bad * size)) {
      good = bad;
      bad *= 4.0;
    }
    if (!(bad < kUnbounded)) {
      return std::copysign(kInfinity, size);
    }
    for (int i = 0; i < kMaxRangeHalvings && bad - good > kRangePrecision * bad; ++i) {
      const double middle = 0.5 * (good + bad);
      (holds(from + middle * size) ? good : bad) = middle;
    }
    return from + good * size;
  }

  const scene::Scene& scene_;
  Rates rates_;
  const DeviceTraits& device_;
  Verdict wanted_;
};

}  // namespace

std::vector<JudgedRange> judgeRanges(const scene::Scene& scene,
                                     const Rates& rates,
                                     const DeviceTraits& device) {
  std::vector<JudgedRange> judged;
  if (scene.parameters.empty()) {
    return judged;
  }
  const RangeJudge judge(scene, rates, device);
  for (std::size_t p = 0; p < scene.parameters.size(); ++p) {
    judged.push_back(judge.judge(p));
  }
  return judged;
}

}  // namespace ergotic::physics
