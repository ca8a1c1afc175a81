// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/advice/modes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "advice/mode_damping.hpp"
#include "advice/mode_network.hpp"
#include "advice/mode_solver.hpp"
#include "advice/mode_targets.hpp"
#include "at.hpp"
#include "constants.hpp"
#include "physics/note.hpp"
#include "scene/names.hpp"

namespace ergotic::physics {
namespace {

using scene::Scene;
constexpr double kMinShare = 1e-3;  // of a link that is told

/// h^2 w^2 of what swings at a frequency without losses.
double lambdaOf(double hz, double step_s) {
  if (!(hz * step_s < 0.5)) {
    return std::numeric_limits<double>::infinity();
  }
  const double half = std::sin(kPi * hz * step_s);
  return 4.0 * half * half;
}

/// A mode that was found, before it is reported.
struct FoundMode {
  SceneMode told;
  std::vector<std::pair<int, double>> shares;  ///< kinetic energy by module
};

class Collector {
 public:
  Collector(const Scene& scene, const Rates& rates, const ModeWindow& window)
      : scene_(scene), rates_(rates), window_(window), network_(scene) {
    is_heard_.assign(scene.mats.size(), 0);
    for (const scene::Output& output : scene.outputs) {
      if (output.quantity == scene::Quantity::kForce) {
        is_heard_[at(output.point.mat)] = 1;
      }
    }
    for (int m = 0; m < static_cast<int>(scene.mats.size()); ++m) {
      if (scene.mats[at(m)].type == scene::MatType::kPoint) {
        points_.push_back(m);
        found_.points.push_back(scene.mats[at(m)].name);
      }
    }
  }

  SceneModes run(const Scene& asked) {
    std::set<int> divisors;
    for (const scene::Mat& mat : scene_.mats) {
      divisors.insert(divisorOf(scene_.sectionOf(mat), rates_));
    }
    for (const int divisor : divisors) {
      addRate(divisor);
    }
    std::sort(modes_.begin(), modes_.end(), [](const FoundMode& a, const FoundMode& b) {
      return a.told.frequency_hz < b.told.frequency_hz;
    });
    if (modes_.size() > at(window_.most)) {
      modes_.resize(at(window_.most));
    }
    for (const auto& [section, count] : rigid_) {
      found_.rigid.push_back({scene_.sections[at(section)].name, count});
    }
    std::vector<PlacedMode> placed;
    for (const FoundMode& mode : modes_) {
      placed.push_back({mode.told.frequency_hz, &mode.shares});
    }
    found_.asked = askedPitchesOf(asked);
    std::vector<std::vector<double>> in_asked = sharesInBodies(asked, placed);
    const std::vector<PitchMatch> matches = matchPitches(scene_, asked, found_.asked, placed);
    for (std::size_t i = 0; i < modes_.size(); ++i) {
      modes_[i].told.asked = matches[i].asked;
      modes_[i].told.cents = matches[i].cents;
      modes_[i].told.in_asked = std::move(in_asked[i]);
      found_.modes.push_back(std::move(modes_[i].told));
    }
    addNotes();
    return std::move(found_);
  }

 private:
  void addRate(int divisor) {
    const ModeNetwork network = modeNetworkOf(network_, rates_, divisor, is_heard_);
    held_ += network.held;
    energy_stable_ += network.energy_stable;
    relaxing_ += network.relaxing;
    const EigenWindow window{
        window_.from_hz > 0.0 ? lambdaOf(window_.from_hz, network.step_s) : 0.0,
        lambdaOf(window_.to_hz, network.step_s), window_.most};
    if (window.from == std::numeric_limits<double>::infinity()) {
      return;
    }
    for (const ModePart& part : partsOf(network)) {
      addPart(network, part, window);
    }
  }

  void addPart(const ModeNetwork& network, const ModePart& part, const EigenWindow& window) {
    const EigenPairs pairs = eigenPairsIn(part, window);
    found_.counted += pairs.counted;
    found_.is_certain = found_.is_certain && pairs.is_certain;
    if (pairs.rigid_in_all > 0) {
      const int mat = network.mat_of[at(part.rows.front())];
      rigid_[scene_.mats[at(mat)].section] += pairs.rigid_in_all;
    }
    const int count = std::min(pairs.counted, window.most);
    for (const DampedMode& mode : dampedModesOf(part, pairs, count)) {
      addMode(network, part, mode);
    }
  }

  void addMode(const ModeNetwork& network, const ModePart& part, const DampedMode& damped) {
    FoundMode mode;
    const std::complex<double> w = damped.w;
    const double decay = -0.5 * std::log1p(2.0 * w.real() + std::norm(w)) / network.step_s;
    const double angle = std::atan2(w.imag(), 1.0 + w.real());
    mode.told.frequency_hz = angle / (2.0 * kPi * network.step_s);
    // Losses below rounding are none.
    const bool is_lossless = std::abs(decay * network.step_s) < 1e-15;
    mode.told.t60_s =
        is_lossless ? std::numeric_limits<double>::infinity() : std::log(1000.0) / decay;
    mode.told.kind = !is_lossless && decay < 0.0 ? SceneMode::Kind::kUnstable
                     : w.imag() == 0.0           ? SceneMode::Kind::kCreeps
                                                 : SceneMode::Kind::kRings;
    mode.told.error = damped.error;
    mode.told.rate_divisor = network.divisor;
    setShares(network, part, damped, mode);
    setLinks(part, damped, mode.told);
    const Weights weights(network, part, damped);
    for (const scene::Output& output : scene_.outputs) {
      mode.told.at_outputs.push_back(amplitudeAt(network, weights, output));
    }
    for (const int point : points_) {
      mode.told.at_points.push_back(realOf(displacementAt(weights, network, point, 0)));
    }
    modes_.push_back(std::move(mode));
  }

