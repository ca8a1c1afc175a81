// SPDX-License-Identifier: BSD-3-Clause
#include "lab/lib/plain_network.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ergotic/exception.hpp"
#include "physics/step_units.hpp"

namespace ergotic::tools {
namespace {

using scene::Geometry;
using scene::LiaType;
using scene::MatType;
using scene::Scene;

[[noreturn]] void refuse(const std::string& what) {
  throw Exception("the plain implementation has no " + what +
                  ", only masses, grounds, and explicit springs and contacts of one geometry");
}

/// \throws Exception if the scene is more than the loops below can do
void requirePlain(const Scene& scene) {
  for (const scene::Section& section : scene.sections) {
    const scene::Section& first = scene.sections.front();
    if (section.geometry != first.geometry || !section.pose.isApprox(first.pose)) {
      refuse("sections that lie differently, as '" + section.name + "' does");
    }
    if (scene.valueOf(section.medium) != 0.0 || section.sleep_energy > 0.0) {
      refuse("medium or sleep, as '" + section.name + "' has");
    }
  }
  for (const scene::Mat& mat : scene.mats) {
    if (mat.type != MatType::kMass && mat.type != MatType::kGround) {
      refuse("module like '" + mat.name + "'");
    }
  }
  for (const scene::Lia& lia : scene.lias) {
    if ((lia.type != LiaType::kSpringDamper && lia.type != LiaType::kContact) ||
        lia.scheme != scene::Scheme::kExplicit) {
      refuse("link like '" + lia.name + "'");
    }
  }
  if (!scene.inputs.empty()) {
    refuse("input '" + scene.inputs.front().name + "'");
  }
}

template <class Real, int D>
struct Mass {
  Real x[D];  // absolute
  Real d[D];  // x[n] - x[n-1]
  Real f[D];
  Real inverse;  // h^2 / M
};

template <class Real>
struct Link {
  int a;
  int b;
  Real k;
  Real z;
};

template <class Real>
struct LinkWithLength : Link<Real> {
  Real length;  // at rest; of contacts the threshold
};

template <class Real, int D>
struct ConstantForce {
  std::size_t mass;
  Real f[D];
};

/// Masses of one section.
template <class Real, int D>
struct Part {
  int divisor = 1;
  std::size_t first = 0;
  std::size_t last = 0;
  std::vector<ConstantForce<Real, D>> constant;
};

/// Links between two sections, or inside one.
template <class Real>
struct Run {
  int section_a = 0;
  int section_b = 0;
  int divisor = 1;
  int divisor_a = 1;
  int divisor_b = 1;
  std::vector<Link<Real>> springs;  // scalar, without length
  std::vector<LinkWithLength<Real>> long_springs;
  std::vector<LinkWithLength<Real>> contacts;
};

/// How the ends of a link count: a slower one has moved only in some frames, and receives the mean.
template <class Real>
struct Ends {
  Real gate_a;
  Real gate_b;
  Real share_a;
  Real share_b;
};

template <class Real>
void stepLink(Mass<Real, 1>* masses, const Link<Real>& link) noexcept {
  Mass<Real, 1>& a = masses[link.a];
  Mass<Real, 1>& b = masses[link.b];
  const Real f = link.k * (a.x[0] - b.x[0]) + link.z * (a.d[0] - b.d[0]);
  a.f[0] -= f;
  b.f[0] += f;
}

template <class Real>
void stepScalar(Mass<Real, 1>* masses,
                const LinkWithLength<Real>& link,
                bool contact,
                const Ends<Real>& ends) noexcept {
  Mass<Real, 1>& a = masses[link.a];
  Mass<Real, 1>& b = masses[link.b];
  const Real e = a.x[0] - b.x[0] + (contact ? link.length : -link.length);
  if (contact && !(e > Real(0))) {
    return;
  }
  const Real f = link.k * e + link.z * (ends.gate_a * a.d[0] - ends.gate_b * b.d[0]);
  a.f[0] -= ends.share_a * f;
  b.f[0] += ends.share_b * f;
}

template <class Real, int D>
void stepEuclidean(Mass<Real, D>* masses,
                   const LinkWithLength<Real>& link,
                   bool contact,
                   const Ends<Real>& ends) noexcept {
  Mass<Real, D>& a = masses[link.a];
  Mass<Real, D>& b = masses[link.b];
  Real apart[D];
  Real square(0);
  Real along(0);
  for (int c = 0; c < D; ++c) {
    apart[c] = a.x[c] - b.x[c];
    square += apart[c] * apart[c];
    along += apart[c] * (ends.gate_a * a.d[c] - ends.gate_b * b.d[c]);
  }
  const Real distance = std::sqrt(square);
  const Real e = distance - link.length;
  if (distance == Real(0) || (contact && !(e < Real(0)))) {
    return;
  }
  const Real scale = (link.k * e + link.z * along / distance) / distance;
  for (int c = 0; c < D; ++c) {
    a.f[c] -= ends.share_a * scale * apart[c];
    b.f[c] += ends.share_b * scale * apart[c];
  }
}

template <class Real, int D, bool kEuclidean>
class PlainNetworkOf final : public PlainNetwork {
 public:
  PlainNetworkOf(const Scene& scene, const physics::Rates& rates) {
    for (std::size_t s = 0; s < scene.sections.size(); ++s) {
      addPart(scene, rates, static_cast<int>(s));
    }
    for (const scene::Lia& lia : scene.lias) {
      addLink(scene, rates, lia);
    }
    for (const scene::Mat& mat : scene.mats) {
      for (int c = 0; c < D; ++c) {
        rests_.push_back(mat.rest[c]);
      }
    }
  }

