// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ergotic/bag/recording.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "ergotic/station/station.hpp"
#include "ergotic/tgr/virtual_driver.hpp"
#include "support/test.hpp"

namespace ergotic::test {

/// A performance on a station with a virtual device, recorded as the nodelet records it: what a
/// replay is measured against.
class LiveRun : private station::FramePort {
 public:
  explicit LiveRun(const std::string& scene_text,
                   const physics::CompileOptions& options = {},
                   const station::PerformerPolicy& policy = {})
      : scene_text_(scene_text), options_(options), policy_(policy) {
    station::StationConfig config;
    config.rates = kRates;
    config.output_channels = 1;
    config.input_channels = 1;
    auto performer = perform(scene_text);
    playing_ = performer->instrument.get();
    performer_ = submitted_ = performer.get();
    auto driver = tgr::makeVirtualDriver({});
    driver_ = driver.get();
    station_ = std::make_unique<station::Station>(config, std::move(driver), std::move(performer));
    station_->setFramePort(this);
    submit(station::Command::Type::kEngage);
  }

  /// The virtual hand moves slice 0 to and fro.
  void play(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      const bool up = (station_->nextTick() / 400) % 2 == 0;
      driver_->setTarget(0, up ? 0.01 : -0.01);
      station_->cycle({0, true});
      listen();
    }
  }

  void stall(int ticks) {
    station_->catchUp(ticks, 1'000'000);
    listen();
  }

  void setParameter(int index, double value) {
    auto values = std::vector<double>{};
    for (const scene::Parameter& parameter : playing_->scene().parameters) {
      values.push_back(parameter.value);
    }
    values[static_cast<std::size_t>(index)] = value;
    station::Command change;
    change.type = station::Command::Type::kParameter;
    change.index = index;
    change.value = value;
    change.coefficients = playing_->prepare(values).release();
    station_->submit(change);
  }

  void swap(const std::string& scene_text) {
    scene_text_ = scene_text;
    auto performer = perform(scene_text);
    playing_ = performer->instrument.get();
    submitted_ = performer.get();
    station::Command next;
    next.type = station::Command::Type::kSwap;
    next.performer = performer.release();
    station_->submit(next);
  }

  /// Every port moves with its slice, `gain` times as far.
  void configure(double gain) {
    scene::Scene scaled = playing_->scene();
    for (scene::Port& port : scaled.ports) {
      port.position_scale /= gain;
    }
    station::Command next;
    next.type = station::Command::Type::kConfigure;
    next.rig = tgr::makeRig(scaled, {}, tgr::kMaxSlices).release();
    station_->submit(next);
  }

  void recover() { submit(station::Command::Type::kRecover); }

  /// A hand holds a module and draws it to some place.
  void hold(std::size_t hand, int mat, double goal_m) {
    station::Hold hold;
    hold.mat = mat;
    hold.takes_hold = true;
    hold.goal[0] = goal_m;
    hold.ticks_left = 300;
    hold.stiffness = 400.0;
    hold.damping = 0.1;
    hold.most_force = 5.0;
    ASSERT_TRUE(station_->hold(hand, hold, performer_));
  }
  void letGo(std::size_t hand) { ASSERT_TRUE(station_->hold(hand, {}, performer_)); }

  void takeKeyframe() { submit(station::Command::Type::kKeyframe); }

  const bag::Recording& recording() const { return recording_; }
  /// From station frame 0 on, one channel; frames of ticks that never ran are 0.
  const std::vector<float>& sound() const { return sound_; }

  static constexpr physics::Rates kRates{44100.0, 14};

 private:
  void submit(station::Command::Type type) {
    station::Command command;
    command.type = type;
    station_->submit(command);
  }
  std::unique_ptr<station::Performer> perform(const std::string& text) const {
    return station::makePerformer(scene::readYaml(text, "live.yaml"), kRates, options_, policy_);
  }

  void push(std::int64_t first, const float* frames, int nframes) noexcept override {
    sound_.resize(static_cast<std::size_t>(first + nframes));
    std::copy_n(frames, nframes, sound_.begin() + first);
  }
  bool pull(std::int64_t, float* frames, int nframes) noexcept override {
    std::fill_n(frames, nframes, 0.0F);
    return false;
  }

  void listen() {
    station::GestureTick tick;
    while (station_->pollGestures(&tick, 1) == 1) {
      if (recording_.stretches.empty() || recording_.stretches.back().endTick() != tick.tick ||
          recording_.stretches.back().ports != tick.ports ||
          recording_.stretches.back().flags.size() == 64) {
        recording_.stretches.push_back({tick.tick, tick.slices, tick.ports, {}, {}, {}});
      }
      bag::Stretch& stretch = recording_.stretches.back();
      stretch.flags.push_back(tick.flags);
      stretch.positions.insert(stretch.positions.end(), tick.position.begin(),
                               tick.position.begin() + tick.slices);
      stretch.ports_at.insert(stretch.ports_at.end(), tick.port.begin(),
                              tick.port.begin() + tick.ports);
    }
    station::Event event;
    while (station_->poll(event)) {
      if (event.type == station::Event::Type::kSwapped && event.index == 1) {
        performer_ = submitted_;
      }
      delete std::exchange(event.performer, nullptr);
      delete std::exchange(event.coefficients, nullptr);
      delete std::exchange(event.rig, nullptr);
      recording_.events.push_back(event);
      if (event.type == station::Event::Type::kKeyframe) {
        addKeyframe(station_->keyframe());
      }
    }
  }

  void addKeyframe(const station::Keyframe& taken) {
    bag::Keyframe keyframe;
    keyframe.tick = taken.tick;
    keyframe.scene_name = "live.yaml";
    keyframe.scene_text = scene_text_;
    keyframe.rates = kRates;
    keyframe.precision = options_.precision;
    keyframe.isa = nameOf(options_.isa);
    keyframe.threads = options_.threads;
    keyframe.metered = options_.metered;
    keyframe.slices = 12;
    keyframe.state = taken.state;
    keyframe.parameters = taken.parameters;
    recording_.keyframes.push_back(keyframe);
  }

  std::string scene_text_;
  physics::CompileOptions options_;
  station::PerformerPolicy policy_;
  std::vector<float> sound_;
  bag::Recording recording_;
  const physics::Instrument* playing_ = nullptr;
  tgr::Driver* driver_ = nullptr;
  const station::Performer* performer_ = nullptr;  // that plays
  const station::Performer* submitted_ = nullptr;  // the newest
  std::unique_ptr<station::Station> station_;
};

}  // namespace ergotic::test
