// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>

#include <ergotic/Status.h>

#include "support/test.hpp"

namespace ergotic::test {

/// When a fault begins, from which on the time to the release of the force counts.
enum class Start {
  kTick,         ///< when the tick was due with which it is injected
  kRequest,      ///< just before somebody asks for it
  kLastMessage,  ///< just before the last one was sent
  kEnergy,       ///< when the tick was due by which too much energy had been given out
  kReach,        ///< when the tick was due that found the hand beyond the reach of the stick
};

/// One fault that is made on purpose while a hand is pushed, and what has to come of it.
struct FaultCase {
  std::string name;
  std::string kind;  ///< of InjectFault, or one of the others that `begin` knows
  std::int64_t ticks = 1;
  double amount = 0.0;
  std::uint8_t reason = Status::FAULT_NONE;  ///< that is latched
  Start start = Start::kTick;
  double limit_ms = 10.0;  ///< from the start to force below 1 % at the device
  std::string limit_says = "10 ms";
  double watchdog_ms = 10.0;  ///< of the device: its default, unless it would hide what is tested
};

inline void PrintTo(const FaultCase& tested, std::ostream* out) {
  *out << tested.name;
}

constexpr std::int64_t kLong = 400;  // ticks

inline std::vector<FaultCase> sensorCases() {
  return {
      {"sensor: not a number", "not_a_number", kLong, 0.0, Status::FAULT_BAD_POSITION},
      {"sensor: infinite", "infinite", kLong, 0.0, Status::FAULT_BAD_POSITION},
      {"sensor: jump of 20 mm", "jump", kLong, 0.02, Status::FAULT_JUMP},
      {"sensor: at its rail (0.2 m)", "rail", kLong, 0.2, Status::FAULT_BAD_POSITION},
      {"sensor: noise of 5 mm rms", "noise", kLong, 0.005, Status::FAULT_JUMP},
      {"sensor: frozen", "frozen", 2 * kLong, 0.0, Status::FAULT_FROZEN},
      {"1000 samples missing", "missing", 1000, 0.0, Status::FAULT_MISSING_SAMPLES},
      {"end-effector: beyond its workspace", "reach", 1, 0.0, Status::FAULT_WORKSPACE,
       Start::kReach},
  };
}

inline std::vector<FaultCase> machineCases() {
  return {
      // The device does not help: its watchdog waits for longer than the tick takes.
      {"tick 100 ms longer", "slow", 1, 0.1, Status::FAULT_WATCHDOG, Start::kTick, 30.0,
       "`watchdog` (20 ms) + a quarter + 5 ms", 2000.0},
      // Only the device can help. It says so as soon as the process goes on, before the station
      // has counted what it missed.
      {"process stopped for 2 s", "process_stopped", 1, 2.0, Status::FAULT_MADE_SAFE,
       Start::kRequest, 15.0, "watchdog of the device (10 ms) + 5 ms"},
      {"device: does not take forces", "write_fails", kLong, 0.0, Status::FAULT_WRITE_FAILED},
      {"device: unplugged", "unplugged", kLong, 0.0, Status::FAULT_DEVICE_LOST},
      {"program: a signal to end", "signal", 1, 0.0, Status::FAULT_MADE_SAFE, Start::kRequest},
  };
}

inline std::vector<FaultCase> modelCases() {
  return {
      {"model: not a number", "model_not_a_number", kLong, 0.0, Status::FAULT_MODEL_BLOW_UP},
      // 1, 2, 4... N on top of every slice: where there was nothing before, the sixth is the first
      // beyond 20 N. Only the fourteenth would be beyond 5000 N; to give out 0.3 J takes 15 mm.
      {"model: force doubles every tick", "model_blow_up", kLong, 0.0, Status::FAULT_MODEL_BLOW_UP},
      {"model: -10 kN/m, and the hand moves", "model_active", 2 * kLong, 0.0, Status::FAULT_ENERGY,
       Start::kEnergy},
  };
}

inline std::vector<FaultCase> operatorCases() {
  return {
      {"operator: emergency stop (service)", "emergency_service", 1, 0.0,
       Status::FAULT_EMERGENCY_STOP, Start::kRequest},
      {"operator: emergency stop (topic)", "emergency_topic", 1, 0.0, Status::FAULT_EMERGENCY_STOP,
       Start::kRequest},
      {"presence switch released", "presence_released", 1, 0.0, Status::FAULT_PRESENCE,
       Start::kRequest},
      {"presence switch falls silent", "presence_silent", 1, 0.0, Status::FAULT_PRESENCE,
       Start::kLastMessage, 210.0, "its timeout (200 ms) + 10 ms"},
  };
}

/// In the order of the table.
inline std::vector<FaultCase> faultCases() {
  std::vector<FaultCase> all;
  for (const auto& cases : {sensorCases(), machineCases(), modelCases(), operatorCases()}) {
    all.insert(all.end(), cases.begin(), cases.end());
  }
  return all;
}

/// What a player should not even notice.
inline std::vector<FaultCase> harmlessCases() {
  return {{"1 sample missing", "missing", 1},
          {"20 samples missing", "missing", 20},
          {"tick 50 us longer", "slow", 1, 50e-6},
          {"tick 1 ms longer", "slow", 1, 1e-3}};
}

}  // namespace ergotic::test
