// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <utility>

#include "at.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/physics/settling/chaplet.hpp"
#include "ergotic/scene/grid.hpp"
#include "physics/note.hpp"
#include "physics/settling/chaplet_load.hpp"
#include "physics/settling/steps.hpp"

namespace ergotic::physics {
namespace {

using scene::Geometry;
using scene::MatType;
using scene::Scene;

constexpr double kImpedanceRatio = 20.0;      // m wN over the impedance of the structure
constexpr double kSofteningRatio = 0.00074;   // a tenth of the series stiffness of C2, in m wN^2
constexpr double kNoticedShare = 1.0 / 50.0;  // of the slower mass: pulls it by 10 cents
constexpr double kLargestShare = 1.0 / 10.0;
constexpr double kLowFrequency = 0.02;  // of fN, where the hand feels the chaplet as a mass

/// A chaplet that a link will get.
struct Plan {
  int lia = 0;
  int slow = 0;  // its ends
  int fast = 0;
  Chaplet chaplet;
  ChapletLoad load;
  double slow_mass = 0.0;  // kg, 0: moved by a hand or from outside
  double dashpot = 0.0;    // to the ground of the slower mass, N s/m; 0: none
};

[[noreturn]] void fail(const Scene& scene, const scene::Lia& lia, const std::string& what) {
  throw TextError(scene.file, lia.place.line, lia.place.column,
                  "link '" + lia.name + "' asks for a filter, " + what);
}

int divisorOfMat(const Scene& scene, const Rates& rates, int mat) {
  return divisorOf(scene.sectionOf(scene.mats[at(mat)]), rates);
}

std::string quotedMat(const Scene& scene, int mat) {
  return "'" + scene.mats[at(mat)].name + "'";
}

/// R of a link. \throws TextError where C2 is of no use
int filterRatio(const Scene& scene, const scene::Lia& lia, int slow_divisor, int fast_divisor) {
  if (slow_divisor % fast_divisor == 0 &&
      slow_divisor / fast_divisor >= scene::kChapletC2LowestRatio) {
    return slow_divisor / fast_divisor;
  }
  fail(scene, lia,
       "but its ends are stepped every " + std::to_string(slow_divisor) + " and every " +
           std::to_string(fast_divisor) + " audio frames, ratio " +
           shortly(static_cast<double>(slow_divisor) / fast_divisor) +
           ", allowed: whole ratios R >= " + std::to_string(scene::kChapletC2LowestRatio) +
           " (the chaplet C2 needs them). Lower the slower rate (gestural_rate or the rate of its "
           "section), raise the faster one, or leave the filter out");
}

/// Computes the chaplet's load on the slower end: its mass, and the dashpot that keeps hold and
/// mean from feeding energy into the modes of its section.
void planSlowEnd(const Network& network, const Rates& rates, Plan& plan) {
  const Scene& scene = network.scene;
  const LinearNetwork around(network, scene.mats[at(plan.slow)].section);
  if (!around.moves(plan.slow)) {
    return;
  }
  plan.slow_mass = around.massAt(plan.slow);
  const double step = divisorOfMat(scene, rates, plan.slow) / rates.audio_hz;
  const double half_sine = std::sqrt(around.highestModeAt(plan.slow)) * step / 2.0;
  const double angle = 2.0 * std::asin(std::min(half_sine, 1.0));  // w T of the explicit scheme
  // Z (w T)^2/8 makes up for the lag of T/2 with which the held end brakes, to leading order; R of
  // 4...8 asks for up to 1.25 times that.
  plan.dashpot = 2.0 * plan.chaplet.stages().front().damping * angle * angle / 8.0;
}

void requireLightness(const Scene& scene, const Plan& plan) {
  const double share = plan.chaplet.mass() / plan.slow_mass;
  if (plan.slow_mass > 0.0 && share > kLargestShare) {
    fail(scene, scene.lias[at(plan.lia)],
         "which would weigh " + shortly(plan.chaplet.mass()) + " kg, but the slower end " +
             quotedMat(scene, plan.slow) + " has " + shortly(plan.slow_mass) +
             " kg, allowed: a filter of at most a tenth of it. Make that mass heavier, the "
             "structure at " +
             quotedMat(scene, plan.fast) + " lighter or softer, or the slower rate higher");
  }
}

Plan planFilter(const Network& network, const Rates& rates, int index) {
  const Scene& scene = network.scene;
  const scene::Lia& lia = scene.lias[at(index)];
  const bool a_is_slow = divisorOfMat(scene, rates, lia.a) >= divisorOfMat(scene, rates, lia.b);
  const int slow = a_is_slow ? lia.a : lia.b;
  const int fast = a_is_slow ? lia.b : lia.a;
  const int fast_divisor = divisorOfMat(scene, rates, fast);
  const int ratio = filterRatio(scene, lia, divisorOfMat(scene, rates, slow), fast_divisor);
  const Geometry geometry = scene.sectionOf(scene.mats[at(slow)]).geometry;
  if (geometry == Geometry::kPlane || geometry == Geometry::kSpace) {
    fail(scene, lia,
         "but its slower end " + quotedMat(scene, slow) +
             " moves in more than one coordinate, allowed: scalar and line sections (a dashpot of "
             "length 0 has no direction there)");
  }
  const LinearNetwork around(network, scene.mats[at(fast)].section);
  if (!around.moves(fast)) {
    fail(scene, lia,
         "but its faster end " + quotedMat(scene, fast) +
             " is not moved by forces: there is nothing to filter for");
  }
  const double step = fast_divisor / rates.audio_hz;
  const double nyquist = 3.14159265358979323846 / (ratio * step);
  const ChapletLoad load = loadAt(around, fast, nyquist);
  const double mass = std::max(kImpedanceRatio * load.damping / nyquist,
                               load.stiffness / (kSofteningRatio * nyquist * nyquist));
  Plan plan{index, slow, fast, tunedChaplet(scene::kChapletC2, mass, step, ratio), load};
  planSlowEnd(network, rates, plan);
  requireLightness(scene, plan);
  return plan;
}

/// Rest, position and velocity at the start; those of a point are those around it.
scene::Mat startOf(const Scene& scene, int mat) {
  const auto connection = std::find_if(scene.connections.begin(), scene.connections.end(),
                                       [&](const scene::Connection& c) { return c.mat == mat; });
  scene::Mat start = scene.mats[at(mat)];
  if (connection == scene.connections.end()) {
    return start;
  }
  const scene::GridPlace place = scene::placeOf(scene, *connection);
  start.rest.setZero();
  start.position.setZero();
  start.push = {};
  for (std::size_t i = 0; i < at(place.count); ++i) {
    const scene::Mat& around = scene.mats[at(place.mats[i])];
    start.rest += place.weights[i] * around.rest;
    start.position += place.weights[i] * around.position;
    start.push.edit().velocity += place.weights[i] * around.push->velocity;
  }
  return start;
}

/// Adds what was planned to a scene.
class Inserter {
 public:
  Inserter(Scene& scene, const Plan& plan)
      : scene_(scene),
        plan_(plan),
        name_(scene.lias[at(plan.lia)].name + ".filter"),
        place_(scene.lias[at(plan.lia)].place),
        start_(startOf(scene, plan.slow)) {}

