// SPDX-License-Identifier: BSD-3-Clause
// What live tests ask of the clock, on machines whose host may take a processor away.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

namespace ergotic::test {

class ReferenceThreads;

/// Tries at something that has to happen by a limit of the wall clock.
///
/// A late event fails the test at once, unless the machine stood still between the start and the
/// limit, as threads saw that nothing in the test outranks. Such a try is excused: it proves
/// nothing, and at least three of five tries have to be on time, or nine of ten of what is measured
/// first and judged later. What the machine did after the limit
/// excuses nothing. A test that fails because of the machine is run again by ctest
/// (scripts/test), not in here. Thread: one
class Trials {
 public:
  enum class Verdict { kOnTime, kExcused, kLate };
  /// The longest stall between two times of CLOCK_MONOTONIC, ns.
  using Watch = std::function<std::int64_t(std::int64_t from_ns, std::int64_t to_ns)>;

  /// In times of CLOCK_MONOTONIC.
  struct Window {
    std::int64_t from_ns = 0;
    std::int64_t limit_ns = 0;
    std::int64_t stall_ns = 2'000'000;  ///< for how long the machine stands still to be an excuse
  };

  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  /// \param tries  of a loop with `goOn`
  explicit Trials(const ReferenceThreads& reference, int tries = 1);
  explicit Trials(Watch watch, int tries = 1);
  /// Prints how many tries were excused.
  ~Trials();
  Trials(const Trials&) = delete;
  Trials& operator=(const Trials&) = delete;

  /// Begins another try, until all were made or one was late. After the last of them, fails the
  /// test if less than three of five were on time.
  bool goOn();
  /// Begins another try, whatever came of those before.
  void next();
  /// Of this try; of several the worst counts. \param happened_ns  kNever if it did not
  Verdict judge(const Window& window, std::int64_t happened_ns, const std::string& what = "it");
  /// Whether something was as it should be until the limit.
  Verdict judgeThat(bool holds, const Window& window, const std::string& what = "it");
  /// Of all tries so far, made with `next`.
  void expectNineOfTen();

  int tries() const noexcept { return tries_; }  ///< that are over
  int onTime() const noexcept { return tries_ - excused_ - late_; }
  int excused() const noexcept { return excused_; }

 private:
  void close();
  void expectOnTime(double share);

  Watch watch_;
  int wanted_;
  Verdict verdict_ = Verdict::kOnTime;  // of the try that goes on
  bool trying_ = false;
  int tries_ = 0;
  int excused_ = 0;
  int late_ = 0;
};

}  // namespace ergotic::test
