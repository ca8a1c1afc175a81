// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "ergotic/exception.hpp"
#include "ergotic/scene/text/read_scene.hpp"
#include "ergotic/tgr/replay_driver.hpp"

namespace ergotic::replay {
namespace {

using EventType = station::Event::Type;

scene::Scene sceneOf(const bag::Keyframe& keyframe) {
  const std::string& name = keyframe.scene_name;
  const bool mdl = name.size() > 4 && name.compare(name.size() - 4, 4, ".mdl") == 0;
  return mdl ? scene::readMdl(keyframe.scene_text, name)
             : scene::readYaml(keyframe.scene_text, name, {}, {"", false});
}

/// Options as recorded, with the best kernels of this processor if it lacks the recorded ones.
physics::CompileOptions recordedOptions(const bag::Keyframe& keyframe) {
  physics::CompileOptions options(keyframe.precision);
  options.threads = keyframe.threads;
  options.metered = keyframe.metered;
  for (const rt::Isa isa : rt::isas()) {
    if (keyframe.isa == nameOf(isa)) {
      options.isa = isa;
    }
  }
  return options;
}

bool isSwap(const station::Event& event) {
  return event.type == EventType::kSwapped && event.index == 1;
}

bool beginsAnew(const station::Event& event) {
  return event.type == EventType::kRecovered && event.index == 1;
}

/// Number of slices of the device. Keyframes of recordings from before November 2026 may contain 0:
/// they were written before the station had read its device for the first time.
std::size_t slicesAt(const bag::Keyframe& start, const bag::Recording& recording) {
  return start.slices > 0 ? static_cast<std::size_t>(start.slices)
                          : recording.stretches.front().slices;
}

}  // namespace

/// The positions of the tick that the replay is at.
struct Replay::Source final : tgr::GestureSource {
  explicit Source(const std::vector<double>& from) : position(from) {}
  int slices() const noexcept override { return static_cast<int>(position.size()); }
  bool next(double* to) noexcept override {
    std::copy(position.begin(), position.end(), to);
    return true;
  }
  const std::vector<double>& position;
};

/// The ports of that tick, whatever moved them. Nobody feels their forces.
struct Replay::Ports final : tgr::Rig {
  Ports(const std::vector<double>& from, std::size_t ports) : position(from), count(ports) {}
  std::uint64_t toModel(const double* /*slices*/, double /*time_s*/, double* to) noexcept override {
    std::copy_n(position.begin(), std::min(count, position.size()), to);
    return 0;
  }
  void toDevice(const double* /*ports*/, double* /*slices*/) const noexcept override {}
  std::uint64_t slicesInUse() const noexcept override { return 0; }
  const std::vector<double>& position;
  std::size_t count;  // of the scene
};

Replay::Replay(bag::Recording recording,
               const station::PerformerPolicy& policy,
               CompileChoice choose)
    : recording_(std::move(recording)),
      policy_(policy),
      choose_(std::move(choose)),
      start_(findStart()),
      tick_(start().tick),
      position_(slicesAt(start(), recording_)),
      keyframe_(start_ + 1) {
  policy_.slices = static_cast<int>(position_.size());
  // Swaps that happened before the start, and changes that its parameters hold already.
  const auto is_past = [&](const station::Event& event) { return event.tick < tick_; };
  const auto first = std::find_if_not(recording_.events.begin(), recording_.events.end(), is_past);
  swap_ = change_ = static_cast<std::size_t>(first - recording_.events.begin());
  std::copy_if(first, recording_.events.end(), std::back_inserter(lost_),
               [](const station::Event& event) { return event.type == EventType::kTicksLost; });
  std::unique_ptr<station::Performer> performer = resume(start());
  playing_ = {performer.get(), performer->parameters};
  station_ =
      std::make_unique<OfflineStation>(std::move(performer), makeDriver(), widestModel(), tick_);
}

Replay::~Replay() = default;

std::size_t Replay::findStart() const {
  const auto recorded = [&](const bag::Keyframe& keyframe) {
    return std::any_of(
        recording_.stretches.begin(), recording_.stretches.end(), [&](const bag::Stretch& stretch) {
          return stretch.first_tick <= keyframe.tick && keyframe.tick < stretch.endTick();
        });
  };
  const auto& keyframes = recording_.keyframes;
  const auto found = std::find_if(keyframes.begin(), keyframes.end(), recorded);
  if (found != keyframes.end()) {
    return static_cast<std::size_t>(found - keyframes.begin());
  }
  const std::int64_t end = recording_.stretches.back().endTick();
  for (std::size_t i = keyframes.size(); i-- > 0;) {
    if (keyframes[i].tick < end) {
      return i;
    }
  }
  throw Exception("the recording ends before its first keyframe, tick " +
                  std::to_string(keyframes.front().tick));
}

/// Makes the performer in its state of the swap: with the parameters of its text, from its initial
/// state.
std::unique_ptr<station::Performer> Replay::perform(const bag::Keyframe& keyframe) const {
  const physics::CompileOptions recorded = recordedOptions(keyframe);
  auto performer = station::makePerformer(sceneOf(keyframe), keyframe.rates,
                                          choose_ ? choose_(recorded) : recorded, policy_);
  performer->rig = std::make_unique<Ports>(ports_, performer->positions.size());
  return performer;
}

/// Checks that a state is finite, unless the model had blown up: it was silent then, and begins
/// anew when it recovers.
void Replay::checkState(const bag::Keyframe& keyframe,
                        const physics::Instrument& instrument) const {
  if (wasAtFault()) {
    return;
  }
  try {
    physics::checkFinite(instrument.stateEntries(), keyframe.state);
  } catch (const Exception& refusal) {
    throw Exception("the recorded state of tick " + std::to_string(keyframe.tick) + ": " +
                    refusal.what());
  }
}

/// Makes the performer in its state of the keyframe.
std::unique_ptr<station::Performer> Replay::resume(const bag::Keyframe& keyframe) const {
  std::unique_ptr<station::Performer> performer = perform(keyframe);
  physics::Instrument& instrument = *performer->instrument;
  if (instrument.stateSize() != keyframe.state.size() ||
      performer->parameters.size() != keyframe.parameters.size()) {
    throw Exception("the recorded state has " + std::to_string(keyframe.state.size()) +
                    " bytes, this build needs " + std::to_string(instrument.stateSize()) +
                    ": it was recorded by another build, " + keyframe.build +
                    ". Replay it with that one");
  }
  checkState(keyframe, instrument);
  instrument.exchange(instrument.prepare(keyframe.parameters));
  performer->parameters = keyframe.parameters;
  instrument.loadState(keyframe.state.data());
  return performer;
}

std::unique_ptr<tgr::Driver> Replay::makeDriver() {
  return tgr::makeReplayDriver(std::make_unique<Source>(position_));
}

int Replay::widestModel() const {
  int channels = 1;
  for (std::size_t i = start_; i < recording_.keyframes.size(); ++i) {
    channels = std::max(channels, sceneOf(recording_.keyframes[i]).outputChannels());
  }
  return channels;
}

const station::MotionFrame* Replay::motion() {
  rt::Mailbox<station::MotionFrame>& motion = playing_.performer->motion;
  return motion.refresh() ? &motion.latest() : nullptr;
}

std::int64_t Replay::ticksLeft() const {
  return std::max<std::int64_t>(recording_.stretches.back().endTick() - tick_, 0);
}

bool Replay::next(double* frames) {
  if (ticksLeft() == 0) {
    return false;
  }
  if (wasLost(tick_)) {
    std::fill_n(frames, rates().ratio * outputChannels(), 0.0);
    station_->skip();
    in_gap_ = false;
  } else {
    takePositions();
    submitSwaps();
    submitChanges();
    submitKeyframe();
    station_->cycle(frames, [this](const station::Event& event) { hear(event); });
    checkPorts();
  }
  ++tick_;
  return true;
}

/// True if the station itself let this tick fall.
bool Replay::wasLost(std::int64_t tick) const {
  return std::any_of(lost_.begin(), lost_.end(), [&](const station::Event& event) {
    return event.tick <= tick && tick < event.tick + event.index;
  });
}

void Replay::takePositions() {
  auto& stretches = recording_.stretches;
  while (stretches[stretch_].endTick() <= tick_) {
    recording_.unload(stretches[stretch_++]);
  }
  bag::Stretch& stretch = stretches[stretch_];
  const bool missing = tick_ < stretch.first_tick;
  if (missing && !in_gap_) {
    addFlaw(tick_, "gap of " + std::to_string(stretch.first_tick - tick_) + " ticks");
  }
  in_gap_ = missing;
  if (missing) {
    return;
  }
  if (stretch.slices != position_.size()) {
    throw Exception("the device has " + std::to_string(stretch.slices) + " slices at tick " +
                    std::to_string(tick_) + " of the recording and " +
                    std::to_string(position_.size()) + " at its start");
  }
  if (stretch.positions.empty() && recording_.load) {
    recording_.load(stretch);
  }
  const auto row = static_cast<std::size_t>(tick_ - stretch.first_tick);
  const auto copyRow = [row](const std::vector<double>& from, std::vector<double>& to) {
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(row * to.size()), to.size(), to.begin());
  };
  copyRow(stretch.positions, position_);
  ports_.resize(stretch.ports);
  copyRow(stretch.ports_at, ports_);
  if ((stretch.flags[row] & station::GestureTick::kAudioInput) != 0 && !audio_input_told_) {
    audio_input_told_ = true;
    addFlaw(tick_, "live sound entered the model");
  }
}

