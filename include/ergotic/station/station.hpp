// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "ergotic/rt/mailbox.hpp"
#include "ergotic/rt/realtime.hpp"
#include "ergotic/rt/ring.hpp"
#include "ergotic/station/frame_port.hpp"
#include "ergotic/station/interlock.hpp"
#include "ergotic/station/messages.hpp"
#include "ergotic/station/performer.hpp"
#include "ergotic/station/swap_fade.hpp"
#include "ergotic/station/tick_meter.hpp"
#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/safety_chain.hpp"

namespace ergotic::station {

struct StationConfig {
  physics::Rates rates;
  int output_channels = 24;  ///< audio channels out; a model's higher channels are dropped
  int input_channels = 12;   ///< audio channels in; a model's higher channels get silence
  tgr::SafetyConfig safety;
  double max_stall_s = 0.05;  ///< longer ones are a Fault, 0.001...1
  int max_stalls = 3;         ///< permitted per second of force; more are a Fault, 1...1e6
  double display_hz = 60.0;   ///< how often snapshots and motion are published
  double presence_s = 0.0;    ///< longest time between two tellPresence; 0: no switch
  double glide_s = 0.1;       ///< duration of the glide of the ports to another rig, 0.001...10
  bool allow_fault_injection = false;      ///< obey kInject
  std::size_t record_ring = 1U << 14U;     ///< gesture ticks
  std::size_t event_ring = 1U << 12U;      ///< events, beside those that hand something back
  std::size_t command_ring = 1U << 8U;     ///< commands
  std::size_t keyframe_bytes = 1U << 24U;  ///< largest state that a keyframe can hold
  /// Largest state that a tick copies while there is force; for a larger one it waits.
  std::size_t keyframe_bytes_in_force = 1U << 18U;
  std::int64_t first_tick = 0;  ///< number of the tick that runs first, >= 0
};

/// State of an instrument at the start of a recording.
struct Keyframe {
  std::int64_t tick = 0;  ///< the first tick to be run from this state
  std::vector<std::uint8_t> state;
  std::vector<double> parameters;
};

/// The room around the instrument. One thread, the tick's, calls `cycle` and `catchUp`; one other
/// thread, the command thread, calls everything below "Command thread".
///
/// Tick n: driver.exchange(F[n-1]) -> x[n]; validate; commands; rig: slices to ports;
/// instrument.tick -> R frames; rig: forces of ports to slices, F[n]; safety chain; records. F[n]
/// goes out with the exchange that reads x[n+1].
///
/// Tick n makes the station frames n R ... n R + R - 1, always: ticks that never ran (a stall
/// beyond max_stall) still count in the tick index, and their frames are never pushed.
class Station {
 public:
  /// Opens the driver. Realtime: no. Thread: setup
  /// \param interlock  not null; it may have been latched before
  /// \throws DeviceError from the driver, Exception if a setting is outside its range or the
  ///         performer does not fit (rates, slices)
  Station(const StationConfig& config,
          std::unique_ptr<tgr::Driver> driver,
          std::unique_ptr<Performer> performer,
          std::shared_ptr<Interlock> interlock = std::make_shared<Interlock>());
  /// Forces to zero, driver closed; frees what was submitted and never handed back.
  /// Realtime: no. \pre no tick is running
  ~Station();
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;

  /// Sets where audio frames go; null: nowhere. \pre no tick is running. Realtime: no. Thread:
  /// setup
  void setFramePort(FramePort* port) noexcept { frame_port_ = port; }

  /// Sets where the cost of ticks is counted; null: nowhere. \pre no tick is running, and the meter
  /// outlives them. Realtime: no. Thread: setup
  void setMeter(TickMeter* meter) noexcept { meter_ = meter; }

  /// Lateness of a tick, as the tick source reports it.
  struct Timing {
    std::int64_t late_ns = 0;  ///< delay of its begin after its due time
    bool freewheel = false;    ///< no clock drives the ticks, so no tick can be late
  };
  /// Runs one tick. Realtime: yes. Thread: tick
  ERGOTIC_REALTIME void cycle(const Timing& timing) noexcept;

