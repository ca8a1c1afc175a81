// SPDX-License-Identifier: BSD-3-Clause
#include "support/random_scene.hpp"

#include <random>

#include "ergotic/physics/certificate/certify.hpp"
#include "ergotic/physics/settling/settle.hpp"
#include "support/scene_builder.hpp"
#include "support/test.hpp"

namespace ergotic::test {
namespace {

using scene::Geometry;
using scene::Lia;
using scene::LiaType;

constexpr double kAudioHz = 44100.0;
constexpr double kParticleKg = 1e-3;
constexpr double kUnit = kParticleKg * kAudioHz * kAudioHz;  // stiffness of kappa = 1
constexpr double kSpeed = 1.0;                               // m/s
constexpr double kSoftest = 0.02;                            // kappa of slow springs
constexpr int kAudio = SceneBuilder::kAudio;
constexpr int kGestural = SceneBuilder::kGestural;

class RandomMaker {
 public:
  explicit RandomMaker(unsigned seed) : random_(seed) {}

  RandomScene make() {
    made_.has_two_rates = chance(0.75);
    made_.is_nonlinear = chance(0.5);
    made_.is_near_limit = chance(1.0 / 3.0);
    made_.is_lossless = chance(0.4);
    made_.rates = {kAudioHz, made_.has_two_rates ? pick({2, 4, 8, 14, 44}) : 1};
    // A soft string has no modes above half the slower rate.
    const int ratio = made_.rates.ratio;
    is_soft_ = made_.has_two_rates && chance(0.5);
    kappa_ = is_soft_ ? 0.4 / (ratio * ratio) : within(0.05, 0.6);
    reach_ = kSpeed / (kAudioHz * std::sqrt(kappa_));
    // Of slow masses too: Euclidean links must not collapse, which turns their force about.
    mesh_ = 20.0 * std::max(reach_, kSpeed / (made_.rates.gesturalHz() * std::sqrt(kSoftest)));
    chooseGeometry();
    addString(12 + throwTo(6));
    addOthers(6 + throwTo(4));
    if (made_.has_two_rates) {
      addSlowChain(3 + throwTo(4));
      addCouplings(1 + throwTo(3));
    }
    if (made_.is_nonlinear) {
      addNonlinear(1 + throwTo(8));
    }
    addLoss();
    if (made_.is_near_limit) {
      approachLimit();
    } else if (chance(0.8)) {
      guardNets();
    }
    scene::validate(b_.scene);
    made_.scene = b_.scene;
    return made_;
  }

