// SPDX-License-Identifier: BSD-3-Clause
// What tests ask of the wall clock, on machines whose host may take a processor away.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

namespace ergotic::test {

class ReferenceThreads;

/// Tries at something that has to happen by a limit of the wall clock.
///
/// What is late and has no excuse fails the test at once. The one excuse is that the machine stood
/// still, as threads saw that nothing in the test outranks, between the start and the limit: what
/// comes after the limit excuses nothing, however late the event. What is excused proves nothing
/// and is tried again, until as many tries as are wanted were on time: a machine that stands still
/// more often makes a test longer, not weaker. (Of what is measured first and judged later, nine of
/// ten have to be on time.) The excuses are printed, and summed over all tests of a run, where more
/// than a third fails: threads that see stalls everywhere watch nothing
/// (test/support/sum_trials.py).
///
/// False alarms that are left. Events come 5 ms and more before their limits as a rule. Stalls too
/// short to be an excuse (`stall_ns`) make them late only where three of them meet in 10 ms: with
/// 0.6 ms and more once a second on each processor, as on a virtual machine of two under load, that
/// is once in 10^6 tries. And of what goes through ordinary threads, one may be kept waiting where
/// its reference is not: not once in 30 tries with twenty busy programs on two processors. Thread:
/// one
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

  static constexpr int kWanted = 3;
  static constexpr int kMost = 4;  ///< tries for each that is wanted; half of them excused, three
                                   ///< of twelve are missed once in 50 runs, a third once in 1,800
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  /// \param wanted  tries that have to be on time
  explicit Trials(const ReferenceThreads& reference, int wanted = kWanted);
  /// \param notes  file that gets a line of what came of it; none if empty
  Trials(Watch watch, std::string notes, int wanted = kWanted);
  /// Prints and notes what came of it.
  ~Trials();
  Trials(const Trials&) = delete;
  Trials& operator=(const Trials&) = delete;

  /// Begins another try if one is wanted. Fails the test if there were too many.
  bool goOn();
  /// Begins another try, whatever came of those before.
  void next();
  /// Of this try; of several the worst counts. \param happened_ns  kNever if it did not
  Verdict judge(const Window& window, std::int64_t happened_ns, const std::string& what = "it");
  /// Whether something was as it should be until the limit.
  Verdict judgeThat(bool holds, const Window& window, const std::string& what = "it");
  /// Of all tries so far.
  void expectNineOfTen();

  int onTime() const noexcept { return tries_ - excused_ - late_; }
  int excused() const noexcept { return excused_; }

 private:
  void close();

  Watch watch_;
  std::string notes_;
  int wanted_;
  Verdict verdict_ = Verdict::kOnTime;  // of the try that goes on
  bool trying_ = false;
  int tries_ = 0;
  int excused_ = 0;
  int late_ = 0;
};

}  // namespace ergotic::test
