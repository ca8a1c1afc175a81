// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "ergotic/station/station.hpp"

namespace ergotic::replay {

/// The model is not finite any more: silence from here on, until it begins anew or another plays.
bool isBlowUp(const station::Event& event);

/// Sound that enters an instrument from outside.
struct SoundSource {
  int channels = 0;
  /// Fills [nframes][channels] from station frame `first` on.
  std::function<void(std::int64_t first, int nframes, float* to)> read;
};

/// A station without a clock, whose sound is taken tick by tick.
class OfflineStation : private station::FramePort {
 public:
  /// \param output_channels  of the widest model that will play, >= 1
  /// \param first_tick       number of the tick that runs first
  /// \throws Exception if performer and driver do not fit
  OfflineStation(std::unique_ptr<station::Performer> performer,
                 std::unique_ptr<tgr::Driver> driver,
                 int output_channels,
                 std::int64_t first_tick = 0,
                 SoundSource inputs = {});

  const physics::Rates& rates() const { return rates_; }
  int outputChannels() const { return output_channels_; }

  /// \throws Exception if the station does not take it
  void submit(const station::Command& command);

  /// Moves a hand, as Station::move. \throws Exception if the station does not take it
  void move(const tgr::HandMove& move, double due_tick);

  /// Sets the parameters of the model from the next tick on.
  /// \param values  [parameters]. \param index  index of the new value, for the record
  /// \throws Exception if the station does not take it
  void setParameter(const physics::Instrument& instrument,
                    const std::vector<double>& values,
                    int index);

  /// Sets a hold as recorded. \throws Exception if the station does not take it
  void hold(std::size_t hand, const station::Hold& hold);

  /// Runs one tick; its events, without the objects that they hand back, then go to `hear`.
  /// \param[out] frames  [R][output channels]
  void cycle(double* frames, const std::function<void(const station::Event&)>& hear = nullptr);

  /// Skips the next tick, which the tick index counts.
  void skip() { station_.skip(1); }

  const station::Keyframe& keyframe() const { return station_.keyframe(); }
  int swapDelayTicks() const { return station_.swapDelayTicks(); }

 private:
  void push(std::int64_t first, const float* frames, int nframes) noexcept override;
  bool pull(std::int64_t first, float* frames, int nframes) noexcept override;

  SoundSource inputs_;
  int output_channels_;
  physics::Rates rates_;
  std::vector<float> sound_;  // of the last tick, [R][station channels]
  station::Station station_;
};

}  // namespace ergotic::replay
