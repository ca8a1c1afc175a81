// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/truth_play.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "constants.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/rt/thread.hpp"
#include "files/read_file.hpp"
#include "tools/lib/player.hpp"

namespace ergotic::tools {
namespace {

using scene::Truth;
constexpr int kEnergyTicks = 64;  // between looks at the energy accounts

/// Path of a truth's gesture, only below the scene's folder: a scene may come from a stranger.
std::string gestureOf(const scene::Scene& scene, const Truth& truth) {
  const std::size_t slash = scene.file.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : scene.file.substr(0, slash);
  std::string path = folder + "/" + truth.gesture;
  if (!files::isBelow(path, folder)) {
    throw Exception("gesture '" + path + "' is elsewhere, allowed: below the scene's folder");
  }
  files::requireFile(path);
  return path;
}

/// N, from the start on.
double forceAt(const Truth& truth, double time_s) {
  const double share = time_s / truth.time_s;
  if (share >= 1.0) {
    return 0.0;
  }
  return truth.force * 0.5 *
         (1.0 - std::cos((truth.play == Truth::Play::kTap ? 2.0 : 1.0) * kPi * share));
}

std::unique_ptr<station::Performer> truthPerformer(scene::Scene scene,
                                                   const physics::Rates& rates,
                                                   const physics::CompileOptions& options) {
  station::PerformerPolicy policy;
  policy.allow_unproven = true;
  return station::makePerformer(std::move(scene), rates, options, policy);
}

/// Plays with free slices; the force of a tap or pluck enters by an input of its own.
class FreePlay {
 public:
  FreePlay(scene::Scene scene,
           const Truth& truth,
           const physics::Rates& rates,
           const physics::CompileOptions& options)
      : truth_(truth), channel_(scene.inputChannels()) {
    for (const auto& [mat, weight] : truth.struck) {
      scene::Input input;
      input.name = "truth." + std::to_string(mat);
      input.mat = mat;
      input.channel = channel_;
      input.axis = truth.axis;
      input.gain.factor = weight;
      scene.inputs.push_back(std::move(input));
    }
    performer_ = truthPerformer(std::move(scene), rates, options);
    energies_ = performer_->instrument->makeEnergies();
  }

  void play(std::int64_t frames, PlayedTruth& played) {
    physics::Instrument& instrument = *performer_->instrument;
    const physics::Rates& rates = instrument.rates();
    const int channels = instrument.inputChannels();
    const int outputs = instrument.outputChannels();
    double most = 0.0;
    double residual = 0.0;
    std::int64_t tick = 0;
    for (std::int64_t frame = 0; frame < frames; frame += rates.ratio, ++tick) {
      const double time_s = static_cast<double>(frame) / rates.audio_hz;
      performer_->rig->toModel(at_rest_.data(), time_s, performer_->positions.data());
      for (int r = 0; r < rates.ratio && !truth_.struck.empty(); ++r) {
        performer_->inputs[static_cast<std::size_t>(r * channels + channel_)] =
            forceAt(truth_, time_s + static_cast<double>(r) / rates.audio_hz);
      }
      instrument.tick({performer_->positions.data(), performer_->forces.data(),
                       performer_->inputs.data(), performer_->outputs.data()});
      for (int r = 0; r < rates.ratio; ++r) {
        for (int c = 0; c < outputs; ++c) {
          played.sounds[static_cast<std::size_t>(c)].samples.push_back(
              performer_->outputs[static_cast<std::size_t>(r * outputs + c)]);
        }
      }
      if (instrument.options().metered && tick % kEnergyTicks == 0) {
        instrument.readEnergies(energies_);
        most = std::max(most, std::abs(energies_.stored));
        residual = std::max(residual, std::abs(energies_.residual));
      }
    }
    if (!instrument.isFinite()) {
      throw Exception("the model blows up");
    }
    played.imbalance = most > 0.0 ? residual / most : std::numeric_limits<double>::infinity();
  }

 private:
  const Truth& truth_;
  int channel_;
  std::unique_ptr<station::Performer> performer_;
  physics::Energies energies_;
  std::array<double, tgr::kMaxSlices> at_rest_{};
};

void playGesture(scene::Scene scene,
                 const Truth& truth,
                 std::int64_t frames,
                 const physics::Rates& rates,
                 const physics::CompileOptions& options,
                 PlayedTruth& played) {
  const std::string csv = gestureOf(scene, truth);
  SoundInputs inputs({}, scene, rates.audio_hz);
  const auto player =
      makeHandPlayer(truthPerformer(std::move(scene), rates, options), std::move(inputs), csv);
  const auto outputs = static_cast<std::size_t>(player->outputChannels());
  std::vector<double> tick(outputs * static_cast<std::size_t>(rates.ratio));
  for (std::int64_t frame = 0; frame < frames && player->next(tick.data()); frame += rates.ratio) {
    for (std::size_t i = 0; i < tick.size(); ++i) {
      if (i % outputs < played.sounds.size()) {
        played.sounds[i % outputs].samples.push_back(tick[i]);
      }
    }
  }
  if (const std::string trouble = player->trouble(); !trouble.empty()) {
    throw Exception(trouble);
  }
  physics::Energies energies = player->instrument().makeEnergies();
  player->instrument().readEnergies(energies);
  played.imbalance = std::abs(energies.residual) / std::abs(energies.stored);
}

}  // namespace

bool arePlayedAlike(const Truth& a, const Truth& b) {
  return a.play == b.play && a.struck == b.struck && a.axis == b.axis && a.force == b.force &&
         a.time_s == b.time_s && a.gesture == b.gesture;
}

PlayedTruth playTruth(scene::Scene scene,
                      const Truth& truth,
                      const std::vector<scene::Output>& outputs,
                      double seconds,
                      const physics::Rates& rates,
                      const physics::CompileOptions& options) {
  const rt::FlushDenormals fast;
  scene.outputs = outputs;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    scene.outputs[i].channel = static_cast<int>(i);
    scene.outputs[i].name = "truth." + std::to_string(i);
  }
  PlayedTruth played;
  played.begin_s = truth.struck.empty() ? 0.0 : truth.time_s;
  played.sounds.resize(outputs.size());
  for (Sound& sound : played.sounds) {
    sound.rate_hz = rates.audio_hz;
  }
  const auto frames =
      static_cast<std::int64_t>(std::ceil((played.begin_s + seconds) * rates.audio_hz)) +
      rates.ratio;
  if (truth.play == Truth::Play::kGesture) {
    playGesture(std::move(scene), truth, frames, rates, options, played);
  } else {
    FreePlay(std::move(scene), truth, rates, options).play(frames, played);
  }
  return played;
}

}  // namespace ergotic::tools
