// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/physics/certify.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>
#include <unordered_map>

#include "network_bound.hpp"
#include "step_units.hpp"

namespace ergotic::physics {
namespace {

using scene::LiaType;
using scene::MatType;

constexpr double kSilentContact = 0.05;   // kappa of a closed contact that cannot be noticed
constexpr double kWarnedContact = 0.25;   // gains a few per cent at worst
constexpr double kSmoothBowSlope = 1.04;  // 0.63 exp(0.5)
constexpr int kIterations = 20;           // of Collatz-Wielandt
constexpr double kPi = 3.14159265358979323846;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

std::string describe(double value) {
  std::ostringstream text;
  text.precision(4);
  text << value;
  return text.str();
}

/// Rounded up: a rate that is still enough.
std::string wholeHz(double hz) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(0) << std::ceil(hz);
  return text.str();
}

/// The end of a parameter's range at which |value| is largest (or smallest, for masses).
double extreme(const scene::Scene& scene, const scene::Value& v, bool largest) {
  if (v.parameter < 0) {
    return v.audio < 0 ? v.factor : 0.0;
  }
  const scene::Parameter& p = scene.parameters[at(v.parameter)];
  const double a = v.factor * p.minimum;
  const double b = v.factor * p.maximum;
  return (std::abs(a) > std::abs(b)) == largest ? a : b;
}

/// The smallest value a parameter's range allows: negative ones void the bounds.
double lowest(const scene::Scene& scene, const scene::Value& v) {
  if (v.parameter < 0) {
    return v.factor;
  }
  const scene::Parameter& p = scene.parameters[at(v.parameter)];
  return std::min(v.factor * p.minimum, v.factor * p.maximum);
}

double steepest(const std::vector<std::pair<double, double>>& table) {
  double slope = 0.0;
  for (std::size_t i = 1; i < table.size(); ++i) {
    slope = std::max(slope, std::abs((table[i].second - table[i - 1].second) /
                                     (table[i].first - table[i - 1].first)));
  }
  return slope;
}

/// Largest slopes of a link's force over elongation and velocity.
struct Slopes {
  double stiffness = 0.0;
  double damping = 0.0;
};

Slopes slopesOf(const scene::Scene& scene, const scene::Lia& lia) {
  const double k = std::abs(extreme(scene, lia.stiffness, true));
  const double z = std::abs(extreme(scene, lia.damping, true));
  const double width = std::abs(extreme(scene, lia.width, false));
  switch (lia.type) {
    case LiaType::kClippedCubic:
    case LiaType::kCubicContact: {
      const double q = std::abs(extreme(scene, lia.nonlinearity, true));
      const double limit = std::abs(extreme(scene, lia.stiffness_limit, true));
      const double tip = lia.tipping_point;
      return {std::max(k + 3.0 * q * tip * tip, limit),
              z + std::abs(extreme(scene, lia.limit_damping, true))};
    }
    case LiaType::kPluck:
      return {lia.table.empty() ? k : steepest(lia.table.points), z};
    case LiaType::kBow:
      return {0.0, lia.table.empty() ? z : steepest(lia.table.points)};
    case LiaType::kSmoothBow:
      return {0.0, width > 0.0 ? kSmoothBowSlope * z : z};
    default:
      return {k, z};
  }
}

class Certifier {
 public:
  Certifier(const scene::Scene& scene, const Rates& rates) : scene_(scene), rates_(rates) {
    for (const scene::Lia& lia : scene.lias) {
      slopes_.push_back(slopesOf(scene, lia));
    }
  }

  Certificate run() {
    std::map<int, SectionCertificate> of_rate;
    for (int s = 0; s < static_cast<int>(scene_.sections.size()); ++s) {
      const auto [known, is_new] = of_rate.try_emplace(divisor(s));
      if (is_new) {
        known->second = certifyRate(s);
        judgeCoupling(s);
      }
      result_.sections.push_back(known->second);
      result_.sections.back().section = s;
    }
    for (const scene::AudioParameter& parameter : scene_.audio_parameters) {
      find(Verdict::kUnproven,
           where(parameter.place) + "warning: '" + parameter.name +
               "' follows an audio input, which has no range: nothing is proven of what it moves");
    }
    for (std::size_t l = 0; l < scene_.lias.size(); ++l) {
      judgeLink(scene_.lias[l], slopes_[l]);
    }
    return std::move(result_);
  }

 private:
  int divisor(int section) const { return divisorOf(scene_.sections[at(section)], rates_); }
  const scene::Mat& mat(int m) const { return scene_.mats[at(m)]; }
  int divisorOfMat(int m) const { return divisor(mat(m).section); }

