// SPDX-License-Identifier: BSD-3-Clause
#include "physics/settling/coupled_strings.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "algebra/damped_pole.hpp"
#include "at.hpp"
#include "constants.hpp"
#include "ergotic/scene/coarse_string.hpp"
#include "physics/disjoint_sets.hpp"
#include "physics/laws/oscillator.hpp"
#include "physics/network/load_matrix.hpp"
#include "physics/network/network.hpp"
#include "physics/note.hpp"
#include "physics/step_units.hpp"

namespace ergotic::physics {
namespace {

using algebra::DampedPole;

constexpr double kInTuneCents = 1e-4;
constexpr double kSamePole = 1e-12;  // relative
constexpr int kMaxTrials = 20;       // of the stiffness
constexpr int kMaxSteps = 30;        // of inverse iteration
constexpr double kMinScale = 0.25;
constexpr double kMaxScale = 4.0;
// How alike the mode and that of a string between grounds are, along the string: less is another
// one, as of a string whose end is free (0.85 and 0.51).
constexpr double kMinLikeness = 0.93;

/// k u u^T and z u u^T on what a link joins, in units of a step.
struct Load {
  Shares ends;
  double stiffness = 0.0;  // h^2 K, kg
  double damping = 0.0;    // h Z, kg
  int owner = -1;          // index of the coupled string that it is a part of
};

double centsOf(double ratio) {
  return 1200.0 * std::log2(ratio);
}

CoupledString coupledOf(const scene::Tuning& body) {
  CoupledString string;
  string.name = body.name;
  string.first_mat = body.first_mat;
  string.mats = body.mats;
  string.first_lia = body.first_lia;
  string.lias = body.lias;
  string.first_bend = body.first_bend;
  string.bends = body.bends;
  string.partial = body.pitch_mode + 1;
  string.pitch_hz = body.pitch_hz;
  string.place = body.place;
  return string;
}

CoupledString coupledOf(const scene::Scene& scene, std::size_t index) {
  const scene::StringInfo& info = scene.strings[index];
  CoupledString string;
  string.name = info.name;
  string.first_mat = info.first;
  string.mats = info.count;
  string.first_lia = info.first_lia;
  string.lias = info.coarse ? scene::coarseLinks(info.count - 2) : info.count - 1;
  string.pitch_hz = info.frequency_hz;
  string.info = static_cast<int>(index);
  string.place = scene.mats[at(info.first)].place;
  return string;
}

/// The network of everything that always holds at one rate, with the tuned strings kept apart.
class Surroundings {
 public:
  Surroundings(const scene::Scene& scene,
               const std::vector<CoupledString>& strings,
               int divisor,
               const Rates& rates)
      : network_(scene),
        units_(scene, rates, divisor),
        counts_(scene.mats.size(), 0),
        row_of_(scene.mats.size(), -1) {
    for (std::size_t m = 0; m < scene.mats.size(); ++m) {
      const scene::Section& section = scene.sectionOf(scene.mats[m]);
      counts_[m] = network_.nodes[m].is_free && section.geometry == scene::Geometry::kScalar &&
                           divisorOf(section, rates) == divisor
                       ? 1
                       : 0;
    }
    addLinks(strings);
    addBends(strings);
  }

  /// Puts the string and all that it is joined to in order. \return how many modules
  int gather(const CoupledString& string, int owner) {
    owner_ = owner;
    DisjointSets joined(counts_.size());
    for (const Load& load : loads_) {
      if (isFelt(load)) {
        for (const Share& end : load.ends) {
          joined.join(end.node, load.ends.front().node);
        }
      }
    }
    // The string holds together by itself: its first mass stands for it.
    const int set = joined.setOf(string.first_mat + 1);
    modules_.clear();
    std::fill(row_of_.begin(), row_of_.end(), -1);
    for (std::size_t m = 0; m < counts_.size(); ++m) {
      if (counts_[m] != 0 && joined.setOf(static_cast<int>(m)) == set) {
        row_of_[m] = static_cast<int>(modules_.size());
        modules_.push_back(static_cast<int>(m));
      }
    }
    return static_cast<int>(modules_.size());
  }

  /// The mode of a string that is held at its ends.
  Eigen::VectorXcd shapeOf(const CoupledString& string) const {
    Eigen::VectorXcd shape = Eigen::VectorXcd::Zero(static_cast<Eigen::Index>(modules_.size()));
    for (int i = 1; i + 1 < string.mats; ++i) {
      const int module = string.first_mat + i;
      const double height = std::sin(string.partial * kPi * i / (string.mats - 1));
      shape[row_of_[at(module)]] = height * rootOfMass(module);
    }
    algebra::normalize(shape);
    return shape;
  }

