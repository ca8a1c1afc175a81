// SPDX-License-Identifier: BSD-3-Clause
#include "advice/mode_targets.hpp"

#include <cmath>
#include <string>

#include "at.hpp"
#include "constants.hpp"

namespace ergotic::physics {
namespace {

using scene::Scene;

constexpr int kStiffPartials = 8;         // of a stiff string that are told
constexpr double kFurthest = 100.0;       // cents
constexpr double kMinSharedEnergy = 0.3;  // of the kinetic energy

/// A pitch and the modules that should have it.
struct Asked {
  AskedPitch pitch;
  int first_mat = 0;
  int mats = 0;
};

void addTuning(const scene::Tuning& body, std::vector<Asked>& all) {
  const auto add = [&](int partial, double hz) {
    all.push_back({{body.name, partial, hz}, body.first_mat, body.mats});
  };
  if (body.inharmonicity >= 0.0) {
    for (int j = 1; j <= kStiffPartials; ++j) {
      add(j, body.pitch_hz * j *
                 std::sqrt((1.0 + body.inharmonicity * j * j) / (1.0 + body.inharmonicity)));
    }
    return;
  }
  add(body.pitch_mode + 1, body.pitch_hz);
  for (std::size_t r = 0; r < body.ratios.size(); ++r) {
    add(static_cast<int>(r) + 2, body.pitch_hz * body.ratios[r]);
  }
}

/// A partial of a resonator or of a body by its modes.
void addCell(const Scene& scene, int m, std::vector<Asked>& all) {
  const scene::Mat& mat = scene.mats[at(m)];
  if (mat.type != scene::MatType::kCell || !mat.matched) {
    return;
  }
  const double mass = scene.valueOf(mat.mass);
  const double decay = 0.5 * scene.valueOf(mat.damping) / mass;
  const double square = scene.valueOf(mat.stiffness) / mass - decay * decay;
  if (square > 0.0) {
    all.push_back({{mat.name, 1, std::sqrt(square) / (2.0 * kPi * scene.time_unit_s)}, m, 1});
  }
}

std::vector<Asked> allAsked(const Scene& scene) {
  std::vector<Asked> all;
  for (const scene::Tuning& body : scene.tunings) {
    addTuning(body, all);
  }
  for (const scene::StringInfo& string : scene.strings) {
    if (string.frequency_hz > 0.0) {
      all.push_back({{string.name, 1, string.frequency_hz}, string.first, string.count});
    }
  }
  for (int m = 0; m < static_cast<int>(scene.mats.size()); ++m) {
    addCell(scene, m, all);
  }
  return all;
}

double shareIn(const Asked& asked, const PlacedMode& mode) {
  double share = 0.0;
  for (const auto& [mat, energy] : *mode.shares) {
    share += mat >= asked.first_mat && mat < asked.first_mat + asked.mats ? energy : 0.0;
  }
  return share;
}

}  // namespace

std::vector<AskedPitch> askedPitchesOf(const Scene& asked) {
  std::vector<AskedPitch> pitches;
  for (const Asked& one : allAsked(asked)) {
    pitches.push_back(one.pitch);
  }
  return pitches;
}

std::vector<std::vector<double>> sharesInBodies(const Scene& asked,
                                                const std::vector<PlacedMode>& modes) {
  std::vector<std::vector<double>> shares(modes.size());
  const std::vector<Asked> all = allAsked(asked);
  for (std::size_t i = 0; i < modes.size(); ++i) {
    for (const Asked& one : all) {
      shares[i].push_back(shareIn(one, modes[i]));
    }
  }
  return shares;
}

std::vector<PitchMatch> matchPitches(const Scene& scene,
                                     const Scene& asked,
                                     std::vector<AskedPitch>& pitches,
                                     const std::vector<PlacedMode>& modes) {
  std::vector<PitchMatch> matches(modes.size());
  const std::vector<Asked> all = allAsked(asked);
  for (std::size_t a = 0; a < all.size() && scene.mats.size() >= asked.mats.size(); ++a) {
    std::size_t best = modes.size();
    double nearest = kFurthest;
    for (std::size_t i = 0; i < modes.size(); ++i) {
      const double cents = 1200.0 * std::log2(modes[i].frequency_hz / all[a].pitch.hz);
      if (matches[i].asked < 0 && std::abs(cents) < std::abs(nearest) &&
          shareIn(all[a], modes[i]) >= kMinSharedEnergy) {
        best = i;
        nearest = cents;
      }
    }
    if (best < modes.size()) {
      matches[best] = {static_cast<int>(a), nearest};
      pitches[a].is_found = true;
    }
  }
  return matches;
}

}  // namespace ergotic::physics
