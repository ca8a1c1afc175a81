// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/end_effector.hpp"
#include "ergotic/tgr/urdf.hpp"
#include "fuzz/fuzz.hpp"

namespace ergotic::fuzz {
namespace {

/// Wherever the slices are, it is somewhere or says that it cannot be there.
void move(const tgr::Kinematics& kinematics) {
  constexpr int kCoordinates = tgr::Kinematics::kMaxCoordinates;
  constexpr int kSlices = tgr::Kinematics::kMaxSlicesOfOne;
  for (const double step : {0.0, 0.01, -0.02, 0.3}) {
    std::array<double, kSlices> q{};
    std::array<double, kCoordinates> x{};
    std::array<double, kCoordinates * kSlices> jacobian{};
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] = i % 2 == 0 ? step : -0.5 * step;
    }
    if (!kinematics.forward(q.data(), x.data(), jacobian.data())) {
      continue;
    }
    kinematics.pose(q.data());
    const auto isFinite = [](double value) { return std::isfinite(value); };
    if (!std::all_of(x.begin(), x.end(), isFinite) ||
        !std::all_of(jacobian.begin(), jacobian.end(), isFinite)) {
      fail("a coordinate that is not finite");
    }
  }
}

void use(const std::string& text, const tgr::EndEffectors& end_effectors) {
  if (tgr::readEndEffectors(toYaml(end_effectors), kFile).list.size() !=
      end_effectors.list.size()) {
    fail("written as something else:\n" + toYaml(end_effectors));
  }
  for (const tgr::EndEffectorConfig& config : end_effectors.list) {
    const auto kinematics =
        readOrRefuse(text, [&] { return tgr::makeKinematics(config, end_effectors.file); });
    if (!kinematics) {
      return;
    }
    move(**kinematics);
  }
  tgr::urdfOf(end_effectors, tgr::kMaxSlices);
}

}  // namespace
}  // namespace ergotic::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ergotic;
  const std::string text = fuzz::textOf(data, size);
  if (const auto end_effectors =
          fuzz::readOrRefuse(text, [&] { return tgr::readEndEffectors(text, fuzz::kFile); })) {
    fuzz::use(text, *end_effectors);
  }
  return 0;
}