  /// Mass of an end as the network sees it; 0: it does not move by forces.
  double massOf(int m) const {
    const MatType type = mat(m).type;
    const bool is_free = type == MatType::kMass || type == MatType::kCell;
    return is_free ? extreme(scene_, mat(m).mass, false) : 0.0;
  }

  std::string where(const scene::Place& place) const {
    return scene_.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column) +
           ": ";
  }

  void find(Verdict verdict, const std::string& text) {
    result_.verdict = std::max(result_.verdict, verdict);
    result_.findings.push_back(text);
  }

  /// Nodes of the network being built, by module.
  using Nodes = std::unordered_map<int, int>;

  int nodeOf(NetworkBound& network, Nodes& nodes, int m) const {
    const double mass = massOf(m);
    if (mass <= 0.0) {
      return NetworkBound::kFixed;
    }
    const auto [known, is_new] = nodes.try_emplace(m, 0);
    if (is_new) {
      known->second = network.addNode(mass, m);
    }
    return known->second;
  }

  void addLink(NetworkBound& network, int a, int b, int l) const {
    network.addLink(a, b, slopes_[at(l)].stiffness, slopes_[at(l)].damping, l);
  }

  void addCells(NetworkBound& network, Nodes& nodes, int d) const {
    for (int m = 0; m < static_cast<int>(scene_.mats.size()); ++m) {
      if (divisorOfMat(m) == d && mat(m).type == MatType::kCell) {
        network.addLink(nodeOf(network, nodes, m), NetworkBound::kFixed,
                        std::abs(extreme(scene_, mat(m).stiffness, true)),
                        std::abs(extreme(scene_, mat(m).damping, true)), -1);
      }
    }
  }

  /// All sections of one rate are one network; slower ends are held, so fixed.
  NetworkBound networkOf(int d) const {
    NetworkBound network(StepUnits(scene_, rates_, d).step);
    Nodes nodes;
    addCells(network, nodes, d);
    for (int l = 0; l < static_cast<int>(scene_.lias.size()); ++l) {
      const scene::Lia& lia = scene_.lias[at(l)];
      const int da = divisorOfMat(lia.a);
      const int db = divisorOfMat(lia.b);
      if (std::min(da, db) == d) {
        addLink(network, da == d ? nodeOf(network, nodes, lia.a) : NetworkBound::kFixed,
                db == d ? nodeOf(network, nodes, lia.b) : NetworkBound::kFixed, l);
      }
    }
    return network;
  }

  SectionCertificate certifyRate(int s) {
    SectionCertificate result;
    result.section = s;
    result.rate_hz = rates_.audio_hz / divisor(s);
    const NetworkBound network = networkOf(divisor(s));
    result.link_bound = network.linkBound();
    result.lambda = result.link_bound;
    if (!(result.lambda < NetworkBound::kLimit)) {
      result.lambda = std::min(result.lambda, network.collatzWielandtBound(kIterations));
    }
    result.worst_lia = network.worstLink();
    result.worst_mat = network.worstOwner();
    result.stable_rate_hz = 1.0 / (network.stableStep() * scene_.time_unit_s);
    if (!(result.lambda < NetworkBound::kLimit)) {
      refuse(result);
    }
    return result;
  }

  void refuse(const SectionCertificate& section) {
    const bool is_link = section.worst_lia >= 0;
    const scene::Place place = is_link ? scene_.lias[at(section.worst_lia)].place
                                       : mat(std::max(section.worst_mat, 0)).place;
    const std::string name = is_link ? "link '" + scene_.lias[at(section.worst_lia)].name + "'"
                                     : "module '" + mat(std::max(section.worst_mat, 0)).name + "'";
    find(Verdict::kUnstable,
         where(place) + "error: section '" + scene_.sections[at(section.section)].name + "' at " +
             wholeHz(section.rate_hz) + " Hz: " + name + " is too stiff or too damped, bound " +
             describe(section.lambda) + ", allowed below 4. Soften it, make its masses heavier, " +
             "or run the section at " + wholeHz(section.stable_rate_hz) + " Hz or more");
  }

