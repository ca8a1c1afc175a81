// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/bag/recording.hpp"
#include "ergotic/physics/options.hpp"
#include "replay/offline_station.hpp"

namespace ergotic::replay {

/// Map from the recorded options of compilation to those of the replay.
using CompileChoice = std::function<physics::CompileOptions(physics::CompileOptions recorded)>;

/// Plays a recorded performance again in a station: the recorded positions, parameter changes,
/// swaps and new beginnings after a blow-up at their ticks. The same build gives the same samples,
/// bit for bit, on any processor.
///
/// Ticks that never ran during the recording are silence; ticks that ran but are missing from the
/// recording are played with the last position held, and reported in `flaws`.
class Replay {
 public:
  /// Starts at the first keyframe whose tick was recorded.
  /// \throws TextError, Exception if a scene cannot be read or compiled here, or may not be played
  /// \param choose  how to compile what was recorded with these options; the precision has to stay.
  ///                If empty, as recorded
  Replay(bag::Recording recording,
         const station::PerformerPolicy& policy,
         CompileChoice choose = {});
  ~Replay();

  const physics::Rates& rates() const { return station_->rates(); }
  int outputChannels() const { return station_->outputChannels(); }
  const physics::Instrument& instrument() const {
    return *playing_.performer->instrument;
  }  ///< instrument that plays

  /// \param[out] frames  [R][output channels], where R frames make a tick
  /// \return false if there is no more; `frames` is untouched then
  /// \throws Exception if the recording cannot be played on
  bool next(double* frames);

  /// Present motion of the model, about 60 times per second of its time.
  /// \return null if there is no new frame since the last call
  const station::MotionFrame* motion();

  /// Positions of the device's slices at the last tick, m.
  const std::vector<double>& slices() const { return position_; }

  /// Number of ticks left to play.
  std::int64_t ticksLeft() const;

  const bag::Keyframe& start() const { return recording_.keyframes[start_]; }

  /// Reasons for which the sound differs from the recorded performance, in order; empty: it is
  /// equal.
  const std::vector<std::string>& flaws() const { return flaws_; }

 private:
  struct Source;
  struct Ports;
  struct Tone {
    station::Performer* performer = nullptr;  // the station's
    std::vector<double> parameters;
  };

  std::size_t findStart() const;
  std::unique_ptr<station::Performer> perform(const bag::Keyframe& keyframe) const;
  void checkState(const bag::Keyframe& keyframe, const physics::Instrument& instrument) const;
  std::unique_ptr<station::Performer> resume(const bag::Keyframe& keyframe) const;
  std::unique_ptr<tgr::Driver> makeDriver();
  int widestModel() const;
  const bag::Keyframe& keyframeOfSwap(std::int64_t tick) const;
  bool wasLost(std::int64_t tick) const;
  void takePositions();
  void checkPorts();
  void submitSwaps();
  void submitChanges();
  void submitParameter(const station::Event& event);
  bool isOfNone(std::size_t change) const;
  static void takeParameter(const station::Event& event, Tone& tone);
  bool wasAtFault() const;
  void submitKeyframe();
  void hear(const station::Event& event);
  void addFlaw(std::int64_t tick, const std::string& what);

  bag::Recording recording_;
  station::PerformerPolicy policy_;
  CompileChoice choose_;
  std::size_t start_;
  std::int64_t tick_;  // the one to be played next, as numbered in the recording
  std::vector<double> position_;
  std::vector<double> ports_;
  std::size_t stretch_ = 0;           // the one that holds tick_, or the next one
  std::size_t swap_ = 0;              // events up to here were looked at for swaps,
  std::size_t change_ = 0;            // for other changes,
  std::size_t keyframe_ = 0;          // and keyframes up to here
  std::int64_t swap_tick_ = -1;       // at which the swap under way has to happen, -1: none
  std::vector<station::Event> lost_;  // kTicksLost
  bool in_gap_ = false;
  bool audio_input_told_ = false;
  bool ports_differ_told_ = false;
  Tone playing_;
  Tone incoming_;
  std::vector<station::Event>
      changes_ahead_;  // parameters of a model whose swap is not asked for yet
  std::unique_ptr<OfflineStation> station_;
  std::vector<std::string> flaws_;
};

}  // namespace ergotic::replay
