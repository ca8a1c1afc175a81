// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>

#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/station/performer.hpp"
#include "ergotic/station/station.hpp"
#include "ergotic/tgr/driver.hpp"
#include "support/test.hpp"

/// A device and an instrument as simple as can be, so that what the station does in between shows.
namespace ergotic::test {

/// Calls of `exchange` seen by a ScriptedDriver; written by the tick.
struct DriverLog {
  std::int64_t exchanges = 0;
  std::vector<double> forces;  ///< last ones received
  bool open = false;
  std::atomic<bool> safe{false};
};

/// Positions come from a function of the exchange number; forces are shown to another one.
class ScriptedDriver : public tgr::Driver {
 public:
  using Position = std::function<double(std::int64_t exchange, int slice)>;
  using Watch = std::function<void(std::int64_t exchange, const double* forces)>;

  ScriptedDriver(int slices, DriverLog& log, Position position)
      : slices_(slices), log_(log), position_(std::move(position)) {
    log_.forces.resize(static_cast<std::size_t>(slices));
  }

  void open(double /*tick_rate_hz*/) override { log_.open = true; }
  void close() noexcept override { log_.open = false; }
  int slices() const noexcept override { return slices_; }
  std::uint32_t exchange(const double* forces, double* positions) noexcept override;
  void makeSafe() noexcept override { log_.safe.store(true); }
  void rearm() noexcept override { log_.safe.store(false); }
  std::uint64_t uncalibrated() const noexcept override { return uncalibrated_slices; }
  bool isSteppedByExchange() const noexcept override { return stepped_by_exchange; }
  bool canHurt() const noexcept override { return !stepped_by_exchange; }

  std::uint64_t uncalibrated_slices = 0;
  bool stepped_by_exchange = false;
  Watch watch;                                          ///< may be empty
  std::function<std::uint32_t(std::int64_t)> flags_of;  ///< may be empty: kExchangeOk

 private:
  int slices_;
  DriverLog& log_;
  Position position_;
};

inline scene::Port portOfSlice(int slice) {
  scene::Port port;
  port.slice = slice;
  return port;
}

/// F = -stiffness x on one slice; output channels 0...n-1 all carry `level`, or the frame count.
/// Its state is the number of frames made. It can be told to blow up.
class SpringInstrument : public physics::Instrument {
 public:
  struct Setting {
    double stiffness = 100.0;   ///< N/m, in the model
    double level = 0.5;         ///< of every output sample
    bool count_frames = false;  ///< samples are the index of their frame instead
    int outputs = 2;
    int inputs = 0;
    scene::Port port = portOfSlice(0);  ///< slice and scales
    double audio_hz = 44100.0;
    int ratio = 14;
    std::int64_t bad_force_at = -1;         ///< tick of a NaN force, -1: never
    std::int64_t bad_sample_at = -1;        ///< tick of an infinite sample
    std::int64_t bad_displacement_at = -1;  ///< first tick at which isFinite() is false
    int* destroyed = nullptr;               ///< counted up by the destructor
  };

  explicit SpringInstrument(const Setting& setting);
  ~SpringInstrument() override;
  void tick(const physics::TickIo& io) noexcept override;
  std::unique_ptr<physics::Coefficients> prepare(const std::vector<double>& values) const override;
  std::unique_ptr<physics::Coefficients> exchange(
      std::unique_ptr<physics::Coefficients> next) noexcept override;
  std::size_t stateSize() const noexcept override { return sizeof(frames_); }
  std::vector<physics::StateEntry> stateEntries() const override;
  void saveState(void* to) const noexcept override;
  void loadState(const void* from) noexcept override;
  physics::Energies makeEnergies() const override { return {}; }
  std::vector<physics::TankReport> makeTankReports() const override { return {}; }
  void readEnergies(physics::Energies&) const noexcept override {}
  void readTanks(std::vector<physics::TankReport>&) const noexcept override {}
  void readDisplacements(float* to) const noexcept override;
  std::vector<std::string> describe() const override { return {}; }
  bool isFinite() const noexcept override;

  bool isUnderWay() const noexcept override { return held_up; }
  bool finish() noexcept override { return !held_up; }

  bool held_up = false;     ///< another thread does not finish its share of a tick
  double last_input = 0.0;  ///< sum of all input samples of the last tick

 private:
  struct Stiffness : physics::Coefficients {
    double value = 0.0;
  };
  Setting setting_;
  std::unique_ptr<Stiffness> stiffness_;
  std::int64_t frames_ = 0;
};

std::unique_ptr<station::Performer> makeSpring(const SpringInstrument::Setting& setting = {});

/// Ticks of the shortest ramp, and some.
constexpr std::int64_t kRampTicks = 400;

/// A station over doubles, and what is needed to look at it.
struct Bench {
  explicit Bench(
      const SpringInstrument::Setting& setting = {},
      ScriptedDriver::Position position = [](std::int64_t, int) { return 0.01; },
      const station::StationConfig& config = quickConfig(),
      int slices = 2);
  /// Short ramp, small rings.
  static station::StationConfig quickConfig();

  bool command(station::Command::Type type);
  bool command(station::Command::Type type, double value, int index = 0);
  bool swap(std::unique_ptr<station::Performer> performer,
            station::SwapForce force = station::SwapForce::kAlways,
            station::Caller caller = 0);
  void run(std::int64_t ticks);
  /// Until force has come whole.
  void engage(station::Caller caller = 0);
  /// All events up to now; what they hand back is kept.
  std::vector<station::Event> events();
  /// All ticks since the last call.
  std::vector<station::GestureTick> recorded();

  DriverLog log;
  ScriptedDriver* driver = nullptr;
  SpringInstrument* instrument = nullptr;                            ///< the first one
  std::vector<std::unique_ptr<station::Performer>> performers;       ///< handed back
  std::vector<std::unique_ptr<physics::Coefficients>> coefficients;  ///< handed back
  std::vector<std::unique_ptr<tgr::Rig>> rigs;                       ///< handed back
  std::shared_ptr<station::Interlock> interlock = std::make_shared<station::Interlock>();
  std::unique_ptr<station::Station> station;
};

/// Number of events of a type.
int count(const std::vector<station::Event>& events, station::Event::Type type);
/// Number of ticks that were late because of this.
std::int64_t lateEvents(const std::vector<station::Event>& events, station::LateCause cause);
/// The first event of a type, or one with tick -1.
station::Event firstOf(const std::vector<station::Event>& events, station::Event::Type type);

/// Keeps every frame that a station pushes, channel 0 only.
class FrameLog : public station::FramePort {
 public:
  explicit FrameLog(int channels) : channels_(static_cast<std::size_t>(channels)) {}
  void push(std::int64_t first, const float* frames, int nframes) noexcept override;
  bool pull(std::int64_t first, float* frames, int nframes) noexcept override;

  std::vector<float> samples;         ///< channel 0
  std::vector<std::int64_t> indices;  ///< station frame of each
  float input_level = 0.0F;           ///< given to every pull

 private:
  std::size_t channels_;
};

}  // namespace ergotic::test
