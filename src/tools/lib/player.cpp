// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/player.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/tgr/replay_driver.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "replay/offline_station.hpp"
#include "scene/limits.hpp"
#include "tools/lib/score.hpp"

namespace ergotic::tools {
namespace {

class FreePlayer final : public Player {
 public:
  FreePlayer(std::unique_ptr<station::Performer> performer, SoundInputs inputs)
      : performer_(std::move(performer)), inputs_(std::move(inputs)) {}

  const physics::Rates& rates() const override { return performer_->instrument->rates(); }
  int outputChannels() const override { return performer_->instrument->outputChannels(); }
  const physics::Instrument& instrument() const override { return *performer_->instrument; }

  bool next(double* frames) override {
    const double time_s = static_cast<double>(frame_) / rates().audio_hz;
    performer_->rig->toModel(at_rest_.data(), time_s, performer_->positions.data());
    inputs_.read(frame_, rates().ratio, performer_->inputs.data());
    performer_->instrument->tick({performer_->positions.data(), performer_->forces.data(),
                                  performer_->inputs.data(), frames});
    frame_ += rates().ratio;
    return true;
  }

 private:
  std::unique_ptr<station::Performer> performer_;
  SoundInputs inputs_;
  std::array<double, tgr::kMaxSlices> at_rest_{};  // nobody holds them
  std::int64_t frame_ = 0;
};

/// Passes recorded positions on and remembers that they came to their end.
class EndingSource final : public tgr::GestureSource {
 public:
  EndingSource(std::unique_ptr<tgr::GestureSource> source, bool& ended)
      : source_(std::move(source)), ended_(ended) {}
  int slices() const noexcept override { return source_->slices(); }
  bool next(double* positions) noexcept override {
    ended_ = !source_->next(positions);
    return !ended_;
  }

 private:
  std::unique_ptr<tgr::GestureSource> source_;
  bool& ended_;
};

/// Source of the input sound; without any file there is none.
replay::SoundSource sourceOf(SoundInputs inputs) {
  replay::SoundSource source;
  source.channels = inputs.channels();
  if (!inputs.areSilent()) {
    source.read = [sounds = std::move(inputs)](std::int64_t first, int nframes, float* to) {
      sounds.read(first, nframes, to);
    };
  }
  return source;
}

/// The usual virtual device, with as many slices as the scene needs.
tgr::VirtualDriverConfig deviceFor(const std::string& csv, std::uint64_t slices_in_use) {
  tgr::VirtualDriverConfig config;
  for (int slice = 0; slice < tgr::kMaxSlices; ++slice) {
    if ((slices_in_use >> static_cast<unsigned>(slice) & 1U) != 0) {
      config.slices = std::max(config.slices, slice + 1);
    }
  }
  config.gesture_file = csv;
  return config;
}

class HandPlayer final : public Player {
 public:
  /// \param name  of what the score was made of, for messages
  HandPlayer(std::unique_ptr<station::Performer> performer,
             SoundInputs inputs,
             const std::string& csv,
             Score score,
             std::string name,
             double usual_s)
      : usual_s_(usual_s),
        score_name_(std::move(name)),
        score_warnings_(score.warnings),
        score_end_s_(score.end_s),
        score_(std::move(score), performer->parameters),
        outputs_(std::max(performer->instrument->outputChannels(), 1)),
        instrument_(*performer->instrument),
        slices_in_use_(performer->rig->slicesInUse()),
        device_(deviceFor(csv, slices_in_use_)),
        driver_(makeDriver(device_, ended_)),
        station_(
            std::move(performer), std::move(driver_), outputs_, 0, sourceOf(std::move(inputs))) {
    station::Command engage;
    engage.type = station::Command::Type::kEngage;
    station_.submit(engage);
  }

  const physics::Rates& rates() const override { return station_.rates(); }
  int outputChannels() const override { return outputs_; }
  const physics::Instrument& instrument() const override { return instrument_; }

  bool next(double* frames) override {
    if (!ended_) {
      score_.bring(tick_++, instrument_, station_);
      station_.cycle(frames, [this](const station::Event& event) { hear(event); });
    }
    return !ended_;
  }

  std::string trouble() const override { return trouble_; }