  /// Runs the `ticks` ticks that are due after a stall: one exchange with zero force, then the
  /// ticks with positions interpolated to the new sample, force muted, recorded as kCatchUp; the
  /// force then ramps in again. With a device that is stepped by its exchanges all of them run as
  /// if they had been in time. Beyond max_stall: Fault kStall; the oldest ticks are lost
  /// (kTicksLost), so that the work is bounded by max_stall's worth of ticks. The model's time
  /// stands still over lost ticks; the tick index, and with it the station frame and the clock,
  /// does not. Realtime: yes. Thread: tick
  ERGOTIC_REALTIME void catchUp(std::int64_t ticks, std::int64_t stall_ns) noexcept;

  /// Closes the force gate and sends zero force: the last act of a tick source. Under a later
  /// source force has to be engaged again. Realtime: yes. Thread: tick
  ERGOTIC_REALTIME void rest() noexcept;

  /// Skips ticks that will never run; the tick index counts them. Realtime: yes. Thread: tick
  void skip(std::int64_t ticks) noexcept { tick_ += ticks; }

  /// Index of the tick that runs next. Realtime: yes. Thread: tick
  std::int64_t nextTick() const noexcept { return tick_; }

  /// Realtime: yes. Thread: any
  const StationConfig& config() const noexcept { return config_; }

  /// Ticks from the one that takes a kSwap while no other swap is under way to the one at which the
  /// new performer plays. Realtime: yes. Thread: any
  int swapDelayTicks() const noexcept { return fade_.ticks() + 1; }

  // Any thread:
  /// Forces to zero at once, latched until a kRecover that is asked for later: for signals,
  /// watchdogs, emergency stops. Realtime: as the driver's. Thread: any
  void makeSafe(FaultReason reason = FaultReason::kMadeSafe) noexcept;
  /// The player holds the presence switch, or not; to be repeated. Of two that come within a tick
  /// the one that lets go counts. Realtime: yes. Thread: any
  void tellPresence(bool is_held) noexcept { told_presence_ |= is_held ? kHeld : kLetGo; }
  /// Forces to zero with the next exchange, until a kEngage that is asked for later. Realtime: yes.
  /// Thread: any
  void stop() noexcept { interlock_->stop(); }
  /// Counts up with every cycle and catchUp: what a watchdog looks at. Realtime: yes. Thread: any
  const std::atomic<std::int64_t>& heartbeat() const noexcept { return heartbeat_; }

  // Whoever moves the hands of simulated devices, one thread at a time:
  static constexpr double kAtOnce = std::numeric_limits<double>::quiet_NaN();
  /// Moves the hand at a slice, with the next tick. \param due_tick  when the move is due, in ticks
  /// with their fraction, in place of what the move says; one that has passed: at once
  /// \return false if there is no such hand, a value is outside its range, or too many moves wait
  /// Realtime: yes. Thread: one, any
  bool move(const tgr::HandMove& move, double due_tick = kAtOnce) noexcept;

  /// Makes one of the hands that can hold any module do as `hold` says, from the next tick on. A
  /// hand that already holds this module goes on from where it is; any other hand attaches at the
  /// module's position. All hands let go when another model plays. If several calls for a hand fall
  /// into one tick, the newest counts.
  /// \param hand   below physics::kMaxTouches
  /// \param model  performer that the call is meant for; while another one plays the call has no
  ///               effect. Null: the one that plays, and `hold` applies unchanged, as in a replay
  /// \return false if a value is outside its range. A module that cannot be held
  ///         (Instrument::canTouch) is ignored. Realtime: yes. Thread: as `move`
  bool hold(std::size_t hand, const Hold& hold, const Performer* model) noexcept;

