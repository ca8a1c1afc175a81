// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "advice/target_parts.hpp"
#include "at.hpp"
#include "ergotic/advice/accuracy.hpp"
#include "ergotic/scene/generate/chaplet.hpp"
#include "physics/certificate/explicit_limits.hpp"
#include "physics/network/linear_network.hpp"
#include "scene/laws/law.hpp"

namespace ergotic::physics {
namespace {

using scene::FrictionSlopes;
using scene::MatType;
using scene::Scheme;

constexpr double kDepth = 1e-3;   // m, of a contact that is judged
constexpr double kHandHz = 20.0;  // of the hand's motion
constexpr int kIterations = 30;

/// The linear networks of all sections, made when they are needed.
class Networks {
 public:
  explicit Networks(const scene::Scene& scene) : whole_(scene) {}
  const Network& whole() const { return whole_; }
  const LinearNetwork& around(int mat) {
    const int section = whole_.scene.mats[at(mat)].section;
    return networks_.try_emplace(section, whole_, section).first->second;
  }

 private:
  Network whole_;
  std::map<int, LinearNetwork> networks_;
};

/// One end of a link: its mass, and the impedance of waves that leave from there.
struct End {
  double mass = std::numeric_limits<double>::infinity();  // kg
  double impedance = 0.0;                                 // kg/s
  scene::Section section;
  bool is_hand = false;
};

End endAt(const scene::Scene& scene, Networks& networks, int mat) {
  End end;
  end.section = scene.sectionOf(scene.mats[at(mat)]);
  end.is_hand = scene.mats[at(mat)].type == MatType::kSlice;
  const LinearNetwork& network = networks.around(mat);
  if (network.moves(mat)) {
    end.mass = network.massAt(mat);
    end.impedance = network.impedanceAt(mat);
  }
  return end;
}

double reduced(double a, double b) {
  return 1.0 / (1.0 / a + 1.0 / b);
}

/// Data of a link on which every judgement of it depends.
struct Touch {
  int lia = 0;
  std::string name;
  Scheme scheme = Scheme::kExplicit;  // as the scene has it
  bool can_be_energy_stable = false;
  End a;
  End b;

  /// Rate of the faster end, Hz, and of the slower.
  double fastHz(const Rates& rates) const {
    return rates.audio_hz / std::min(divisorOf(a.section, rates), divisorOf(b.section, rates));
  }
  double slowHz(const Rates& rates) const {
    return rates.audio_hz / std::max(divisorOf(a.section, rates), divisorOf(b.section, rates));
  }
  const End& slowEnd(const Rates& rates) const {
    return divisorOf(a.section, rates) > divisorOf(b.section, rates) ? a : b;
  }
  bool crosses(const Rates& rates) const { return slowHz(rates) != fastHz(rates); }
  double lightest() const { return reduced(a.mass, b.mass); }
};

Touch touchOf(const scene::Scene& scene, Networks& networks, int index) {
  const scene::Lia& lia = scene.lias[at(index)];
  return {index,
          lia.name,
          lia.scheme,
          scene::canBeEnergyStable(scene, lia),
          endAt(scene, networks, lia.a),
          endAt(scene, networks, lia.b)};
}

/// A link whose scheme may be chosen.
class SchemePart : public TargetPart {
 public:
  explicit SchemePart(Touch touch) : touch_(std::move(touch)) {}

  std::string name() const override { return "link '" + touch_.name + "'"; }

  PartOption asItIs(const Rates& rates) const override {
    const bool energy_stable =
        touch_.scheme == Scheme::kEnergyStable ||
        (touch_.scheme == Scheme::kAuto && canBeEnergyStable(rates) && mustBeEnergyStable(rates));
    return option(energy_stable ? Scheme::kEnergyStable : Scheme::kExplicit, rates);
  }

  PartOption choose(const Rates& rates, double allowed) const override {
    PartOption present = asItIs(rates);
    if (present.error <= allowed || present.scheme == Scheme::kEnergyStable ||
        !canBeEnergyStable(rates)) {
      return present;
    }
    PartOption energy_stable = option(Scheme::kEnergyStable, rates);
    energy_stable.change = "explicit -> energy_stable";
    return energy_stable.error < present.error ? energy_stable : present;
  }

  void apply(scene::Scene& scene, const PartOption& option) const override {
    if (!option.change.empty()) {
      scene.lias[at(touch_.lia)].scheme = option.scheme;
    }
  }

 protected:
  const Touch& touch() const { return touch_; }
  virtual bool mustBeEnergyStable(const Rates& rates) const = 0;
  virtual double errorOf(Scheme scheme, const Rates& rates) const = 0;