  std::vector<std::string> gestureWarnings(double seconds, double late_s) const override {
    std::vector<std::string> warnings = score_warnings_;
    if (score_end_s_ > seconds + late_s) {
      warnings.push_back(score_name_ + ": warning: it ends " +
                         scene::numberText(score_end_s_ - seconds) +
                         " s after the render does, at " + scene::numberText(score_end_s_) + " s");
    }
    if (!device_.gesture_file.empty()) {
      const auto others = tgr::gestureWarnings(device_, slices_in_use_, seconds, late_s);
      warnings.insert(warnings.end(), others.begin(), others.end());
    }
    return warnings;
  }

  double usualSeconds() const override { return usual_s_; }

 private:
  void hear(const station::Event& event) {
    if (replay::isBlowUp(event)) {
      throw Exception("the sound or a force is not finite from frame " +
                      std::to_string(event.frame) + " on: the model blows up; nothing is kept");
    }
    if (event.type == station::Event::Type::kFault) {
      const double time_s = static_cast<double>(event.frame) / rates().audio_hz;
      trouble_ = "warning: no force from " + std::to_string(time_s) +
                 " s on: " + tgr::toString(static_cast<tgr::FaultReason>(event.index));
    }
  }

  static std::unique_ptr<tgr::Driver> makeDriver(const tgr::VirtualDriverConfig& device,
                                                 bool& ended) {
    if (!device.gesture_file.empty() &&
        tgr::gestureKindOf(device.gesture_file) == tgr::GestureKind::kPositions) {
      return tgr::makeReplayDriver(
          std::make_unique<EndingSource>(tgr::readPositionsCsv(device.gesture_file), ended));
    }
    return tgr::makeVirtualDriver(device);
  }

  bool ended_ = false;
  std::string trouble_;
  std::int64_t tick_ = 0;  // that runs next
  double usual_s_;
  std::string score_name_;
  std::vector<std::string> score_warnings_;
  double score_end_s_;
  ScoreReader score_;
  int outputs_;
  const physics::Instrument& instrument_;  // the station's: nobody swaps it
  std::uint64_t slices_in_use_;            // bit i: a port follows slice i
  tgr::VirtualDriverConfig device_;
  std::unique_ptr<tgr::Driver> driver_;  // on its way into the station
  replay::OfflineStation station_;
};

class RecordedPlayer final : public Player {
 public:
  explicit RecordedPlayer(std::unique_ptr<replay::Replay> recorded)
      : recorded_(std::move(recorded)) {}

  const physics::Rates& rates() const override { return recorded_->rates(); }
  int outputChannels() const override { return recorded_->outputChannels(); }
  const physics::Instrument& instrument() const override { return recorded_->instrument(); }
  bool next(double* frames) override { return recorded_->next(frames); }
  std::vector<std::string> flaws() const override { return recorded_->flaws(); }
  std::int64_t ticksLeft() const override { return recorded_->ticksLeft(); }

 private:
  std::unique_ptr<replay::Replay> recorded_;
};

}  // namespace

std::unique_ptr<Player> makeFreePlayer(std::unique_ptr<station::Performer> performer,
                                       SoundInputs inputs) {
  return std::make_unique<FreePlayer>(std::move(performer), std::move(inputs));
}

std::unique_ptr<Player> makeHandPlayer(std::unique_ptr<station::Performer> performer,
                                       SoundInputs inputs,
                                       const std::string& csv) {
  Score score = scoreOfGesture(csv, performer->instrument->scene());
  return std::make_unique<HandPlayer>(std::move(performer), std::move(inputs), csv,
                                      std::move(score), "", Player::kUsualSeconds);
}

std::unique_ptr<Player> makeSongPlayer(std::unique_ptr<station::Performer> performer,
                                       SoundInputs inputs,
                                       const tgr::EndEffectors& end_effectors,
                                       const Song& song,
                                       const std::string& map) {
  constexpr double kRingsOnS = 3.0;
  const scene::Scene& scene = performer->instrument->scene();
  const int slices = deviceFor("", performer->rig->slicesInUse()).slices;
  Score score = scoreOf(song, songMapFor(scene, map), scene, end_effectors, slices);
  const double usual_s = score.end_s + kRingsOnS;
  return std::make_unique<HandPlayer>(std::move(performer), std::move(inputs), "", std::move(score),
                                      song.file, usual_s);
}

std::unique_ptr<Player> makeRecordedPlayer(std::unique_ptr<replay::Replay> recorded) {
  return std::make_unique<RecordedPlayer>(std::move(recorded));
}

}  // namespace ergotic::tools