  // Command thread:
  /// Hands a command over. A recovery also re-arms the driver. What a command points to belongs to
  /// the station from here on, and comes back through exactly one event.
  /// \return false if the ring is full, or too many swaps, parameters and rigs wait for `poll`;
  ///         nothing is taken then
  /// \throws Exception if a performer does not fit this station (nothing is taken)
  /// Realtime: no. Thread: command thread
  bool submit(const Command& command);
  /// \return false if there is no event. Realtime: yes. Thread: command thread
  bool poll(Event& event) noexcept;
  /// \return number of gesture ticks given out. Realtime: yes. Thread: command thread
  std::size_t pollGestures(GestureTick* to, std::size_t count) noexcept {
    return gestures_.pop(to, count);
  }
  /// Newest snapshot, if there is one not yet seen, else null. Realtime: yes. Thread: command
  /// thread
  const Snapshot* snapshot() noexcept {
    return snapshots_.refresh() ? &snapshots_.latest() : nullptr;
  }
  /// Valid from when `poll` gave an Event::kKeyframe to the next Command::kKeyframe. Commands that
  /// come before that event ask for the same keyframe. Thread: command thread
  const Keyframe& keyframe() const noexcept { return keyframe_; }
  /// Thread: command thread
  tgr::Driver& driver() noexcept { return *driver_; }
  /// Checks whether a performer can be swapped in. Realtime: no. Thread: any
  /// \throws Exception saying what does not fit
  void checkFits(const Performer& performer) const;

 private:
  using Slices = std::array<double, tgr::kMaxSlices>;
  static constexpr unsigned kHeld = 1;  // presence as it was told since the last tick, bits
  static constexpr unsigned kLetGo = 2;
  static constexpr std::size_t kWaitingMoves = 256;
  struct HoldWish {
    Hold hold;
    const Performer* model = nullptr;
  };
  struct DueMove {
    tgr::HandMove move;
    double due_tick = kAtOnce;
    std::int64_t asked_ns = 0;  // of CLOCK_MONOTONIC
  };

  // One tick, step by step (station.cpp).
  void moveHands(std::int64_t missed, std::int64_t asked_until_ns) noexcept;
  void noteStall(std::int64_t run, std::int64_t lost, double stall_s) noexcept;
  void runWithExchanges(std::int64_t ticks) noexcept;
  void runInterpolated(std::int64_t ticks, const Slices& target, std::uint32_t flags) noexcept;
  std::uint32_t accept(Slices& positions,
                       std::uint32_t exchange_flags,
                       std::int64_t host_missed) noexcept;
  void runTick(const Slices& positions, std::uint32_t flags) noexcept;
  bool pullInputs() noexcept;
  void movePorts(const Slices& positions) noexcept;
  void glideFromThere() noexcept;
  void moveHolds() noexcept;
  void tickInstrument() noexcept;
  void letGo() noexcept;
  void pushFrames() noexcept;
  void updateForces(bool muted) noexcept;
  void followCalibration() noexcept;
  void followPresence() noexcept;
  void injectModelFault() noexcept;
  void record(const Slices& positions, std::uint32_t flags) noexcept;
  void publish() noexcept;
  void relayAudioEvents() noexcept;
  void classify(const Timing& timing, std::int64_t exchange_ns, std::int64_t compute_ns) noexcept;
  void late(LateCause cause, std::int64_t& counter, std::int64_t ns) noexcept;

  // What operators ask for (commands.cpp).
  void rearm(Ticket asked) noexcept;
  void drainCommands() noexcept;
  void obey(const Command& command) noexcept;
  void engage(const Command& command) noexcept;
  void takeSwap(const Command& command) noexcept;
  void advanceSwap() noexcept;
  bool keepsForce() noexcept;
  void takeCoefficients(const Command& command) noexcept;
  void takeRig(tgr::Rig* next) noexcept;
  void recover(const Command& command) noexcept;
  void refuse(const Command& command, Refusal refusal) noexcept;
  void takeInjection(const Command& command) noexcept;
  void takeHold(std::size_t hand, const HoldWish& wish) noexcept;
  void tellHold(std::size_t index) noexcept;
  bool mayTakeKeyframe() const noexcept;
  void takeKeyframe() noexcept;