 private:
  double within(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  bool chance(double share) { return within(0.0, 1.0) < share; }
  /// 0 ... count - 1
  int throwTo(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  template <class Kind>
  Kind pick(std::initializer_list<Kind> all) {
    return *(all.begin() + throwTo(static_cast<int>(all.size())));
  }
  scene::Mat& mat(int m) { return b_.scene.mats[at(m)]; }
  Geometry geometryOf(int m) { return b_.scene.sectionOf(mat(m)).geometry; }
  bool actsAlongX(int x, int y) {
    return geometryOf(x) == Geometry::kScalar || geometryOf(y) == Geometry::kScalar;
  }

  void chooseGeometry() {
    const auto any = [this] {
      return chance(0.78) ? Geometry::kScalar
                          : pick({Geometry::kLine, Geometry::kPlane, Geometry::kSpace});
    };
    for (scene::Section& section : b_.scene.sections) {
      section.geometry = any();
    }
    if (chance(0.2)) {
      b_.scene.sections[kAudio].gravity.x() = -9.81;
    }
  }

  /// Places a module on the workbench and makes it move.
  int place(int m, double x, double y) {
    scene::Mat& here = mat(m);
    if (geometryOf(m) != Geometry::kScalar) {
      here.rest = mesh_ * Eigen::Vector3d(x, geometryOf(m) == Geometry::kLine ? 0.0 : y, 0.0);
      if (geometryOf(m) == Geometry::kSpace) {
        here.rest.z() = 0.3 * mesh_ * y;
      }
    }
    here.position = here.rest;
    if (here.type == scene::MatType::kMass || here.type == scene::MatType::kCell) {
      for (int k = 0; k < scene::dimensionsOf(geometryOf(m)); ++k) {
        here.push.edit().velocity[k] = within(-kSpeed, kSpeed);
      }
    }
    return m;
  }

  void addString(int masses) {
    first_ = place(b_.ground(), 0.0, 0.0);
    for (int i = 1; i <= masses; ++i) {
      moving_.push_back(place(b_.mass(kParticleKg * within(0.5, 2.0)), i, 0.0));
    }
    place(b_.ground(), masses + 1, 0.0);
    const double tension = kappa_ * kUnit * within(0.0, 0.5) * mesh_;
    for (int i = 0; i <= masses; ++i) {
      const double k = kappa_ * kUnit * within(0.5, 1.0);
      spring(first_ + i, first_ + i + 1, k);
      if (geometryOf(first_) != Geometry::kScalar) {
        b_.scene.lias.back().rest_length -= tension / k;
      }
    }
    b_.scene.grids.push_back({"string", first_, masses + 2, 1});
  }

  /// Cells and loose masses, each tied to two or three others.
  void addOthers(int count) {
    for (int i = 0; i < count; ++i) {
      const double kg = kParticleKg * within(0.5, 2.0);
      int m = 0;
      if (chance(0.4)) {
        m = b_.cell(kg, kappa_ * kUnit * within(0.1, 1.0), 0.0);
        mat(m).matched = !made_.is_near_limit;  // those do not scale
      } else {
        m = b_.mass(kg);
      }
      place(m, i + 0.5, 1.0 + within(0.0, 1.0));
      for (int links = 2 + throwTo(2); links > 0; --links) {
        spring(m, moving_[at(throwTo(static_cast<int>(moving_.size())))],
               kappa_ * kUnit * within(0.05, 0.5));
      }
      moving_.push_back(m);
    }
  }

  void addSlowChain(int masses) {
    const double slow_rate = made_.rates.gesturalHz();
    const double kg = kParticleKg * within(2.0, 50.0);
    const double k = within(kSoftest, 0.6) * kg * slow_rate * slow_rate;
    int last = place(b_.ground(0.0, kGestural), -1.0, -2.0);
    for (int i = 0; i < masses; ++i) {
      const int next = place(b_.mass(kg * within(0.5, 2.0), 0.0, 0.0, kGestural), i, -2.0);
      spring(last, next, k);
      slow_.push_back(next);
      last = next;
    }
    spring(last, place(b_.ground(0.0, kGestural), masses, -2.0), k);
  }

  void addCouplings(int count) {
    const double softest = kParticleKg * std::pow(made_.rates.gesturalHz(), 2);
    for (int i = 0; i < count; ++i) {
      const bool is_soft = chance(0.1) || is_soft_;
      const double k = is_soft ? softest * within(0.05, 0.5) : kappa_ * kUnit * within(0.02, 0.5);
      const int slow = slow_[at(throwTo(static_cast<int>(slow_.size())))];
      const int fast = chance(0.4) ? pointOnString() : chance(0.3) ? anyTap() : anyMoving();
      chance(0.5) ? spring(slow, fast, k) : spring(fast, slow, k);
    }
  }

  int anyMoving() { return moving_[at(throwTo(static_cast<int>(moving_.size())))]; }

  int anyTap() {
    std::vector<scene::Tap::Share> shares;
    for (const int m : moving_) {
      if (shares.empty() || chance(0.2)) {
        shares.push_back({m, within(-1.0, 1.5)});
      }
    }
    return b_.tap(shares);
  }

  int pointOnString() {
    const scene::Grid& grid = b_.scene.grids[0];
    const int m = b_.ground();
    scene::Mat& point = mat(m);
    point.type = scene::MatType::kPoint;
    scene::Connection connection;
    connection.mat = m;
    connection.along.at = {within(0.05, 0.95)};
    if (geometryOf(m) != Geometry::kScalar) {
      point.rest.x() = mesh_ * connection.along.at.factor * (grid.columns - 1);
      point.position = point.rest;
    }
    b_.scene.connections.push_back(connection);
    return m;
  }

  /// How far a is from b at rest, as their link sees it.
  double apart(int x, int y) {
    const Eigen::Vector3d between = mat(x).rest - mat(y).rest;
    return actsAlongX(x, y) ? between.x() : between.norm();
  }

  void spring(int x, int y, double k) {
    b_.spring(x, y, k);
    b_.scene.lias.back().rest_length = apart(x, y);
  }

  void addNonlinear(int count) {
    for (int i = 0; i < count; ++i) {
      const bool slow = !slow_.empty() && chance(0.2);
      const auto& from = slow ? slow_ : moving_;
      const int on = from[at(throwTo(static_cast<int>(from.size())))];
      const int a = !slow && chance(0.3) ? anyTap() : on;
      const int b = chance(0.3) ? otherGround(a) : otherMoving(a, from);
      const double rate = slow ? made_.rates.gesturalHz() : kAudioHz;
      addLaw(a, b, std::pow(10.0, within(-2.0, 1.0)) * mat(on).mass.factor * rate * rate, rate);
    }
  }

  int otherMoving(int a, const std::vector<int>& from) {
    int b = a;
    while (b == a) {
      b = from[at(throwTo(static_cast<int>(from.size())))];
    }
    return b;
  }

  int otherGround(int a) {
    const int g = b_.ground(0.0, mat(a).section);
    mat(g).rest =
        mat(a).rest + (geometryOf(a) == Geometry::kScalar ? Eigen::Vector3d::Zero().eval()
                                                          : Eigen::Vector3d(0.5 * mesh_, 0.0, 0.0));
    mat(g).position = mat(g).rest;
    return g;
  }

  /// A law whose slope is about k where the ends move.
  void addLaw(int x, int y, double k, double rate) {
    const LiaType type =
        pick({LiaType::kContact, LiaType::kPowerContact, LiaType::kQuadratic, LiaType::kCubic,
              LiaType::kClippedCubic, LiaType::kCubicContact, LiaType::kBow, LiaType::kSmoothBow,
              LiaType::kTable, LiaType::kFriction});
    Lia& lia = b_.scene.lias[at(b_.link(type, x, y, k))];
    lia.scheme = scene::Scheme::kAuto;
    const double reach = reach_ * kAudioHz / rate;
    const bool is_gap = type == LiaType::kContact || type == LiaType::kPowerContact ||
                        type == LiaType::kCubicContact;
    const double gap = within(-reach, reach);
    (is_gap ? lia.law.edit().width.factor : lia.rest_length) =
        gap + (is_gap ? nearness(x, y) : apart(x, y));
    if (!is_gap && !actsAlongX(x, y)) {
      lia.rest_length = std::max(lia.rest_length, 0.0);
    }
    shape(lia, k, reach, rate);
  }

  /// Threshold of a contact that just touches.
  double nearness(int x, int y) { return actsAlongX(x, y) ? -apart(x, y) : apart(x, y); }

  void shape(Lia& lia, double k, double reach, double rate) {
    switch (lia.type) {
      case LiaType::kPowerContact:
        lia.law.edit().exponent = {within(1.0, 3.0)};
        lia.stiffness = {k / std::pow(reach, lia.law->exponent.factor - 1.0)};
        break;
      case LiaType::kQuadratic:
        lia.law.edit().nonlinearity = {k / reach};
        break;
      case LiaType::kCubic:
        lia.law.edit().nonlinearity = {k / (reach * reach)};
        break;
      case LiaType::kClippedCubic:
      case LiaType::kCubicContact:
        lia.law.edit().nonlinearity = {k / (reach * reach)};
        lia.law.edit().stiffness_limit = {2.0 * k};
        lia.law.edit().tipping_point = reach;
        break;
      case LiaType::kBow:
      case LiaType::kSmoothBow:
        made_.is_lossless = false;
        lia.damping = {k / rate};
        lia.stiffness = {0.0};
        lia.rest_length = 0.0;
        lia.law.edit().width = {kSpeed * within(0.1, 1.0)};
        break;
      case LiaType::kFriction:
        made_.is_lossless = false;
        lia.stiffness = {0.0};
        lia.rest_length = 0.0;
        lia.law.edit().normal = {k * reach * within(0.01, 1.0)};
        lia.law.edit().steady = 0.3;
        lia.law.edit().falls[0] = {0.7, kSpeed * within(0.01, 1.0)};
        break;
      case LiaType::kTable:
        lia.stiffness = {0.0};
        lia.law.edit().table.points = {{-9.0 * reach, -9.0 * k * reach},
                                       {-reach, -0.3 * k * reach},
                                       {reach, 0.3 * k * reach},
                                       {9.0 * reach, 9.0 * k * reach}};
        lia.law.edit().table.smooth = chance(0.5);
        break;
      default:
        break;
    }
  }

  void addLoss() {
    if (made_.is_lossless) {
      return;
    }
    if (chance(0.5)) {
      b_.scene.sections[kAudio].medium = {kParticleKg * kAudioHz * within(1e-4, 1e-2)};
      b_.scene.sections[kGestural].medium = {kParticleKg * kAudioHz * within(1e-4, 1e-2)};
    }
    for (Lia& lia : b_.scene.lias) {
      if (lia.type == LiaType::kSpringDamper && chance(0.7)) {
        const double rate = mat(lia.a).section == kGestural && mat(lia.b).section == kGestural
                                ? made_.rates.gesturalHz()
                                : kAudioHz;
        lia.damping = {lia.stiffness.factor / rate * within(0.0, 0.2)};
      }
    }
  }

  /// Springs along lines that turn are certified only if they are energy-stable.
  void guardNets() {
    for (Lia& lia : b_.scene.lias) {
      const bool turns = lia.type == LiaType::kSpringDamper && !actsAlongX(lia.a, lia.b);
      lia.scheme = turns && lia.rest_length > 0.0 ? scene::Scheme::kEnergyStable : lia.scheme;
    }
  }

  /// Scales springs and dampers of a section until its lambda is nearly 4.
  void approachLimit() {
    const int section = is_soft_ ? kGestural : kAudio;
    for (scene::Section& s : b_.scene.sections) {
      s.medium = {};  // it makes masses matched ones, which do not scale
    }
    const physics::Settled settled = physics::settle(b_.scene, made_.rates);
    const double lambda = physics::certify(settled.scene, made_.rates).sections[at(section)].lambda;
    const double scale = within(3.6, 3.99) / lambda;
    for (Lia& lia : b_.scene.lias) {
      if (mat(lia.a).section == section && mat(lia.b).section == section) {
        lia.stiffness.factor *= scale;
        lia.damping.factor *= scale;
      }
    }
    for (scene::Mat& m : b_.scene.mats) {
      if (m.section == section) {
        m.stiffness.factor *= scale;
      }
    }
  }

  std::mt19937 random_;
  SceneBuilder b_;
  RandomScene made_;
  bool is_soft_ = false;

  double kappa_ = 0.0;  // of the string
  double reach_ = 0.0;  // m, how far it moves
  double mesh_ = 0.0;   // m, between neighbours of Euclidean sections
  int first_ = 0;
  std::vector<int> moving_;  // of the audio section
  std::vector<int> slow_;
};

}  // namespace

RandomScene randomScene(unsigned seed) {
  return RandomMaker(seed).make();
}

}  // namespace ergotic::test