  void setShares(const ModeNetwork& network,
                 const ModePart& part,
                 const DampedMode& damped,
                 FoundMode& mode) const {
    const double whole = damped.shape.squaredNorm();
    std::map<int, double> shares;
    for (std::size_t i = 0; i < part.rows.size(); ++i) {
      shares[network.mat_of[at(part.rows[i])]] +=
          std::norm(damped.shape[static_cast<Eigen::Index>(i)]) / whole;
    }
    mode.shares.assign(shares.begin(), shares.end());
    const auto largest =
        std::max_element(mode.shares.begin(), mode.shares.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    mode.told.peak = scene_.mats[at(largest->first)].name;
  }

  static void setLinks(const ModePart& part, const DampedMode& damped, SceneMode& told) {
    std::map<std::pair<int, int>, LinkShare> shares;
    LinkShare whole;
    for (const ModeLoad& load : part.loads) {
      std::complex<double> elongation = 0.0;
      for (const Share& end : load.ends) {
        elongation += end.weight * damped.shape[static_cast<Eigen::Index>(end.node)];
      }
      LinkShare& share = shares[{load.lia, load.bend}];
      share.lia = load.lia;
      share.bend = load.bend;
      share.of_pull += load.pull * std::norm(elongation);
      share.of_loss += load.loss * std::norm(elongation);
      whole.of_pull += load.pull * std::norm(elongation);
      whole.of_loss += load.loss * std::norm(elongation);
    }
    for (auto& [link, share] : shares) {
      share.of_pull /= whole.of_pull > 0.0 ? whole.of_pull : 1.0;
      share.of_loss /= whole.of_loss > 0.0 ? whole.of_loss : 1.0;
      if (std::max(std::abs(share.of_pull), share.of_loss) >= kMinShare) {
        told.links.push_back(share);
      }
    }
  }

  /// The shape by rows of the network.
  struct Weights {
    std::map<int, std::complex<double>> of_row;
    Weights(const ModeNetwork& network, const ModePart& part, const DampedMode& damped) {
      for (std::size_t i = 0; i < part.rows.size(); ++i) {
        const int row = part.rows[i];
        of_row[row] = damped.shape[static_cast<Eigen::Index>(i)] / network.root_mass[at(row)];
      }
    }
    std::complex<double> of(int row) const {
      const auto found = of_row.find(row);
      return found == of_row.end() ? 0.0 : found->second;
    }
  };

  /// The magnitude of a complex amplitude, with the sign of its real part: with damping the parts
  /// of a mode swing out of phase.
  static double realOf(std::complex<double> weight) {
    return weight.real() < 0.0 ? -std::abs(weight) : std::abs(weight);
  }

  std::complex<double> displacementAt(const Weights& weights,
                                      const ModeNetwork& network,
                                      int mat,
                                      int axis) const {
    std::complex<double> sum = 0.0;
    for (const auto& [node, weight] : sharesNow(network_, mat)) {
      const int row = network.row_of[at(node)];
      sum += row < 0 ? 0.0 : weight * weights.of(row + axis);
    }
    return sum;
  }

  /// Amplitude of a mode at an output: its displacement, or the force of its links.
  double amplitudeAt(const ModeNetwork& network,
                     const Weights& weights,
                     const scene::Output& output) const {
    if (output.quantity == scene::Quantity::kForce) {
      std::complex<double> force = 0.0;
      for (const HeardForce& heard : network.forces) {
        std::complex<double> elongation = 0.0;
        for (const Share& end : network.loads[at(heard.load)].ends) {
          elongation += end.weight * network.root_mass[at(end.node)] * weights.of(end.node);
        }
        force += heard.mat == output.point.mat ? heard.along[output.axis] * elongation : 0.0;
      }
      const double unit = scene_.time_unit_s;
      return realOf(force / (unit * unit));
    }
    const double fraction = output.point.fraction;
    std::complex<double> sum =
        (1.0 - fraction) * displacementAt(weights, network, output.point.mat, output.axis);
    if (output.point.next >= 0) {
      sum += fraction * displacementAt(weights, network, output.point.next, output.axis);
    }
    return realOf(sum);
  }

  void note(int count, const std::string& what) {
    if (count > 0) {
      found_.notes.push_back(std::to_string(count) + (count == 1 ? " link " : " links ") + what);
    }
  }

  void addNotes() {
    note(held_, "to modules of another rate: these are held there, and their own modes told apart");
    note(energy_stable_,
         "with an energy-stable linear part: its frequency is that of the explicit step");
    note(relaxing_, "that remember: the memory is left out");
    for (int s = 0; s < static_cast<int>(scene_.sections.size()); ++s) {
      if (leavesModesOut(network_, s)) {
        found_.notes.push_back("section " + scene::quoted(scene_.sections[at(s)].name) +
                               " is played by fewer modes than it has");
      }
    }
  }

  const Scene& scene_;
  Rates rates_;
  ModeWindow window_;
  Network network_;
  std::vector<unsigned char> is_heard_;
  std::vector<int> points_;
  std::vector<FoundMode> modes_;
  std::map<int, int> rigid_;  // by section
  SceneModes found_;
  int held_ = 0;
  int energy_stable_ = 0;
  int relaxing_ = 0;
};

}  // namespace

SceneModes modesOf(const Scene& scene,
                   const Rates& rates,
                   const ModeWindow& window,
                   const Scene& asked) {
  return Collector(scene, rates, window).run(asked);
}

}  // namespace ergotic::physics
