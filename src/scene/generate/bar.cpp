// SPDX-License-Identifier: BSD-3-Clause
#include "scene/generate/bar.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Core>

#include "algebra/decompositions.hpp"
#include "at.hpp"
#include "scene/generate/bend.hpp"
#include "scene/generate/generated.hpp"

namespace ergotic::scene {
namespace {

constexpr double kThinnest = 0.1;

int groundsBeyond(BarEnd end) {
  return static_cast<int>(end);
}

/// Ways to move that bend nothing.
int rigidMotions(const std::array<BarEnd, 2>& ends) {
  return std::max(0, 2 - groundsBeyond(ends[0]) - groundsBeyond(ends[1]));
}

double thinnest(const BarProfile& profile, int masses) {
  double least = 1.0;
  for (int i = 0; i < masses; ++i) {
    least = std::min(least, profile.at(i, masses));
  }
  return least;
}

/// log of the ratios of partials 2, 3 ... of a free bar to the first.
Eigen::VectorXd logRatios(int masses, const BarProfile& profile, Eigen::Index count) {
  Eigen::MatrixXd bends = Eigen::MatrixXd::Zero(masses - 2, masses);
  Eigen::VectorXd roots(masses);
  for (int i = 0; i < masses; ++i) {
    roots(i) = std::sqrt(profile.at(i, masses));
  }
  for (int i = 1; i < masses - 1; ++i) {
    const double stiffness = std::pow(profile.at(i, masses), 1.5);
    const double weights[] = {stiffness, -2.0 * stiffness, stiffness};
    for (int k = -1; k <= 1; ++k) {
      bends(i - 1, i + k) = weights[k + 1] / roots(i + k);
    }
  }
  const Eigen::VectorXd values = algebra::symmetricEigenvalues(bends.transpose() * bends);
  return 0.5 * (values.segment(3, count).array() / values(2)).log();
}

Mat barMat(
    const SceneBuilder& builder, const BarSpec& spec, const Name& stem, int index, int mats) {
  const double u = static_cast<double>(index) / (mats - 1);
  return generatedMat(builder, spec.section, stem.numbered(index),
                      (1.0 - u) * spec.from + u * spec.to, spec.place);
}

void addBarMats(SceneBuilder& builder, const BarSpec& spec, int mats) {
  const Name stem(spec.name + ".");
  const int before = groundsBeyond(spec.ends[0]);
  for (int index = 0; index < mats; ++index) {
    Mat mat = barMat(builder, spec, stem, index, mats);
    const int mass = index - before;
    const bool moves = mass >= 0 && mass < spec.masses;
    mat.type = moves ? massTypeOf(spec.wish) : MatType::kGround;
    mat.matched = mat.type == MatType::kCell;
    mat.mass.factor = moves ? spec.mass / spec.masses : 1.0;
    builder.add(std::move(mat));
  }
}

void addBarBends(SceneBuilder& builder, const BarSpec& spec, int first, int mats) {
  const Name stem(spec.name + ".bend.");
  for (int i = 1; i < mats - 1; ++i) {
    Bend bend;
    bend.name = stem.numbered(i - 1);
    bend.ends = {{first + i - 1, 1.0}, {first + i, -2.0}, {first + i + 1, 1.0}};
    bend.stiffness.factor = spec.mass;
    bend.place = spec.place;
    addBend(builder, std::move(bend));
  }
}

/// Adds the dampers, from each module to the next.
void addBarDampers(SceneBuilder& builder, const BarSpec& spec, int first, int mats) {
  const Name stem = linkStem(spec.name);
  int next = 0;
  for (int i = 0; i + 1 < mats; ++i) {
    const Mat& a = builder.scene().mats[at(first + i)];
    const Mat& b = builder.scene().mats[at(first + i + 1)];
    if (a.type == MatType::kGround && b.type == MatType::kGround) {
      continue;
    }
    Lia lia = generatedLink(stem, next++, first + i, first + i + 1, spec.place);
    lia.damping.factor = spec.mass / spec.masses;
    builder.add(std::move(lia));
  }
}

}  // namespace

double BarProfile::at(int index, int masses) const {
  const double u = std::clamp((2.0 * index + 1.0) / masses - 1.0, -1.0, 1.0);
  return 1.0 - 0.5 * a * (1.0 + std::cos(M_PI * u)) - 0.5 * b * (1.0 - std::cos(2.0 * M_PI * u));
}

BarProfile tunedProfile(int masses, const std::vector<double>& ratios) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  constexpr double kStep = 1e-4;
  constexpr double kCloseEnough = 3e-7;  // 0.0005 cents; eigenvalues of 200 masses hold as much
  constexpr int kIterations = 100;
  const auto count = static_cast<Eigen::Index>(ratios.size());
  const Eigen::VectorXd wanted =
      Eigen::Map<const Eigen::VectorXd>(ratios.data(), count).array().log();
  Eigen::Vector2d x(0.0, 0.0);
  const auto error = [&](const Eigen::Vector2d& at) -> Eigen::VectorXd {
    return logRatios(masses, {at(0), at(1)}, count) - wanted;
  };
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::VectorXd now = error(x);
    if (now.cwiseAbs().maxCoeff() < kCloseEnough) {
      return {x(0), x(1)};
    }
    Eigen::MatrixXd slopes(count, count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(k);
      slopes.col(k) = (error(x + step) - error(x - step)) / (2.0 * kStep);
    }
    Eigen::Vector2d step = Eigen::Vector2d::Zero();
    step.head(count) = -algebra::solve(slopes, now);
    double share = std::min(1.0, 0.2 / step.norm());
    const auto fits = [&](double part) {
      const Eigen::Vector2d there = x + part * step;
      return thinnest({there(0), there(1)}, masses) >= kThinnest;
    };
    while (share > 1e-6 && !fits(share)) {
      share *= 0.5;
    }
    if (!(share > 1e-6)) {
      break;
    }
    x += share * step;
  }
  return {kNone, kNone};
}