  void step(int frames) noexcept override {
    for (int i = 0; i < frames; ++i, ++frame_) {
      for (const Part<Real, D>& part : parts_) {
        if (frame_ % part.divisor == 0) {
          move(part);
        }
      }
      for (const Run<Real>& run : runs_) {
        if (frame_ % run.divisor == 0) {
          run.divisor_a == run.divisor_b ? stepLinks<false>(run) : stepLinks<true>(run);
        }
      }
    }
  }

  void readDisplacements(double* to) const noexcept override {
    for (std::size_t i = 0; i < mass_of_mat_.size(); ++i) {
      for (std::size_t c = 0; c < D; ++c) {
        to[i * D + c] = static_cast<double>(masses_[mass_of_mat_[i]].x[c]) - rests_[i * D + c];
      }
    }
  }

 private:
  void addPart(const Scene& scene, const physics::Rates& rates, int section) {
    const scene::Section& from = scene.sections[static_cast<std::size_t>(section)];
    Part<Real, D> part;
    part.divisor = physics::divisorOf(from, rates);
    const physics::StepUnits units(scene, rates, part.divisor);
    part.first = masses_.size();
    mass_of_mat_.resize(scene.mats.size());
    for (std::size_t i = 0; i < scene.mats.size(); ++i) {
      const scene::Mat& mat = scene.mats[i];
      if (mat.section != section) {
        continue;
      }
      mass_of_mat_[i] = masses_.size();
      masses_.push_back(massOf(scene, mat, units));
      const Eigen::Vector3d force = mat.push->force + scene.valueOf(mat.mass) * from.gravity;
      if (mat.type == MatType::kMass && !force.template head<D>().isZero(0.0)) {
        part.constant.push_back({mass_of_mat_[i], {}});
        for (int c = 0; c < D; ++c) {
          part.constant.back().f[c] = static_cast<Real>(force[c]);
        }
      }
    }
    part.last = masses_.size();
    parts_.push_back(std::move(part));
  }

  static Mass<Real, D> massOf(const Scene& scene,
                              const scene::Mat& mat,
                              const physics::StepUnits& units) {
    Mass<Real, D> mass{};
    const bool moves = mat.type == MatType::kMass;
    mass.inverse = moves ? static_cast<Real>(units.inverseMass(scene.valueOf(mat.mass))) : Real(0);
    for (int c = 0; c < D; ++c) {
      mass.x[c] = static_cast<Real>(mat.position[c]);
      mass.d[c] = moves ? static_cast<Real>(units.velocity(mat.push->velocity[c])) : Real(0);
    }
    return mass;
  }

  void addLink(const Scene& scene, const physics::Rates& rates, const scene::Lia& lia) {
    const auto a = static_cast<std::size_t>(lia.a);
    const auto b = static_cast<std::size_t>(lia.b);
    Run<Real>& run = runOf(scene.mats[a].section, scene.mats[b].section);
    const physics::StepUnits units(scene, rates, run.divisor);
    LinkWithLength<Real> link;
    link.a = static_cast<int>(mass_of_mat_[a]);
    link.b = static_cast<int>(mass_of_mat_[b]);
    link.k = static_cast<Real>(scene.valueOf(lia.stiffness));
    link.z = static_cast<Real>(units.damping(scene.valueOf(lia.damping)));
    if (lia.type == LiaType::kContact) {
      link.length = static_cast<Real>(scene.valueOf(lia.law->width));
      run.contacts.push_back(link);
    } else if (kEuclidean || lia.rest_length != 0.0 || run.divisor_a != run.divisor_b) {
      link.length = static_cast<Real>(lia.rest_length);
      run.long_springs.push_back(link);
    } else {
      run.springs.push_back(link);
    }
  }