  /// How much of a shape along the string is that of its mode between grounds, 0...1.
  double likeness(const CoupledString& string, const Eigen::VectorXcd& shape) const {
    const Eigen::VectorXcd wanted = shapeOf(string);
    double along = 0.0;
    for (int i = 1; i + 1 < string.mats; ++i) {
      along += std::norm(shape[row_of_[at(string.first_mat + i)]]);
    }
    return std::abs(wanted.dot(shape)) / (wanted.norm() * std::sqrt(along));
  }

  struct Equations {
    Eigen::SparseMatrix<double> both;  // losses and springs, for unit masses
    Eigen::SparseMatrix<double> pull;  // springs
  };
  /// \param scale  of the springs of the string
  Equations equations(double scale) const {
    const int size = static_cast<int>(modules_.size());
    LoadMatrix both(size);
    LoadMatrix pull(size);
    for (int row = 0; row < size; ++row) {
      const scene::Mat& mat = network_.scene.mats[at(modules_[at(row)])];
      const OscillatorCoefficients own = oscillatorOf(network_.scene, mat, units_);
      both.add(row, row, own.lose + own.pull);
      pull.add(row, row, own.pull);
    }
    for (const Load& load : loads_) {
      if (isFelt(load) && row_of_[at(load.ends.front().node)] >= 0) {
        const double stiffness = (load.owner == owner_ ? scale : 1.0) * load.stiffness;
        add(load, stiffness + load.damping, both);
        add(load, stiffness, pull);
      }
    }
    return {both.sum(), pull.sum()};
  }

 private:
  double rootOfMass(int module) const { return std::sqrt(network_.nodes[at(module)].mass.now); }

  bool isFelt(const Load& load) const { return load.owner < 0 || load.owner == owner_; }

  void add(const Load& load, double factor, LoadMatrix& to) const {
    for (const Share& a : load.ends) {
      for (const Share& b : load.ends) {
        to.add(row_of_[at(a.node)], row_of_[at(b.node)],
               factor * a.weight / rootOfMass(a.node) * b.weight / rootOfMass(b.node));
      }
    }
  }

  Shares counted(const Shares& shares, double sign) const {
    Shares result;
    for (const Share& share : shares) {
      if (counts_[at(share.node)] != 0) {
        result.push_back({share.node, sign * share.weight});
      }
    }
    return result;
  }

  void addLoad(Shares ends, double stiffness, double damping, int owner) {
    if (!ends.empty() && (stiffness != 0.0 || damping != 0.0)) {
      loads_.push_back(
          {std::move(ends), units_.step * units_.step * stiffness, units_.step * damping, owner});
    }
  }

  void addLinks(const std::vector<CoupledString>& strings) {
    const scene::Scene& scene = network_.scene;
    for (std::size_t l = 0; l < network_.links.size(); ++l) {
      const Network::Link& link = network_.links[l];
      const scene::Lia& lia = scene.lias[l];
      const bool is_linear = lia.type == scene::LiaType::kSpringDamper;
      if (lia.bend >= 0 || (!is_linear && link.at_rest == 0.0)) {
        continue;
      }
      Shares ends = counted(sharesNow(network_, link.a), 1.0);
      for (const Share& share : counted(sharesNow(network_, link.b), -1.0)) {
        ends.push_back(share);
      }
      const auto of = std::find_if(strings.begin(), strings.end(), [&](const CoupledString& s) {
        return static_cast<int>(l) >= s.first_lia && static_cast<int>(l) < s.first_lia + s.lias;
      });
      addLoad(std::move(ends), link.at_rest, is_linear ? scene.valueOf(lia.damping) : 0.0,
              of == strings.end() ? -1 : static_cast<int>(of - strings.begin()));
    }
  }

  void addBends(const std::vector<CoupledString>& strings) {
    const scene::Scene& scene = network_.scene;
    for (std::size_t b = 0; b < network_.bends.size(); ++b) {
      const auto of = std::find_if(strings.begin(), strings.end(), [&](const CoupledString& s) {
        return static_cast<int>(b) >= s.first_bend && static_cast<int>(b) < s.first_bend + s.bends;
      });
      addLoad(counted(network_.bends[b].ends, 1.0), scene.valueOf(scene.bends[b].stiffness),
              scene.valueOf(scene.bends[b].damping),
              of == strings.end() ? -1 : static_cast<int>(of - strings.begin()));
    }
  }

