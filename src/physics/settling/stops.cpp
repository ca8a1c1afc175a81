// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <utility>

#include "at.hpp"
#include "ergotic/scene/grid.hpp"
#include "physics/note.hpp"
#include "physics/settling/steps.hpp"
#include "physics/step_units.hpp"

namespace ergotic::physics {
namespace {

constexpr double kMaxShare = 3.0;  // of M/h^2
constexpr double kSafe = 0.8;      // of what is left below 4, where steps are no longer stable

/// A module that a stop meets, as far as it takes part.
struct Met {
  int mat = 0;
  double weight = 1.0;
};

class StopSettler {
 public:
  StopSettler(scene::Scene& scene, const Rates& rates)
      : scene_(scene), rates_(rates), load_(scene.mats.size()), pull_(scene.mats.size()) {
    for (const scene::Lia& lia : scene.lias) {
      if (lia.type != scene::LiaType::kSpringDamper) {
        continue;
      }
      for (const int end : {lia.a, lia.b}) {
        const double stiffness = scene.valueOf(lia.stiffness);
        load_[at(end)] += std::abs(stiffness);
        pull_[at(end)] += lia.bend < 0 ? stiffness : 0.0;
      }
    }
  }

  void run(std::vector<std::string>& notes) {
    for (const scene::Tuning& stops : scene_.tunings) {
      double softest = 0.0;
      const auto* const first = pointOf(scene_.lias[at(stops.first_lia)].b);
      // Frets are counted from the nut: the first is a seventeenth of the string away from it.
      const bool sounds_to_first = first != nullptr && first->along.at.factor > 0.5;
      for (int l = stops.first_lia; l < stops.first_lia + stops.lias; ++l) {
        scene::Lia& lia = scene_.lias[at(l)];
        scene::Connection* const point = pointOf(lia.b);
        softest = std::max(softest, point == nullptr ? settle(lia, {{lia.b, 1.0}})
                                                     : settleFret(lia, *point, sounds_to_first));
      }
      notes.push_back(noteAt(scene_, stops.place) + "'" + stops.name + "' yields " +
                      shortly(softest) + " times as much as a spring of its string at most");
    }
  }

 private:
  scene::Connection* pointOf(int mat) const {
    const auto found =
        std::find_if(scene_.connections.begin(), scene_.connections.end(),
                     [mat](const scene::Connection& point) { return point.mat == mat; });
    return found == scene_.connections.end() ? nullptr : &*found;
  }

  std::vector<Met> metBy(const scene::Connection& point) const {
    const scene::GridPlace around = scene::placeOf(scene_, point);
    std::vector<Met> met;
    for (std::size_t i = 0; i < at(around.count); ++i) {
      met.push_back({around.mats[i], around.weights[i]});
    }
    return met;
  }

  /// A string that sounds up to a mass, and from there on is held at w of the way to the next by K,
  /// ends (w^2 + Ks/K) spacings behind that mass, Ks its own springs: so the point is moved until
  /// that is where the fret is.
  double settleFret(scene::Lia& lia, scene::Connection& point, bool sounds_to_first) const {
    constexpr int kPasses = 4;  // K depends on the point a little
    const int spacings = scene_.grids[at(point.grid)].columns - 1;
    const double fret = point.along.at.factor;
    const double sounding = spacings * (sounds_to_first ? fret : 1.0 - fret);
    double yields = settle(lia, metBy(point));
    for (int pass = 0; pass < kPasses; ++pass) {
      const double end = std::max(0.0, sounding - yields);
      const double whole = std::floor(end);
      const double place = (whole + std::sqrt(end - whole)) / spacings;
      point.along.at.factor = sounds_to_first ? place : 1.0 - place;
      yields = settle(lia, metBy(point));
    }
    scene::Mat& mat = scene_.mats[at(point.mat)];
    mat.rest = mat.position = Eigen::Vector3d::Zero();
    for (const Met& met : metBy(point)) {
      mat.rest += met.weight * scene_.mats[at(met.mat)].rest;
      mat.position += met.weight * scene_.mats[at(met.mat)].position;
    }
    return yields;
  }

  /// \return Ks/K
  double settle(scene::Lia& lia, const std::vector<Met>& all) const {
    scene::Value mass;
    double inverse = 0.0;  // 1/kg, of what it meets
    double load = 0.0;     // of the springs there, over the mass
    double pull = 0.0;     // of two springs
    for (const Met& met : all) {
      const scene::Mat& mat = scene_.mats[at(met.mat)];
      if (mat.type == scene::MatType::kGround) {
        continue;
      }
      mass = mat.mass;
      inverse += met.weight * met.weight / scene_.valueOf(mat.mass);
      load = std::max(load, load_[at(met.mat)] / scene_.valueOf(mat.mass));
      pull = std::max(pull, pull_[at(met.mat)]);
    }
    if (!(inverse > 0.0)) {
      return 0.0;
    }
    const scene::Section& section = scene_.sectionOf(scene_.mats[at(lia.b)]);
    const double step = StepUnits(scene_, rates_, divisorOf(section, rates_)).step;
    // By rows no eigenvalue of the string is above twice what is attached to one of its masses.
    const double left = std::max(0.0, 4.0 - 2.0 * step * step * load);
    const double stiffness = std::min(kMaxShare, kSafe * left) / (inverse * step * step);
    lia.stiffness = (stiffness / scene_.valueOf(mass)) * mass;
    return stiffness > 0.0 ? 0.5 * pull / stiffness : 0.0;
  }

  scene::Scene& scene_;
  const Rates& rates_;
  std::vector<double> load_;  // sum of |K| on each module
  std::vector<double> pull_;  // of springs that are no parts of bends
};

}  // namespace

void settleStops(scene::Scene& scene, const Rates& rates, std::vector<std::string>& notes) {
  if (scene.tunings.empty()) {
    return;
  }
  StopSettler(scene, rates).run(notes);
  scene.tunings.clear();
}

}  // namespace ergotic::physics
