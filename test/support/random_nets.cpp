// SPDX-License-Identifier: BSD-3-Clause
#include "support/random_nets.hpp"

#include <algorithm>
#include <vector>

#include "support/nets.hpp"

namespace ergotic::test {
namespace {

constexpr int kModules = 600;
constexpr double kRateHz = 44100.0;
constexpr int kRatio = 14;

class Thrower {
 public:
  Thrower(unsigned seed, bool has_two_rates) : two_rates_(has_two_rates), nets_(b_) {
    nets_.random.seed(seed);
  }

  RandomNets take() {
    makeSections();
    const int most = oneOf(20, kModules);
    do {
      addNet();
    } while (size() < most && !isOneIn(4));
    if (isOneIn(2)) {
      addStrays();
    }
    if (two_rates_) {
      addHammers();
    }
    if (!plain_ && isOneIn(2)) {
      addInput();
    }
    hearSome();
    return {b_.scene, plain_};
  }

 private:
  int oneOf(int low, int high) {
    return low + static_cast<int>(nets_.random() % static_cast<unsigned>(high - low + 1));
  }
  bool isOneIn(int n) { return oneOf(1, n) == 1; }
  int size() const { return static_cast<int>(b_.scene.mats.size()); }
  int anyModule() { return oneOf(0, size() - 1); }
  scene::Mat& mat(int m) { return b_.scene.mats[static_cast<std::size_t>(m)]; }

  void makeSections() {
    plain_ = isOneIn(2);
    scene::Section other;
    other.name = "other";
    other.divisor = two_rates_ ? 2 : 1;
    b_.scene.sections.push_back(other);
    for (scene::Section& section : b_.scene.sections) {
      section.gravity.x() = isOneIn(3) ? -9.81 : 0.0;
      section.medium = {!plain_ && isOneIn(3) ? 0.1 : 0.0};
    }
    nets_.has_cells = !plain_ && isOneIn(2);
  }

  double rateOf(int section) const {
    const scene::Section& of = b_.scene.sections[static_cast<std::size_t>(section)];
    return kRateHz / (of.gestural ? kRatio : of.divisor);
  }

  void addNet() {
    nets_.section = isOneIn(3) ? 2 : SceneBuilder::kAudio;
    if (two_rates_ && isOneIn(5)) {
      nets_.section = SceneBuilder::kGestural;
    }
    nets_.rate_hz = rateOf(nets_.section);
    nets_.kappa = nets_.any(0.02, 0.1);
    nets_.zeta = isOneIn(3) ? 0.0 : nets_.any(0.0, 0.02);
    nets_.scatter = isOneIn(2) ? 0.0 : 0.3;
    nets_.has_one_ratio = isOneIn(2);
    nets_.rest_length = isOneIn(4) ? 1e-3 : 0.0;
    nets_.ground_position = isOneIn(4) ? 1e-3 : 0.0;
    switch (oneOf(0, 6)) {
      case 0:
        return addStrings();
      case 1:
      case 5:
        nets_.plate(oneOf(3, 12), oneOf(3, 50), isOneIn(2), isOneIn(2));
        return;
      case 2:
        nets_.bar(oneOf(3, 200));
        return;
      case 3:
        nets_.triangles(oneOf(2, 16));
        return;
      case 4:
        nets_.star(oneOf(1, 100));
        return;
      default:
        nets_.string(oneOf(2, 300), anyEnds());
    }
  }

  Nets::Ends anyEnds() {
    return std::vector{Nets::Ends::kFixed, Nets::Ends::kFree,
                       Nets::Ends::kFixedAndFree}[static_cast<std::size_t>(oneOf(0, 2))];
  }

  void addStrings() {
    const Nets::Ends ends = anyEnds();
    const int shortest = oneOf(2, 20);
    const int longest = shortest + (isOneIn(2) ? 0 : oneOf(1, 10));
    for (int n = oneOf(2, 40); n > 0 && size() < kModules; --n) {
      nets_.string(oneOf(shortest, longest), ends);
    }
  }

  /// Links that fit nowhere: between any two, some beside others.
  void addStrays() {
    nets_.scatter = 0.3;
    nets_.kappa = 0.01;
    for (int n = oneOf(1, 10); n > 0; --n) {
      int a = anyModule();
      int b = anyModule();
      if (isOneIn(3) && !b_.scene.lias.empty()) {
        const auto l =
            static_cast<std::size_t>(oneOf(0, static_cast<int>(b_.scene.lias.size()) - 1));
        a = b_.scene.lias[l].a;
        b = b_.scene.lias[l].b;
      }
      if (a != b) {
        nets_.rate_hz = std::min(rateOf(mat(a).section), rateOf(mat(b).section));
        nets_.join(a, b);
      }
    }
  }

  void addHammers() {
    for (int n = oneOf(1, 3); n > 0; --n) {
      const int to = anyModule();
      const int hammer = b_.mass(0.01, 2e-3, -1.0, SceneBuilder::kGestural);
      b_.link(scene::LiaType::kContact, hammer, to, 1000.0, 0.05);
    }
  }

  void addInput() {
    scene::Input input;
    input.name = "in";
    input.mat = anyModule();
    b_.scene.inputs.push_back(input);
  }

  void hearSome() {
    for (int channel = 0; channel < 6; ++channel) {
      b_.hear(anyModule(), channel, static_cast<scene::Quantity>(oneOf(0, 2)));
    }
    scene::Output& last = b_.scene.outputs.back();
    if (last.point.mat + 1 < size() &&
        mat(last.point.mat + 1).section == mat(last.point.mat).section) {
      last.point.next = last.point.mat + 1;
      last.point.fraction = 0.3;
    }
  }

  const bool two_rates_;
  bool plain_ = false;
  SceneBuilder b_;
  Nets nets_;
};

}  // namespace

RandomNets randomNets(unsigned seed, bool has_two_rates) {
  return Thrower(seed, has_two_rates).take();
}

}  // namespace ergotic::test
