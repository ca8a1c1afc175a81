// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "ergotic/physics/engine/instrument.hpp"
#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/fault.hpp"
#include "ergotic/tgr/rig.hpp"

/// Messages between the real-time thread and the other threads: plain structs only.
namespace ergotic::station {

/// State of the force output. Force never comes back by itself.
enum class ForceState : std::uint8_t {
  kDisconnected,  ///< no driver open
  kUncalibrated,  ///< as kReady, but a slice in use has no calibration: `engage` is refused
  kReady,         ///< running, forces held at zero until `engage`
  kEngaging,      ///< ramping in
  kPlaying,       ///< forces reach the hand
  kFault,         ///< latched at zero; see the event with its reason; `recover` clears it
};
const char* toString(ForceState state);

/// Number of times force had been taken away when a request was made, see Interlock.
using Ticket = std::uint64_t;
constexpr Ticket kAskedNow = ~Ticket{0};  ///< stands for the ticket at the time of submission

/// Identifies who submits a command. When a swap with SwapForce::kCaller takes effect, its caller
/// is compared with that of the last kEngage, as another caller may have engaged force in between.
using Caller = std::uint64_t;

/// Condition under which force ramps in again after a swap.
enum class SwapForce : std::uint8_t {
  kAlways,
  kNever,   ///< force goes to zero and waits for kEngage
  kCaller,  ///< if the submitter of the swap engaged the force; otherwise as kNever
};

/// An instrument ready to play with the data of its ports, made outside the tick, with one owner.
struct Performer;

/// A hand that holds a module anywhere in the model, and where it goes: all of it between two
/// ticks, so that a recording of its changes is enough to play it again. Places are displacements
/// from rest, m, as in physics::Touch.
struct Hold {
  int mat = physics::Touch::kNothing;  ///< as Touch::mat; kNothing: the hand holds nothing
  bool takes_hold = false;             ///< attach in the next tick, at the module's position then
  std::array<double, 3> at{};          ///< position that the hand wants, m
  std::array<double, 3> goal{};        ///< end of its motion on a straight line, m
  int ticks_left = 0;                  ///< ticks until it reaches `goal`, 0...kMaxHoldTicks
  double stiffness = 0.0;              ///< N/m
  double damping = 0.0;                ///< N s/m
  double most_force = 0.0;             ///< N
};
constexpr int kMaxHoldTicks = 1 << 20;
using Holds = std::array<Hold, physics::kMaxTouches>;

/// Command from operators to the tick, executed at a tick boundary.
struct Command {
  enum class Type : std::uint8_t {
    kEngage,     ///< ramp force in
    kSwap,       ///< take `performer`, hand the old one back; index: SwapForce
    kParameter,  ///< take `coefficients`, prepared by the performer submitted last; index and value
                 ///< say which parameter got which value, for the record
    kConfigure,  ///< force to zero, state Ready; take `rig`, made for the performer submitted last
    kRecover,    ///< go from Fault to Ready; a model that blew up starts anew
    kInject,     ///< index: InjectedModelFault, value: ticks; if the configuration allows it. Other
                 ///< indices are told, no more: faults that are made elsewhere
    kKeyframe,   ///< copy the state for a recording that starts now, or after the fade of a swap
  };
  Type type = Type::kKeyframe;
  int index = 0;
  double value = 0.0;
  std::uint64_t id = 0;      ///< identifies kEngage and kRecover in their answers
  Ticket asked = kAskedNow;  ///< kEngage and kRecover fail if force was taken away since
  Caller caller = 0;         ///< submitter of kEngage or kSwap
  Performer* performer = nullptr;
  physics::Coefficients* coefficients = nullptr;
  tgr::Rig* rig = nullptr;
};

/// Faults that can be injected into the model's forces, ahead of the safety chain. The numbers are
/// part of the ROS interface (InjectFault.srv).
enum class InjectedModelFault : std::uint8_t {
  kNotANumber = 16,  ///< a force that is not a number
  kBlowUp = 17,      ///< forces that double with every tick, from 1 N on
  kActive = 18,      ///< a spring of negative stiffness between hand and model
};

/// Report from the tick to all receivers, in order, stamped with the tick at which it took effect.
struct Event {
  enum class Type : std::uint8_t {
    kEngaged,  ///< id; value: ramp, s
    kPlaying,  ///< the ramp is over
    kStopped,
    kSwapped,    ///< performer: to be freed by the receiver; index: 1 it was replaced at this tick,
                 ///< 0 it never played, because a newer one was submitted in time; value: 1
                 ///< force went to zero with it and waits for kEngage
    kParameter,  ///< index, value; coefficients: the old ones, to be freed; frame: -1 if it is of a
                 ///< performer that has still to be swapped in
    kKeyframe,   ///< index: 1 the state is in Station::keyframe() until the next request, 0 it is
                 ///< larger than the configuration allows
    kFault,     ///< index: FaultReason; value: slice; of kStall the length of the stall, s (0: none
                ///< of the thread, force went and came back), and id: how many a second of force
                ///< may bring, if it was one too many, else 0
    kLateTick,  ///< index: LateCause; value: lateness, s
    kStall,     ///< index: ticks caught up; value: length, s
    kTicksLost,     ///< index: ticks that never ran, beyond max_stall, from `tick` on
    kUnderrun,      ///< frame: first missing station frame; index: frames; value: JACK frame time
    kAudioSkipped,  ///< as kUnderrun, but the host itself left these frames out: nothing sounded
    kAudioStarted,  ///< frame: station frame; value: JACK frame time at which it sounds
    kAudioStopped,
    kConfigured,  ///< rig: the old one, to be freed; force is zero, state Ready
    kRecovered,   ///< id; from Fault to Ready; index: 1 the model began anew
    kRefused,     ///< id; index: Refusal; an `engage` or `recover` that was not obeyed
    kInjected,    ///< a fault is made on purpose, from this tick on; index: of the command
    kHold,        ///< index: which hand; hold: what it does from this tick on
  };
  Type type = Type::kStopped;
  std::int64_t tick = 0;
  std::int64_t frame = 0;
  std::int64_t index = 0;
  double value = 0.0;
  std::uint64_t id = 0;  ///< id of the command that this event answers
  Performer* performer = nullptr;
  physics::Coefficients* coefficients = nullptr;
  tgr::Rig* rig = nullptr;
  Hold hold{};
};

/// Reason why a command was not obeyed.
enum class Refusal : std::uint8_t {
  kFault = 1,     ///< `recover` first
  kUncalibrated,  ///< a slice in use has no calibration
  kPresence,      ///< the presence switch is not held
  kBusy,          ///< the model still glides to other end-effectors, or finishes a tick
  kOutdated,      ///< force was taken away since this was asked for
};
const char* toString(Refusal refusal);

/// Explains a fault kStall: which limit was exceeded, and what helps. The parameters are
/// Event::value and Event::id of that fault.
std::string explainStall(double stall_s, std::uint64_t stalls_borne);

enum class LateCause : std::uint8_t { kWakeUp, kDevice, kCompute };

using tgr::FaultReason;

/// Record of one tick: enough, with the scene, to play it again bit for bit.
struct GestureTick {
  enum Flag : std::uint32_t {
    kCatchUp = 1U << 0U,  ///< run after a stall, position interpolated, force muted
    kHeld = 1U << 1U,     ///< a position was missing or rejected and held
    /// Live audio entered the instrument: a replay from ports alone is not exact.
    kAudioInput = 1U << 2U,
    kNoForce = 1U << 3U,  ///< not engaged, stopped or at fault: no slice was given any force
  };
  std::int64_t tick = 0;
  std::uint32_t flags = 0;
  std::uint32_t slices = 0;
  std::array<double, tgr::kMaxSlices> position{};  ///< m, validated
  std::array<float, tgr::kMaxSlices> force{};      ///< N, as sent to the device after this tick
  std::uint32_t ports = 0;
  std::array<double, tgr::kMaxPorts> port{};  ///< m, in the model, as given to the instrument
};

/// Counters, latest value.
struct Counters {
  std::int64_t ticks = 0;
  std::int64_t late_wake_up = 0;
  std::int64_t late_device = 0;
  std::int64_t late_compute = 0;
  std::int64_t stalls = 0;
  std::int64_t catch_up_ticks = 0;
  std::int64_t lost_ticks = 0;  ///< beyond max_stall: counted in the tick index, never run
  std::int64_t underruns = 0;
  std::int64_t underrun_frames = 0;
  std::int64_t xruns = 0;
  std::int64_t bad_input_samples = 0;  ///< non-finite samples of audio inputs, replaced by 0
  std::int64_t dropped_records = 0;    ///< gesture ticks or events that found their ring full
  double late_worst_s = 0.0;           ///< latest wake-up
  double peak_force_n = 0.0;
  double peak_raw_force_n = 0.0;   ///< peak of the model's forces since the last `recover`
  double port_energy_min_j = 0.0;  ///< least of any slice; below 0: so much it gave out
  std::int64_t clamped_ticks =
      0;  ///< ticks in which the energy clamp cut a force, summed over slices
  std::int64_t muted_ticks =
      0;                   ///< ticks in which a constant sensor value muted force, summed likewise
  double load_mean = 0.0;  ///< compute time over tick period, smoothed over about a second
  double load_peak = 0.0;
};

/// State of the station for displays, published 30-60 times a second.
struct Snapshot {
  std::int64_t tick = 0;
  ForceState state = ForceState::kDisconnected;
  FaultReason fault = FaultReason::kNone;
  double stall_s = 0.0;            ///< Event::value of the fault, if it is kStall
  std::uint64_t stalls_borne = 0;  ///< Event::id of the fault, if it is kStall
  bool audio_running = false;
  bool clock_locked = false;
  Counters counters;
  std::array<double, tgr::kMaxSlices> slice_position{};  ///< m
  std::array<double, tgr::kMaxSlices> slice_velocity{};  ///< m/s
  std::array<double, tgr::kMaxSlices> slice_force{};     ///< N, as sent
  int slices = 0;
};

}  // namespace ergotic::station
