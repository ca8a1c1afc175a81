// SPDX-License-Identifier: BSD-3-Clause
#include "physics/certificate/linear_stepper.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>

#include "at.hpp"
#include "ergotic/exception.hpp"
#include "physics/layout/layout.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;
using scene::MatType;

constexpr int kPeriods = 2000;
constexpr double kMaxSteps = 3e8;  // modules times audio frames
constexpr double kScatter = 5e-6;  // of slopes, per period

/// Ticks until all sections that move are stepped together again.
int ticksOfAPeriod(const scene::Scene& scene, const Rates& rates) {
  int frames = rates.ratio;
  for (const scene::Mat& mat : scene.mats) {
    if (mat.type == MatType::kMass || mat.type == MatType::kCell) {
      frames = std::lcm(frames, divisorOf(scene.sectionOf(mat), rates));
    }
  }
  return frames / rates.ratio;
}

/// Slots of what can move: blocks have places for nothing and for grounds too.
std::vector<MovingSlot> movingSlots(const scene::Scene& scene, const Rates& rates) {
  const Layout layout = makeLayout(scene, rates);
  std::vector<MovingSlot> slots;
  for (int slot = 0; slot < layout.first_proxy; ++slot) {
    const int mat = layout.mat_of_slot[static_cast<std::size_t>(slot)];
    const bool is_in_block = std::any_of(
        layout.sections.begin(), layout.sections.end(),
        [&](const SectionRange& range) { return slot >= range.first && slot < range.cells; });
    const bool is_ground =
        mat >= 0 && scene.mats[static_cast<std::size_t>(mat)].type == MatType::kGround;
    if (!is_in_block || (mat >= 0 && !is_ground)) {
      slots.push_back({static_cast<std::size_t>(slot), mat});
    }
  }
  return slots;
}

}  // namespace

bool hasLinearPart(const scene::Lia& lia) {
  return lia.scheme == scene::Scheme::kExplicit && scene::lawOf(lia.type).has_linear_part;
}

scene::Scene linearPart(scene::Scene scene, const std::vector<int>& slices) {
  std::vector<scene::Port> ports(slices.size());
  for (std::size_t i = 0; i < slices.size(); ++i) {
    ports[i].mat = slices[i];
    ports[i].slice = static_cast<int>(i);
  }
  scene.ports = std::move(ports);
  scene.inputs.clear();
  scene.outputs.clear();
  scene.strings.clear();
  for (scene::Section& section : scene.sections) {
    section.geometry = scene::Geometry::kScalar;
    section.pose = Eigen::Isometry3d::Identity();
    section.gravity.setZero();
    section.sleep_energy = 0.0;
    section.modes = scene::kNoModes;
  }
  for (std::size_t m = 0; m < scene.mats.size(); ++m) {
    scene::Mat& mat = scene.mats[m];
    mat.rest.setZero();
    mat.position.setZero();
    mat.push = {};
    const bool is_in_hand =
        std::find(slices.begin(), slices.end(), static_cast<int>(m)) != slices.end();
    if (mat.type == MatType::kDriven || (mat.type == MatType::kSlice && !is_in_hand)) {
      mat.type = MatType::kGround;
    }
  }
  for (scene::Connection& connection : scene.connections) {
    connection.along.guide = connection.across.guide = -1;
  }
  scene.lias.erase(std::remove_if(scene.lias.begin(), scene.lias.end(),
                                  [](const scene::Lia& lia) { return !hasLinearPart(lia); }),
                   scene.lias.end());
  for (scene::Lia& lia : scene.lias) {
    lia.type = LiaType::kSpringDamper;
    lia.rest_length = 0.0;
  }
  return scene;
}