  void insert() {
    const int section = chooseSection();
    int last = plan_.slow;
    for (const scene::ChapletStage& stage : plan_.chaplet.stages()) {
      const int mass = addMat(std::to_string(stages_), MatType::kMass, section, stage.mass);
      addLia("link." + std::to_string(stages_), last, mass, stage.stiffness, stage.damping);
      last = mass;
      ++stages_;
    }
    if (plan_.dashpot > 0.0) {
      const int slow_section = scene_.mats[at(plan_.slow)].section;
      const int ground = addMat("ground", MatType::kGround, slow_section, 0.0);
      addLia("dashpot", plan_.slow, ground, 0.0, plan_.dashpot);
    }
    scene::Lia& lia = scene_.lias[at(plan_.lia)];
    (lia.a == plan_.slow ? lia.a : lia.b) = last;
    lia.filtered = false;
  }

 private:
  /// Chooses the section of the chaplet: that of the faster end if the chaplet moves there as at
  /// the slower end, along the same axis and without gravity or medium; otherwise a new one.
  int chooseSection() {
    const scene::Section slow = scene_.sectionOf(scene_.mats[at(plan_.slow)]);
    const int fast_index = scene_.mats[at(plan_.fast)].section;
    const scene::Section& fast = scene_.sections[at(fast_index)];
    const scene::Value& medium = fast.medium;
    if (fast.geometry == slow.geometry && fast.gravity.isZero() && medium.factor == 0.0 &&
        fast.sleep_energy == 0.0) {
      return fast_index;
    }
    scene::Section own;
    own.name = name_;
    own.gestural = fast.gestural;
    own.divisor = fast.divisor;
    own.geometry = slow.geometry;
    own.pose = slow.pose;
    own.starts_in_balance = slow.geometry == scene::Geometry::kScalar && fast.starts_in_balance;
    own.place = place_;
    scene_.sections.push_back(std::move(own));
    return static_cast<int>(scene_.sections.size()) - 1;
  }