void Replay::checkPorts() {
  const auto ports = static_cast<std::size_t>(instrument().ports());
  if (!in_gap_ && !ports_differ_told_ && ports_.size() != ports) {
    ports_differ_told_ = true;
    addFlaw(tick_, std::to_string(ports_.size()) + " ports were recorded, the model has " +
                       std::to_string(ports));
  }
}

const bag::Keyframe& Replay::keyframeOfSwap(std::int64_t tick) const {
  for (const bag::Keyframe& keyframe : recording_.keyframes) {
    if (keyframe.tick >= tick) {
      return keyframe;
    }
  }
  throw Exception("the model that plays from tick " + std::to_string(tick) +
                  " on is not in the recording: it has no keyframe after that");
}

/// A swap is asked for so long before it happens as the fade-out takes.
void Replay::submitSwaps() {
  while (swap_ < recording_.events.size() &&
         recording_.events[swap_].tick - station_->swapDelayTicks() <= tick_) {
    const station::Event& event = recording_.events[swap_++];
    if (!isSwap(event)) {
      continue;
    }
    std::unique_ptr<station::Performer> performer = perform(keyframeOfSwap(event.tick));
    incoming_ = {performer.get(), performer->parameters};
    for (const station::Event& change : std::exchange(changes_ahead_, {})) {
      takeParameter(change, incoming_);
      performer->instrument->exchange(performer->instrument->prepare(incoming_.parameters));
    }
    performer->parameters = incoming_.parameters;
    swap_tick_ = event.tick;
    station::Command swap;
    swap.type = station::Command::Type::kSwap;
    swap.performer = performer.get();
    station_->submit(swap);
    static_cast<void>(performer.release());  // the station has it now
  }
}