LinearStepper::LinearStepper(const scene::Scene& linear, const Rates& rates)
    : slots_(movingSlots(linear, rates)),
      instrument_(compile(linear, rates, Precision::kDouble)),
      rest_(instrument_->stateSize()),
      state_(instrument_->stateSize()),
      ticks_(ticksOfAPeriod(linear, rates)),
      period_s_(ticks_ / rates.gesturalHz()),
      positions_(static_cast<std::size_t>(instrument_->ports())),
      forces_(positions_.size()),
      inputs_(static_cast<std::size_t>(rates.ratio * instrument_->inputChannels())),
      outputs_(static_cast<std::size_t>(rates.ratio * instrument_->outputChannels())) {
  // Before the first tick nobody knows where a hand was; from then on its slice moves.
  for (int tick = 0; tick < ticks_; ++tick) {
    instrument_->tick({positions_.data(), forces_.data(), inputs_.data(), outputs_.data()});
  }
  instrument_->saveState(rest_.data());
  const char* names[4] = {"x", "d", "f", "glide_forces"};
  for (const StateEntry& entry : instrument_->stateEntries()) {
    for (int which = 0; which < 4; ++which) {
      if (entry.name == names[which]) {
        offsets_[which] = entry.offset;
        interpolated_forces_ += which == 3 ? entry.size / sizeof(double) : 0;
      }
    }
  }
}

double& LinearStepper::number(int which, std::size_t slot) {
  return reinterpret_cast<double*>(state_.data() + offsets_[which])[slot];
}

template <class Visit>
void LinearStepper::visitNumbers(const Visit& visit) {
  int i = 0;
  for (int which = 0; which < 3; ++which) {
    for (const MovingSlot& moving : slots_) {
      visit(i++, number(which, moving.slot));
    }
  }
  for (std::size_t k = 0; k < interpolated_forces_; ++k) {
    visit(i++, number(3, k));
  }
}

Eigen::VectorXd LinearStepper::step(const Eigen::VectorXd& state, int moved) {
  for (std::size_t p = 0; p < positions_.size(); ++p) {
    positions_[p] = static_cast<int>(p) == moved ? 1.0 : 0.0;
  }
  state_ = rest_;
  visitNumbers([&](int i, double& number) { number = state[i]; });
  instrument_->loadState(state_.data());
  for (int tick = 0; tick < ticks_; ++tick) {
    instrument_->tick({positions_.data(), forces_.data(), inputs_.data(), outputs_.data()});
  }
  instrument_->saveState(state_.data());
  Eigen::VectorXd result(numbers());
  visitNumbers([&](int i, double& number) { result[i] = number; });
  return result;
}

GrowthSeen watchGrowth(const scene::Scene& linear, const Rates& rates) {
  LinearStepper stepper(linear, rates);
  const double steps = static_cast<double>(stepper.slots()) * stepper.ticks() * rates.ratio;
  GrowthSeen seen;
  seen.periods = static_cast<int>(std::clamp(kMaxSteps / steps, 200.0, double{kPeriods}));
  std::minstd_rand random(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  Eigen::VectorXd state = Eigen::VectorXd::Zero(stepper.numbers());
  for (int i = 0; i < stepper.slots(); ++i) {
    state[i] = number(random);
  }
  // Least squares of ln |x| over time, the state brought back to size 1 after every period.
  double size = 0.0;
  double sums[4] = {0.0, 0.0, 0.0, 0.0};  // t, t^2, y, t y
  const int first = seen.periods / 2;
  for (int n = 0; n < seen.periods; ++n) {
    state = stepper.step(state);
    const double norm = state.head(2 * stepper.slots()).norm();
    if (!(norm > 0.0)) {
      return seen;
    }
    size += std::log(norm);
    state /= norm;
    if (n >= first) {
      const double t = n - first;
      sums[0] += t;
      sums[1] += t * t;
      sums[2] += size;
      sums[3] += t * size;
    }
  }
  const double count = seen.periods - first;
  const double slope =
      (count * sums[3] - sums[0] * sums[2]) / (count * sums[1] - sums[0] * sums[0]);
  seen.per_second = slope / stepper.periodSeconds();
  seen.is_visible = std::abs(slope) > kScatter;
  return seen;
}

}  // namespace ergotic::physics