  int addMat(const std::string& name, MatType type, int section, double mass) {
    scene::Mat mat;
    mat.name = name_ + "." + name;
    mat.type = type;
    mat.section = section;
    mat.mass = scene::Value{mass};
    mat.rest = start_.rest;
    mat.position = start_.position;
    if (type == MatType::kMass) {
      mat.push.edit().velocity = start_.push->velocity;
    }
    mat.place = place_;
    scene_.mats.push_back(std::move(mat));
    return static_cast<int>(scene_.mats.size()) - 1;
  }

  void addLia(const std::string& name, int a, int b, double stiffness, double damping) {
    const double unit = scene_.time_unit_s;
    scene::Lia lia;
    lia.name = name_ + "." + name;
    lia.a = a;
    lia.b = b;
    lia.stiffness = scene::Value{stiffness * unit * unit};
    lia.damping = scene::Value{damping * unit};
    lia.place = place_;
    scene_.lias.push_back(std::move(lia));
  }

  Scene& scene_;
  const Plan& plan_;
  std::string name_;
  scene::Place place_;
  scene::Mat start_;
  int stages_ = 0;
};

std::string responseNote(const Plan& plan) {
  const double nyquist = plan.chaplet.nyquistHz();
  const auto level = [&](double share, const ChapletLoad& load) {
    return shortly(decibels(plan.chaplet.gain(share * nyquist, load)));
  };
  std::string text = "its gain (without load, loaded): ";
  for (const double share : {0.25, 0.5, 1.0, 1.5}) {
    text += level(share, {}) + ", " + level(share, plan.load) + " dB at " +
            shortly(share * nyquist) + (share < 1.5 ? " Hz; " : " Hz");
  }
  return text;
}

std::string noteOnFilter(const Scene& scene, const Plan& plan) {
  const scene::Lia& lia = scene.lias[at(plan.lia)];
  const Chaplet& chaplet = plan.chaplet;
  const double low = kLowFrequency * chaplet.nyquistHz();
  std::string text = noteAt(scene, lia.place) + "link '" + lia.name +
                     "' is filtered by a chaplet (a mechanical low-pass) of " +
                     shortly(chaplet.mass()) + " kg, tuned to " + shortly(chaplet.nyquistHz()) +
                     " Hz; what it is loaded with at " + quotedMat(scene, plan.fast) + ": " +
                     shortly(plan.load.damping) + " N s/m and " + shortly(plan.load.stiffness) +
                     " N/m; its stiffness in series: " + shortly(chaplet.seriesStiffness()) +
                     " N/m; its mass as felt at " + quotedMat(scene, plan.slow) +
                     " without load: " + shortly(chaplet.apparentMass(low, {})) + " kg; " +
                     responseNote(plan);
  if (plan.dashpot > 0.0) {
    text += "; " + quotedMat(scene, plan.slow) + " gets a dashpot of " + shortly(plan.dashpot) +
            " N s/m to the ground, for stability between the two rates";
  }
  if (plan.slow_mass > 0.0 && chaplet.mass() > kNoticedShare * plan.slow_mass) {
    text += "; it weighs more than 1/50 of " + quotedMat(scene, plan.slow) + " (" +
            shortly(plan.slow_mass) + " kg) and pulls its pitch by more than 10 cents";
  }
  return text;
}

}  // namespace

void insertFilters(Scene& scene, const Rates& rates, std::vector<std::string>& notes) {
  const auto isFiltered = [](const scene::Lia& lia) { return lia.filtered; };
  if (std::none_of(scene.lias.begin(), scene.lias.end(), isFiltered)) {
    return;
  }
  const Network network(scene);
  std::vector<Plan> plans;
  for (std::size_t i = 0; i < scene.lias.size(); ++i) {
    if (isFiltered(scene.lias[i])) {
      plans.push_back(planFilter(network, rates, static_cast<int>(i)));
    }
  }
  for (const Plan& plan : plans) {
    notes.push_back(noteOnFilter(scene, plan));
    Inserter(scene, plan).insert();
  }
}

}  // namespace ergotic::physics