  Run<Real>& runOf(int section_a, int section_b) {
    for (Run<Real>& run : runs_) {
      if (run.section_a == section_a && run.section_b == section_b) {
        return run;
      }
    }
    Run<Real> run;
    run.section_a = section_a;
    run.section_b = section_b;
    run.divisor_a = parts_[static_cast<std::size_t>(section_a)].divisor;
    run.divisor_b = parts_[static_cast<std::size_t>(section_b)].divisor;
    run.divisor = std::min(run.divisor_a, run.divisor_b);
    runs_.push_back(std::move(run));
    return runs_.back();
  }

  void move(const Part<Real, D>& part) noexcept {
    for (const ConstantForce<Real, D>& constant : part.constant) {
      for (int c = 0; c < D; ++c) {
        masses_[constant.mass].f[c] += constant.f[c];
      }
    }
    Mass<Real, D>* masses = masses_.data();
    for (std::size_t i = part.first; i < part.last; ++i) {
      Mass<Real, D>& mass = masses[i];
      for (int c = 0; c < D; ++c) {
        mass.d[c] += mass.inverse * mass.f[c];
        mass.x[c] += mass.d[c];
        mass.f[c] = Real(0);
      }
    }
  }

  Ends<Real> endsOf(const Run<Real>& run) const noexcept {
    const auto fresh = [this](int divisor) { return frame_ % divisor == 0 ? Real(1) : Real(0); };
    const auto share = [&run](int divisor) {
      return Real(1) / static_cast<Real>(divisor / run.divisor);
    };
    return {fresh(run.divisor_a), fresh(run.divisor_b), share(run.divisor_a), share(run.divisor_b)};
  }

  template <bool kTwoRates>
  void stepLinks(const Run<Real>& run) noexcept {
    const Ends<Real> ends = kTwoRates ? endsOf(run) : Ends<Real>{1, 1, 1, 1};
    Mass<Real, D>* masses = masses_.data();
    if constexpr (kEuclidean) {
      for (const LinkWithLength<Real>& link : run.long_springs) {
        stepEuclidean(masses, link, false, ends);
      }
      for (const LinkWithLength<Real>& link : run.contacts) {
        stepEuclidean(masses, link, true, ends);
      }
    } else {
      for (const Link<Real>& link : run.springs) {
        stepLink(masses, link);
      }
      for (const LinkWithLength<Real>& link : run.long_springs) {
        stepScalar(masses, link, false, ends);
      }
      for (const LinkWithLength<Real>& link : run.contacts) {
        stepScalar(masses, link, true, ends);
      }
    }
  }

  std::vector<Mass<Real, D>> masses_;  // section by section
  std::vector<std::size_t> mass_of_mat_;
  std::vector<double> rests_;
  std::vector<Part<Real, D>> parts_;
  std::vector<Run<Real>> runs_;
  long frame_ = 0;
};

template <class Real>
std::unique_ptr<PlainNetwork> make(const Scene& scene, const physics::Rates& rates) {
  switch (scene.sections.front().geometry) {
    case Geometry::kScalar:
      return std::make_unique<PlainNetworkOf<Real, 1, false>>(scene, rates);
    case Geometry::kLine:
      return std::make_unique<PlainNetworkOf<Real, 1, true>>(scene, rates);
    case Geometry::kPlane:
      return std::make_unique<PlainNetworkOf<Real, 2, true>>(scene, rates);
    case Geometry::kSpace:
      break;
  }
  return std::make_unique<PlainNetworkOf<Real, 3, true>>(scene, rates);
}

}  // namespace

std::unique_ptr<PlainNetwork> makePlainNetwork(const Scene& scene,
                                               const physics::Rates& rates,
                                               physics::Precision precision) {
  requirePlain(scene);
  return precision == physics::Precision::kFloat ? make<float>(scene, rates)
                                                 : make<double>(scene, rates);
}

}  // namespace ergotic::tools
