// SPDX-License-Identifier: BSD-3-Clause
#include "support/trials.hpp"

#include <algorithm>
#include <iostream>
#include <utility>

#include <gtest/gtest.h>

#include "support/reference_threads.hpp"

namespace ergotic::test {
namespace {

double msOf(std::int64_t ns) {
  return 1e-6 * static_cast<double>(ns);
}

}  // namespace

Trials::Trials(const ReferenceThreads& reference, int tries)
    : Trials([&reference](std::int64_t from_ns,
                          std::int64_t to_ns) { return reference.longestStallNs(from_ns, to_ns); },
             tries) {}

Trials::Trials(Watch watch, int tries) : watch_(std::move(watch)), wanted_(tries) {}

Trials::~Trials() {
  close();
  if (excused_ > 0) {
    std::cout << excused_ << " of " << tries_ << " tries excused, as the machine stood still\n";
  }
}

void Trials::close() {
  tries_ += trying_ ? 1 : 0;
  excused_ += trying_ && verdict_ == Verdict::kExcused ? 1 : 0;
  late_ += trying_ && verdict_ == Verdict::kLate ? 1 : 0;
  trying_ = false;
  verdict_ = Verdict::kOnTime;
}

void Trials::next() {
  close();
  trying_ = true;
}

bool Trials::goOn() {
  close();
  if (late_ > 0) {
    return false;
  }
  if (tries_ == wanted_) {
    expectOnTime(0.6);
    return false;
  }
  trying_ = true;
  return true;
}

Trials::Verdict Trials::judge(const Window& window,
                              std::int64_t happened_ns,
                              const std::string& what) {
  if (happened_ns <= window.limit_ns) {
    return Verdict::kOnTime;
  }
  const std::int64_t stall_ns = watch_(window.from_ns, window.limit_ns);
  const Verdict verdict = stall_ns >= window.stall_ns ? Verdict::kExcused : Verdict::kLate;
  verdict_ = std::max(verdict_, verdict);
  if (verdict == Verdict::kLate) {
    ADD_FAILURE() << what
                  << (happened_ns == kNever
                          ? " was not so"
                          : " came after " + std::to_string(msOf(happened_ns - window.from_ns)) +
                                " ms")
                  << ", limit " << msOf(window.limit_ns - window.from_ns)
                  << " ms; the machine stood still for no more than " << msOf(stall_ns) << " ms";
  }
  return verdict;
}

Trials::Verdict Trials::judgeThat(bool holds, const Window& window, const std::string& what) {
  return judge(window, holds ? window.limit_ns : kNever, what);
}

void Trials::expectNineOfTen() {
  close();
  expectOnTime(0.9);
}

void Trials::expectOnTime(double share) {
  EXPECT_GE(onTime(), share * tries_) << "the machine stands still too often to be tested on";
}

}  // namespace ergotic::test