void Replay::submitChanges() {
  while (change_ < recording_.events.size() && recording_.events[change_].tick <= tick_) {
    const station::Event& event = recording_.events[change_++];
    if (event.type == EventType::kParameter) {
      if (!isOfNone(change_ - 1)) {
        submitParameter(event);
      }
    } else if (event.type == EventType::kHold) {
      station_->hold(static_cast<std::size_t>(event.index), event.hold);
    } else if (beginsAnew(event)) {
      station::Command recover;
      recover.type = station::Command::Type::kRecover;
      station_->submit(recover);
    }
  }
}

/// True of a parameter of a model that was discarded for a newer one before it played.
bool Replay::isOfNone(std::size_t change) const {
  const auto& events = recording_.events;
  if (events[change].frame >= 0) {
    return false;
  }
  const auto next =
      std::find_if(events.begin() + static_cast<std::ptrdiff_t>(change), events.end(),
                   [](const station::Event& event) { return event.type == EventType::kSwapped; });
  return next == events.end() || !isSwap(*next);
}

/// The station asks for a swap no earlier than it has to; the player may have loaded the model long
/// before, while an earlier one still faded in, and may have turned its knobs since.
void Replay::submitParameter(const station::Event& event) {
  const bool waits = incoming_.performer != nullptr && tick_ < swap_tick_;
  if (event.frame < 0 && !waits) {
    return changes_ahead_.push_back(event);
  }
  Tone& tone = waits ? incoming_ : playing_;
  takeParameter(event, tone);
  station_->setParameter(*tone.performer->instrument, tone.parameters,
                         static_cast<int>(event.index));
}

void Replay::takeParameter(const station::Event& event, Tone& tone) {
  if (event.index < 0 || event.index >= static_cast<std::int64_t>(tone.parameters.size())) {
    throw Exception("the change of a parameter at tick " + std::to_string(event.tick) +
                    " is of number " + std::to_string(event.index) + ", the model has " +
                    std::to_string(tone.parameters.size()));
  }
  tone.parameters[static_cast<std::size_t>(event.index)] = event.value;
}

/// Requests a keyframe at the tick of every later recorded one, to check the replay.
void Replay::submitKeyframe() {
  const auto& keyframes = recording_.keyframes;
  while (keyframe_ < keyframes.size() && keyframes[keyframe_].tick < tick_) {
    ++keyframe_;
  }
  if (keyframe_ < keyframes.size() && keyframes[keyframe_].tick == tick_) {
    station::Command keyframe;
    keyframe.type = station::Command::Type::kKeyframe;
    station_->submit(keyframe);
  }
}

void Replay::hear(const station::Event& event) {
  if (isSwap(event)) {
    playing_ = std::exchange(incoming_, {});
    if (tick_ != swap_tick_) {
      addFlaw(tick_, "a swap was under way at the keyframe that the replay starts from");
    }
  }
  if (isBlowUp(event) && !wasAtFault()) {
    addFlaw(tick_, "the model blows up, which it did not then");
  }
  if (event.type == EventType::kRecovered && !beginsAnew(event)) {
    addFlaw(tick_, "the model had blown up, which it does not now");
  }
  if (event.type == EventType::kKeyframe &&
      station_->keyframe().state != recording_.keyframes[keyframe_].state) {
    addFlaw(tick_, "the model is not in the recorded state");
  }
}

/// Whether the performance was at fault at this tick: blow-ups are reported only if it was not.
bool Replay::wasAtFault() const {
  bool fault = false;
  for (const station::Event& event : recording_.events) {
    const bool begins = event.type == EventType::kFault;
    if (begins || event.type == EventType::kRecovered) {
      if (event.tick > tick_) {
        return fault || !begins;  // what ends there may have begun before the recording
      }
      fault = begins;
    }
  }
  return fault;
}

void Replay::addFlaw(std::int64_t tick, const std::string& what) {
  flaws_.push_back("the replay may differ from what was played: " + what + " at tick " +
                   std::to_string(tick));
}

}  // namespace ergotic::replay