 private:
  /// True if it may be energy-stable: not on a slower mass, where its passivity is not proven.
  bool canBeEnergyStable(const Rates& rates) const {
    const bool onto_slow_mass = touch_.crosses(rates) && std::isfinite(touch_.slowEnd(rates).mass);
    return touch_.can_be_energy_stable && !onto_slow_mass;
  }
  PartOption option(Scheme scheme, const Rates& rates) const {
    PartOption result;
    result.scheme = scheme;
    result.error = errorOf(scheme, rates);
    result.cost = touch_.fastHz(rates) *
                  (scheme == Scheme::kEnergyStable ? kEnergyStableCost : kNonlinearCost);
    return result;
  }

  Touch touch_;
};

class ContactPart final : public SchemePart {
 public:
  ContactPart(Touch touch, double stiffness, double exponent, Target::Unit unit)
      : SchemePart(std::move(touch)), stiffness_(stiffness), exponent_(exponent), unit_(unit) {
    // An end is as heavy as what its waves reach while they touch.
    for (int i = 0; i < kIterations; ++i) {
      const double mass = reduced(this->touch().a.mass + this->touch().a.impedance * duration_s_,
                                  this->touch().b.mass + this->touch().b.impedance * duration_s_);
      duration_s_ = contactDuration(exponent_, stiffness_, mass, kDepth);
    }
  }

  std::string figure() const override {
    return unit_ == Target::Unit::kCents      ? "duration"
           : unit_ == Target::Unit::kDecibels ? "force"
                                              : "duration and force";
  }

 private:
  bool mustBeEnergyStable(const Rates& /*rates*/) const override {
    return exponent_ > 1.0 || stiffness_ / touch().lightest() > 0.0;
  }
  double errorOf(Scheme scheme, const Rates& rates) const override {
    const double steps = duration_s_ * touch().fastHz(rates);
    double worst = 0.0;
    if (unit_ != Target::Unit::kDecibels) {
      worst = contactError(ContactFigure::kDuration, scheme, exponent_, steps);
    }
    if (unit_ != Target::Unit::kCents) {
      worst = std::max(worst, contactError(ContactFigure::kPeakForce, scheme, exponent_, steps));
      if (touch().crosses(rates) && !touch().slowEnd(rates).is_hand) {
        worst = std::max(worst, heldContactError(false, duration_s_ * touch().slowHz(rates)));
      }
    }
    return worst;
  }

  double stiffness_;
  double exponent_;
  Target::Unit unit_;
  double duration_s_ = 0.0;
};

class BowPart final : public SchemePart {
 public:
  /// \param rise, fall  steepest slopes, N s/m
  BowPart(Touch touch, double pitch_hz, FrictionSlopes slopes)
      : SchemePart(std::move(touch)), pitch_hz_(pitch_hz), slopes_(slopes) {}

  std::string figure() const override { return "pitch of stick and slip"; }

 private:
  bool mustBeEnergyStable(const Rates& rates) const override {
    const double unit = 1.0 / (touch().lightest() * touch().fastHz(rates));
    return unit * slopes_.rise >= kExplicitFriction || unit * slopes_.fall >= kExplicitFalling;
  }
  double errorOf(Scheme scheme, const Rates& rates) const override {
    return bowError(scheme, touch().fastHz(rates) / pitch_hz_);
  }

  double pitch_hz_;
  FrictionSlopes slopes_;
};

/// A hand at a faster structure: what is heard of its steps.
class HandPart final : public TargetPart {
 public:
  HandPart(Touch touch, scene::Coupling coupling, bool can_be_filtered)
      : touch_(std::move(touch)), coupling_(coupling), can_be_filtered_(can_be_filtered) {}

  std::string name() const override { return "hand at link '" + touch_.name + "'"; }
  std::string figure() const override { return "steps of a hand that moves at 20 Hz"; }
  PartOption asItIs(const Rates& rates) const override { return option(coupling_, rates); }
  PartOption choose(const Rates& rates, double allowed) const override {
    PartOption present = asItIs(rates);
    const double ratio = touch_.fastHz(rates) / touch_.slowHz(rates);
    if (present.error <= allowed || !can_be_filtered_ || ratio < scene::kChapletC2LowestRatio) {
      return present;
    }
    PartOption filtered = option(scene::Coupling::kChaplet, rates);
    filtered.change = "with a chaplet (filter: auto)";
    return filtered;
  }
  void apply(scene::Scene& scene, const PartOption& option) const override {
    scene.lias[at(touch_.lia)].filtered = option.filtered;
  }

 private:
  PartOption option(scene::Coupling coupling, const Rates& rates) const {
    PartOption result;
    result.filtered = coupling == scene::Coupling::kChaplet;
    result.error =
        touch_.crosses(rates) ? handError(coupling, touch_.slowHz(rates) / kHandHz) : 0.0;
    result.cost = result.filtered ? kChapletCost * touch_.fastHz(rates) : 0.0;
    return result;
  }