  Network network_;
  StepUnits units_;
  std::vector<unsigned char> counts_;  // [nodes] moves, and is stepped with the string
  std::vector<Load> loads_;
  int owner_ = -1;
  std::vector<int> modules_;
  std::vector<int> row_of_;  // [nodes] in the equations
};

/// The pole that Newton's iteration from a guess converges to; none if it does not.
std::optional<DampedPole> poleFrom(const Surroundings::Equations& equations, DampedPole guess) {
  for (int i = 0; i < kMaxSteps; ++i) {
    std::optional<DampedPole> next = algebra::refinedPole(equations.both, equations.pull, guess);
    if (!next || !std::isfinite(std::abs(next->w))) {
      return std::nullopt;
    }
    const double change = std::abs(next->w - guess.w);
    guess = std::move(*next);
    if (change <= kSamePole * std::abs(guess.w)) {
      return guess;
    }
  }
  return std::nullopt;
}

/// Tunes one string with its surroundings.
class CoupledTuning {
 public:
  CoupledTuning(Surroundings& surroundings, const CoupledString& string, int index, double rate_hz)
      : surroundings_(surroundings), string_(string), rate_hz_(rate_hz) {
    surroundings_.gather(string, index);
    // w = z - 1 of the pole; the first guess has the pitch and no damping.
    pole_.w = std::polar(1.0, 2.0 * kPi * string.pitch_hz / rate_hz) - 1.0;
    pole_.shape = surroundings_.shapeOf(string);
  }

  /// Finds the factor of its stiffness; nullopt if no mode can be brought to the pitch.
  std::optional<double> run() {
    double before = 0.0;  // ln of the scale
    double off_before = offBy(before);
    first_cents_ = off_before;
    double now = -2.0 * off_before * std::log(2.0) / 1200.0;
    for (int i = 0; i < kMaxTrials; ++i) {
      const double off = offBy(now);
      if (!std::isfinite(off) || now < std::log(kMinScale) || now > std::log(kMaxScale)) {
        return std::nullopt;
      }
      if (std::abs(off) < kInTuneCents) {
        const bool is_same = surroundings_.likeness(string_, pole_.shape) >= kMinLikeness;
        return is_same ? std::optional(std::exp(now)) : std::nullopt;
      }
      const double next = now - off * (now - before) / (off - off_before);
      before = now;
      off_before = off;
      now = next;
    }
    return std::nullopt;
  }

  /// How far off it was, cents.
  double firstCents() const { return first_cents_; }

 private:
  double offBy(double log_scale) {
    const auto pole = poleFrom(surroundings_.equations(std::exp(log_scale)), pole_);
    if (!pole) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    pole_ = *pole;
    const double hz = std::abs(std::arg(1.0 + pole_.w)) / (2.0 * kPi) * rate_hz_;
    return centsOf(hz / string_.pitch_hz);
  }

  Surroundings& surroundings_;
  const CoupledString& string_;
  double rate_hz_;
  DampedPole pole_;
  double first_cents_ = 0.0;
};

void stiffen(scene::Scene& scene, const CoupledString& string, double scale) {
  for (int l = string.first_lia; l < string.first_lia + string.lias; ++l) {
    scene.lias[at(l)].stiffness.factor *= scale;
  }
  for (int b = string.first_bend; b < string.first_bend + string.bends; ++b) {
    scene.bends[at(b)].stiffness.factor *= scale;
  }
  if (string.info >= 0) {
    scene.strings[at(string.info)].stiffness.factor *= scale;
  }
}

}  // namespace

std::vector<CoupledString> coupledStrings(const scene::Scene& scene) {
  std::vector<CoupledString> found;
  for (const scene::Tuning& body : scene.tunings) {
    if (body.keeps_pitch) {
      found.push_back(coupledOf(body));
    }
  }
  for (std::size_t s = 0; s < scene.strings.size(); ++s) {
    if (scene.strings[s].keeps_pitch && scene.strings[s].frequency_hz > 0.0) {
      found.push_back(coupledOf(scene, s));
    }
  }
  return found;
}

void tuneCoupledStrings(scene::Scene& scene,
                        const std::vector<CoupledString>& strings,
                        const Rates& rates,
                        std::vector<std::string>& notes) {
  // What one string is tuned by does not change the surroundings of another: each rate has one.
  std::map<int, Surroundings> surroundings;
  std::vector<std::pair<const CoupledString*, double>> scales;
  for (std::size_t i = 0; i < strings.size(); ++i) {
    const CoupledString& string = strings[i];
    const int divisor = divisorOf(scene.sectionOf(scene.mats[at(string.first_mat)]), rates);
    Surroundings& around =
        surroundings.try_emplace(divisor, scene, strings, divisor, rates).first->second;
    CoupledTuning tuning(around, string, static_cast<int>(i), rates.audio_hz / divisor);
    const std::optional<double> scale = tuning.run();
    const std::string who = "string '" + string.name + "' ";
    if (scale) {
      scales.emplace_back(&string, *scale);
      notes.push_back(noteAt(scene, string.place) + who +
                      "is tuned together with what it ends on, which would have changed its "
                      "pitch by " +
                      shortly(tuning.firstCents()) + " cents");
    } else {
      scene.warnings.push_back(scene::textOf(scene, string.place) + ": warning: " + who +
                               "cannot be tuned to " + shortly(string.pitch_hz) +
                               " Hz: the bridge or body at its end yields too much at that pitch. "
                               "Make it heavier, stiffer or less resonant there");
    }
  }
  for (const auto& [string, scale] : scales) {
    stiffen(scene, *string, scale);
  }
}

}  // namespace ergotic::physics
