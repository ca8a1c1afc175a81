// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "ergotic/rt/clock.hpp"
#include "support/test.hpp"

namespace ergotic::test {

/// What slice 0 of a device felt from here on. Time: CLOCK_MONOTONIC
struct ForceRecord {
  std::int64_t time_ns = 0;
  double force_n = 0.0;
};

/// The log of a `virtual_tgr`, which grows while it is read. Thread: one
class DeviceLog {
 public:
  explicit DeviceLog(std::filesystem::path path) : path_(std::move(path)) {}

  /// Every change of force since `forget`, up to some 10 ms ago.
  const std::vector<ForceRecord>& read() {
    std::ifstream file(path_);
    file.seekg(end_);
    std::string line;
    while (std::getline(file, line) && !file.eof()) {  // the last line may be half written
      end_ += static_cast<std::streamoff>(line.size()) + 1;
      take(line);
    }
    return records_;
  }

  /// All but the newest record, which still stands.
  void forget() {
    read();
    if (!records_.empty()) {
      records_.erase(records_.begin(), records_.end() - 1);
    }
  }

 private:
  void take(const std::string& line) {
    std::istringstream fields(line);
    ForceRecord record;
    int slice = -1;
    char comma = 0;
    fields >> record.time_ns >> comma >> slice >> comma >> record.force_n;
    if (fields && slice == 0) {  // not so the names of the columns
      records_.push_back(record);
    }
  }

  std::filesystem::path path_;
  std::streamoff end_ = 0;  // of what was read
  std::vector<ForceRecord> records_;
};

/// 0 before the first record.
inline double forceAt(const std::vector<ForceRecord>& forces, std::int64_t time_ns) {
  double force = 0.0;
  for (const ForceRecord& record : forces) {
    if (record.time_ns <= time_ns) {
      force = record.force_n;
    }
  }
  return force;
}

/// Whether a force has been felt for the last 100 ms, to a twentieth of it. One that rests is not
/// noted again.
inline bool isSteady(const std::vector<ForceRecord>& forces, double force_n) {
  constexpr std::int64_t kSteadyNs = 100'000'000;
  const std::int64_t from_ns = rt::monotonicNs() - kSteadyNs;
  const auto is_near = [=](double felt) {
    return std::abs(felt - force_n) < 0.05 * std::abs(force_n);
  };
  return is_near(forceAt(forces, from_ns)) &&
         std::all_of(forces.begin(), forces.end(), [&](const ForceRecord& at) {
           return at.time_ns < from_ns || is_near(at.force_n);
         });
}

}  // namespace ergotic::test