  Touch touch_;
  scene::Coupling coupling_;
  bool can_be_filtered_;
};

/// Pitch of the string that a module or point belongs to, Hz; 0: it is on none.
double pitchAt(const scene::Scene& scene, int mat) {
  for (const scene::StringInfo& string : scene.strings) {
    const auto is_on = [&](int module) {
      return module >= string.first && module < string.first + string.count;
    };
    const bool by_point = std::any_of(scene.connections.begin(), scene.connections.end(),
                                      [&](const scene::Connection& c) {
                                        return c.mat == mat && is_on(scene.grids[at(c.grid)].first);
                                      });
    if (is_on(mat) || by_point) {
      return scene::idealPitchHz(scene, string);
    }
  }
  return 0.0;
}

/// Pitch of what a bow excites: its string, else the lowest mode of what it rubs.
double bowedPitchHz(const scene::Scene& scene, Networks& networks, const scene::Lia& lia) {
  for (const int mat : {lia.a, lia.b}) {
    const double pitch_hz = pitchAt(scene, mat);
    if (pitch_hz > 0.0) {
      return pitch_hz;
    }
    const LinearNetwork& network = networks.around(mat);
    if (network.moves(mat) && network.stiffnessAt(mat) > 0.0) {
      return std::sqrt(network.stiffnessAt(mat) / network.massAt(mat)) / (2.0 * M_PI);
    }
  }
  return 0.0;
}

/// Adds what a link has at stake.
class LinkFinder {
 public:
  LinkFinder(const scene::Scene& scene,
             const std::vector<std::string>& chaplets,
             Target::Unit unit,
             Parts& parts)
      : scene_(scene), networks_(scene), chaplets_(chaplets), unit_(unit), parts_(parts) {}

  void add(int index) {
    const scene::Lia& lia = scene_.lias[at(index)];
    const scene::Law::Kind kind = scene::lawOf(lia.type).kind;
    if (kind == scene::Law::Kind::kGap) {
      addContact(index, lia);
    } else if (kind == scene::Law::Kind::kFriction && unit_ != Target::Unit::kDecibels) {
      addBow(index, lia);
    }
    if (unit_ != Target::Unit::kCents) {
      addHand(index, lia);
    }
  }

 private:
  void addContact(int index, const scene::Lia& lia) {
    const Touch touch = touchOf(scene_, networks_, index);
    const double unit = std::pow(scene_.time_unit_s, -2);
    const double exponent = scene_.valueOf(lia.law->exponent);  // 1 of those that have none
    const double stiffness =
        unit * (scene::lawOf(lia.type).growth != nullptr
                    ? scene_.valueOf(lia.stiffness)
                    : networks_.whole().links[at(index)].slopes.stiffness.highest);
    if (stiffness > 0.0 && std::isfinite(touch.lightest())) {
      parts_.push_back(std::make_unique<ContactPart>(touch, stiffness, exponent, unit_));
    }
  }

  void addBow(int index, const scene::Lia& lia) {
    const Touch touch = touchOf(scene_, networks_, index);
    const double pitch_hz = bowedPitchHz(scene_, networks_, lia);
    if (pitch_hz > 0.0) {
      const FrictionSlopes slopes = scene::lawOf(lia.type).friction(scene_, lia);
      const double unit = 1.0 / scene_.time_unit_s;
      parts_.push_back(std::make_unique<BowPart>(
          touch, pitch_hz, FrictionSlopes{unit * slopes.rise, unit * slopes.fall}));
    }
  }

  void addHand(int index, const scene::Lia& lia) {
    const scene::Mat& a = scene_.mats[at(lia.a)];
    const scene::Mat& b = scene_.mats[at(lia.b)];
    const bool from_a = a.type == MatType::kSlice;
    if (from_a == (b.type == MatType::kSlice) || a.section == b.section) {
      return;
    }
    const int other = from_a ? lia.b : lia.a;
    const scene::Geometry geometry = scene_.sectionOf(from_a ? a : b).geometry;
    const scene::Coupling said = (from_a ? a : b).coupling;
    const bool is_filtered = lia.filtered || isOfChaplet(other);
    const bool can_be_filtered = scene::dimensionsOf(geometry) == 1 &&
                                 networks_.around(other).moves(other) && !isOfChaplet(other) &&
                                 said == scene::Coupling::kHold;
    parts_.push_back(std::make_unique<HandPart>(touchOf(scene_, networks_, index),
                                                is_filtered ? scene::Coupling::kChaplet : said,
                                                can_be_filtered));
  }

  bool isOfChaplet(int mat) const {
    const std::string& name = scene_.mats[at(mat)].name;
    return std::find(chaplets_.begin(), chaplets_.end(), name.substr(0, name.rfind('.'))) !=
           chaplets_.end();
  }

  const scene::Scene& scene_;
  Networks networks_;
  const std::vector<std::string>& chaplets_;
  Target::Unit unit_;
  Parts& parts_;
};

}  // namespace

void addLinkParts(const scene::Scene& scene,
                  const std::vector<std::string>& chaplets,
                  Target::Unit unit,
                  Parts& parts) {
  LinkFinder finder(scene, chaplets, unit, parts);
  for (int l = 0; l < static_cast<int>(scene.lias.size()); ++l) {
    finder.add(l);
  }
}

}  // namespace ergotic::physics