  bool hasForce() const noexcept;
  bool isKickedTooOften() noexcept;
  void kick(double stall_s) noexcept;
  void kick(FaultReason reason, int slice) noexcept;
  void followInterlock() noexcept;
  void takeForceAway() noexcept;
  void fault(FaultReason reason, int slice) noexcept;
  void blowUp() noexcept;
  Event event(Event::Type type) const noexcept;
  void tell(const Event& event) noexcept;
  void handBack(const Event& event) noexcept;

  // Set-up, constant while ticking.
  StationConfig config_;
  double tick_ns_;
  std::int64_t max_catch_up_;
  std::int64_t display_ticks_;
  std::unique_ptr<tgr::Driver> driver_;
  int slices_;
  FramePort* frame_port_ = nullptr;
  TickMeter* meter_ = nullptr;
  std::shared_ptr<Interlock> interlock_;
  std::int64_t glide_ticks_;     // length of a glide
  std::int64_t presence_ticks_;  // longest time between two that tell it; 0: no switch

  // The tick's own.
  tgr::SafetyChain chain_;
  SwapFade fade_;
  std::unique_ptr<Performer> performer_;
  std::unique_ptr<Performer> incoming_;  // waits for the fade-out
  SwapForce incoming_force_{};           // when it plays
  Caller incoming_caller_ = 0;           // who submitted it
  Caller engager_ = 0;                   // who let force out last
  std::uint64_t uncalibrated_;           // slices, as of the last tick
  std::int64_t tick_;
  Ticket seen_ = 0;                 // of the interlock
  bool is_latched_ = false;         // and the fault was told
  int fault_slice_ = -1;            // of the fault that is about to be told
  double stall_s_ = 0.0;            // Snapshot::stall_s
  std::uint64_t stalls_borne_ = 0;  // Snapshot::stalls_borne
  bool blown_up_ = false;
  bool is_held_up_ = false;     // another thread has not finished the last tick
  double kicks_ = 0.0;          // not yet forgotten
  std::int64_t kick_tick_ = 0;  // of the last one
  bool keyframe_wanted_ = false;
  Slices force_{};                              // N, of the last tick, for the next exchange
  Slices position_{};                           // m, of the last tick
  Slices velocity_{};                           // m/s
  std::array<double, tgr::kMaxPorts> glide_{};  // m, of each port: where it comes from
  std::int64_t gliding_ = 0;                    // ticks left of it
  std::int64_t absent_ = 0;                     // ticks since the last one
  bool present_ = false;
  Holds holds_{};
  std::array<physics::Touch, physics::kMaxTouches> touches_{};  // of this tick
  InjectedModelFault injected_{};
  std::int64_t inject_ticks_ = 0;  // left of it
  std::int64_t inject_age_ = 0;    // ticks that it has lasted
  Slices inject_from_{};           // m, where the slices were when it began
  std::vector<float> frames_out_;
  std::vector<float> frames_in_;
  Counters counters_;

  // Shared.
  std::atomic<unsigned> told_presence_{0};
  std::atomic<std::int64_t> heartbeat_{0};
  rt::Ring<Command> commands_;
  rt::Ring<DueMove> moves_{kWaitingMoves};
  std::array<rt::Mailbox<HoldWish>, physics::kMaxTouches> hold_wishes_;
  rt::Ring<Event> events_;
  rt::Ring<GestureTick> gestures_;
  rt::Mailbox<Snapshot> snapshots_;
  Keyframe keyframe_;

  // Of the command thread.
  std::size_t owed_ = 0;         // what was submitted with a pointer and did not yet come back
  bool keyframe_asked_ = false;  // and not yet come, or not yet seen
};

/// Damping that a station relies on, given what the driver declares, both in N s/m: half of it, and
/// no more than 100 (docs/safety.md). Realtime: yes. Thread: any
double trustedDamping(double declared) noexcept;

}  // namespace ergotic::station