  /// Slow masses that fast ones pull on: the low-rate network with the couplings and the fast
  /// masses they touch must be stable at the low rate; that is enough while the fast section has
  /// no modes above half the low rate.
  void judgeCoupling(int s) {
    const int d = divisor(s);
    NetworkBound network(StepUnits(scene_, rates_, d).step);
    Nodes nodes;
    addCells(network, nodes, d);
    int fast_divisor = 0;
    for (int l = 0; l < static_cast<int>(scene_.lias.size()); ++l) {
      const scene::Lia& lia = scene_.lias[at(l)];
      const int da = divisorOfMat(lia.a);
      const int db = divisorOfMat(lia.b);
      const int slow = da > db ? lia.a : lia.b;
      const int fast = da > db ? lia.b : lia.a;
      const bool is_coupling = da != db && std::max(da, db) == d && massOf(slow) > 0.0;
      if (is_coupling && massOf(fast) > 0.0) {
        fast_divisor = std::min(da, db);
      }
      if (is_coupling || (da == d && db == d)) {
        addLink(network, nodeOf(network, nodes, lia.a), nodeOf(network, nodes, lia.b), l);
      }
    }
    if (fast_divisor == 0) {
      return;
    }
    const double bound = std::min(network.linkBound(), network.collatzWielandtBound(kIterations));
    const std::string name = scene_.sections[at(s)].name;
    if (!(bound < NetworkBound::kLimit)) {
      find(Verdict::kUnproven,
           where(scene_.sections[at(s)].place) + "warning: section '" + name +
               "' is coupled to a faster one too stiffly for its rate, bound " + describe(bound) +
               ", proven below 4. Make its masses heavier or raise the gestural rate");
    } else if (highestModeHz(fast_divisor) > 0.5 * rates_.audio_hz / d) {
      find(Verdict::kUnproven,
           where(scene_.sections[at(s)].place) + "warning: masses of section '" + name +
               "' are coupled to a faster section whose modes reach above half the slower rate: "
               "stable in practice with losses, "
               "but not proven. Put a chaplet between, or move the masses to the faster section");
    }
  }

  double highestModeHz(int d) const {
    const double lambda = std::min(networkOf(d).linkBound(), NetworkBound::kLimit);
    return std::asin(std::sqrt(lambda) / 2.0) / kPi * rates_.audio_hz / d;
  }

  bool hasNegative(const scene::Lia& lia) const {
    return lowest(scene_, lia.stiffness) < 0.0 || lowest(scene_, lia.damping) < 0.0;
  }

  void judgeLink(const scene::Lia& lia, const Slopes& slopes) {
    if (hasNegative(lia)) {
      find(Verdict::kUnproven,
           where(lia.place) + "warning: link '" + lia.name +
               "' has a negative stiffness or damping: it gives energy, no bound holds");
    }
    switch (lia.type) {
      case LiaType::kSpringDamper:
        return;
      case LiaType::kPluck:
      case LiaType::kBow:
      case LiaType::kSmoothBow:
        result_.verdict = std::max(result_.verdict, Verdict::kBounded);
        return;
      case LiaType::kQuadratic:
      case LiaType::kCubic:
        if (extreme(scene_, lia.nonlinearity, true) != 0.0) {
          find(Verdict::kUnproven,
               where(lia.place) + "warning: the slope of link '" + lia.name +
                   "' grows with its amplitude: stable only while it moves little");
        }
        return;
      default:
        judgeSwitching(lia, slopes);
    }
  }

  /// A stiffness that switches pumps energy: by little if it is soft for the step.
  void judgeSwitching(const scene::Lia& lia, const Slopes& slopes) {
    const StepUnits units(scene_, rates_, std::min(divisorOfMat(lia.a), divisorOfMat(lia.b)));
    double kappa = 0.0;
    for (const int end : {lia.a, lia.b}) {
      const bool is_free = massOf(end) > 0.0;
      kappa += is_free ? slopes.stiffness * units.inverseMass(massOf(end)) : 0.0;
    }
    if (kappa <= kSilentContact) {
      return;
    }
    const std::string text = where(lia.place) + "warning: link '" + lia.name +
                             "' switches its stiffness, h^2 K (1/Ma + 1/Mb) = " + describe(kappa);
    if (kappa <= kWarnedContact) {
      find(Verdict::kPassive, text + " (silent below " + describe(kSilentContact) +
                                  "): hard hits may come back a few per cent faster");
    } else {
      find(Verdict::kUnproven,
           text + ", allowed up to " + describe(kWarnedContact) +
               ": it may feed energy in. Soften it, make its masses heavier, or raise the rate");
    }
  }

  const scene::Scene& scene_;
  Rates rates_;
  std::vector<Slopes> slopes_;
  Certificate result_;
};

}  // namespace

const char* toString(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPassive:
      return "passive";
    case Verdict::kBounded:
      return "bounded";
    case Verdict::kUnproven:
      return "unproven";
    case Verdict::kUnstable:
      return "unstable";
  }
  return "";
}

double Certificate::margin() const {
  double lambda = 0.0;
  for (const SectionCertificate& section : sections) {
    lambda = std::max(lambda, section.lambda);
  }
  return 1.0 - lambda / NetworkBound::kLimit;
}

Certificate certify(const scene::Scene& scene, const Rates& rates) {
  return Certifier(scene, rates).run();
}

}  // namespace ergotic::physics
