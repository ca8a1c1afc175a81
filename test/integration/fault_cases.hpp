// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include <ergotic/Status.h>

namespace ergotic::test {

/// One fault that is made on purpose while a hand is pushed, and what has to come of it.
struct FaultCase {
  std::string name;
  std::string kind;  ///< of InjectFault, or one of the others that `begin` of the test knows
  std::int64_t ticks = 1;
  double amount = 0.0;
  std::vector<std::uint8_t> reasons;  ///< one of these is latched
  double limit_ms = 10.0;             ///< from the fault to force below 1 %, in ticks of the record
  std::string limit_says = "10 ms";
  bool stops_ticks = false;  ///< the record cannot tell how long it took
};

inline void PrintTo(const FaultCase& tested, std::ostream* out) {
  *out << tested.name;
}

inline std::vector<FaultCase> faultCases() {
  constexpr std::int64_t kLong = 400;
  return {
      {"sensor: not a number", "not_a_number", kLong, 0.0, {Status::FAULT_BAD_POSITION}},
      {"sensor: infinite", "infinite", kLong, 0.0, {Status::FAULT_BAD_POSITION}},
      {"sensor: jump of 20 mm", "jump", kLong, 0.02, {Status::FAULT_JUMP}},
      {"sensor: at its rail (0.2 m)", "rail", kLong, 0.2, {Status::FAULT_BAD_POSITION}},
      {"sensor: noise of 5 mm rms", "noise", kLong, 0.005, {Status::FAULT_JUMP}},
      {"sensor: frozen",
       "frozen",
       2 * kLong,
       0.0,
       {Status::FAULT_FROZEN},
       110.0,
       "`frozen` (100 ms) + 10 ms"},
      {"1000 samples missing", "missing", 1000, 0.0, {Status::FAULT_MISSING_SAMPLES}},
      {"tick 100 ms longer",
       "slow",
       1,
       0.1,
       {Status::FAULT_WATCHDOG},
       10.0,
       "`watchdog` (20 ms) + a quarter",
       true},
      {"process stopped for 2 s",
       "process_stopped",
       1,
       2.0,
       {Status::FAULT_STALL, Status::FAULT_WATCHDOG},
       10.0,
       "max_stall, once it goes on; before, only a watchdog of the device",
       true},
      {"device: does not take forces", "write_fails", kLong, 0.0, {Status::FAULT_WRITE_FAILED}},
      {"device: unplugged", "unplugged", kLong, 0.0, {Status::FAULT_DEVICE_LOST}},
      {"model: not a number", "model_not_a_number", kLong, 0.0, {Status::FAULT_MODEL_BLOW_UP}},
      {"model: force doubles every tick",
       "model_blow_up",
       kLong,
       0.0,
       {Status::FAULT_FORCE_TOO_HIGH, Status::FAULT_ENERGY, Status::FAULT_MODEL_BLOW_UP}},
      {"program: a signal to end", "signal", 1, 0.0, {Status::FAULT_MADE_SAFE}},
      {"operator: emergency stop (service)",
       "emergency_service",
       1,
       0.0,
       {Status::FAULT_EMERGENCY_STOP}},
      {"operator: emergency stop (topic)",
       "emergency_topic",
       1,
       0.0,
       {Status::FAULT_EMERGENCY_STOP}},
      {"presence switch released", "presence_released", 1, 0.0, {Status::FAULT_PRESENCE}},
      {"presence switch falls silent", "presence_silent", 1, 0.0, {Status::FAULT_PRESENCE}},
  };
}

/// What a player should not even notice.
inline std::vector<FaultCase> harmlessCases() {
  return {{"1 sample missing", "missing", 1, 0.0, {}},
          {"20 samples missing", "missing", 20, 0.0, {}},
          {"tick 50 us longer", "slow", 1, 50e-6, {}},
          {"tick 1 ms longer", "slow", 1, 1e-3, {}}};
}

}  // namespace ergotic::test