bool shapeBar(Scene& scene, const Tuning& body, double pitch_hz, double step) {
  const int masses = body.mats;
  std::vector<double> ratios;
  for (const double ratio : body.ratios) {
    const double angle = M_PI * pitch_hz * step;
    ratios.push_back(step > 0.0 ? std::sin(ratio * angle) / std::sin(angle) : ratio);
  }
  const BarProfile profile = tunedProfile(masses, ratios);
  if (std::isnan(profile.a)) {
    return false;
  }
  double whole = 0.0;
  double thickness = 0.0;
  for (int i = 0; i < masses; ++i) {
    whole += scene.mats[at(body.first_mat + i)].mass.factor;
    thickness += profile.at(i, masses);
  }
  for (int i = 0; i < masses; ++i) {
    scene.mats[at(body.first_mat + i)].mass.factor = whole / thickness * profile.at(i, masses);
  }
  for (int l = body.first_lia; l < body.first_lia + body.lias; ++l) {
    Lia& lia = scene.lias[at(l)];
    const int left = std::min(lia.a, lia.b) - body.first_mat;
    lia.damping.factor = lia.bend < 0 ? whole / masses * profile.at(left, masses) : 0.0;
  }
  for (int b = body.first_bend; b < body.first_bend + body.bends; ++b) {
    Bend& bend = scene.bends[at(b)];
    const double stiffness = whole * std::pow(profile.at(b - body.first_bend + 1, masses), 3.0);
    for (int k = 0; k < 3; ++k) {
      Lia& spring = scene.lias[at(bend.first_lia + k)];
      spring.stiffness.factor *= stiffness / bend.stiffness.factor;
    }
    bend.stiffness.factor = stiffness;
  }
  return true;
}

void addBar(SceneBuilder& builder, const BarSpec& spec) {
  const int mats = spec.masses + groundsBeyond(spec.ends[0]) + groundsBeyond(spec.ends[1]);
  builder.reserve(at(mats), 4 * at(mats), spec.place);
  Tuning body = beginBody(builder, spec.name, spec.place);
  const int first = body.first_mat;
  addBarMats(builder, spec, mats);
  addBarBends(builder, spec, first, mats);
  if (spec.wish.t60.size() > 1) {
    addBarDampers(builder, spec, first, mats);
  }
  builder.add(Grid{spec.name, first, mats, 1, spec.place});
  body.rigid = rigidMotions(spec.ends);
  body.ratios = spec.ratios;
  endBody(builder, body);
  if (!spec.ratios.empty() && !shapeBar(builder.scene(), body, spec.wish.pitch_hz, 0.0)) {
    builder.fail(spec.place, "bar " + quoted(spec.name) +
                                 ": none was found that has its 'ratios' and is nowhere thinner "
                                 "than a tenth, allowed are such as [4, 10], [3, 6], [3.9]");
  }
  finishBody(builder, std::move(body), spec.wish);
}

}  // namespace ergotic::scene
