// SPDX-License-Identifier: BSD-3-Clause
#include "support/reference_threads.hpp"

#include <sched.h>

#include <algorithm>
#include <iostream>

#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/thread.hpp"

namespace ergotic::test {
namespace {

bool isOurs(int cpu) {
  cpu_set_t allowed;
  return sched_getaffinity(0, sizeof(allowed), &allowed) == 0 && CPU_ISSET(cpu, &allowed);
}

void stayOn(int cpu) {
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(cpu, &only);
  if (sched_setaffinity(0, sizeof(only), &only) != 0) {
    std::cerr << "reference thread: not on processor " << cpu << '\n';
  }
}

void rise() {
  if (const rt::Outcome outcome = rt::makeRealtime(ReferenceThreads::kPriority); !outcome.ok) {
    std::cerr << "reference thread: " << outcome.message << '\n';
  }
}

}  // namespace

ReferenceThreads::ReferenceThreads(Rank rank, std::int64_t pause_ns)
    : rank_(rank), pause_ns_(pause_ns) {
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (isOurs(cpu)) {
      Processor& added = *processors_.emplace_back(std::make_unique<Processor>());
      added.number = cpu;
      added.ran_ns = rt::monotonicNs();
      added.thread = std::thread([this, &added] { run(added); });
    }
  }
}

ReferenceThreads::~ReferenceThreads() {
  stop_ = true;
  for (const auto& processor : processors_) {
    processor->thread.join();
  }
}

std::int64_t ReferenceThreads::longestStallNs(std::int64_t from_ns, std::int64_t to_ns) const {
  const std::lock_guard lock(mutex_);
  std::vector<Stall> all = stalls_;
  for (const auto& processor : processors_) {  // it may stand still at this moment
    all.push_back({processor->ran_ns, rt::monotonicNs()});
  }
  std::int64_t longest_ns = 0;
  for (const Stall& stall : all) {
    if (stall.to_ns - stall.from_ns >= pause_ns_ + kShortestNs) {
      longest_ns =
          std::max(longest_ns, std::min(stall.to_ns, to_ns) - std::max(stall.from_ns, from_ns));
    }
  }
  return longest_ns;
}

void ReferenceThreads::run(Processor& processor) {
  stayOn(processor.number);
  if (rank_ == Rank::kAboveAll) {
    rise();
  }
  processor.ran_ns = rt::monotonicNs();
  while (!stop_) {
    const std::int64_t last_ns = processor.ran_ns;
    rt::sleepUntilNs(last_ns + pause_ns_);
    const std::int64_t now_ns = rt::monotonicNs();
    if (now_ns - last_ns >= pause_ns_ + kShortestNs) {
      const std::lock_guard lock(mutex_);
      stalls_.push_back({last_ns, now_ns});
    }
    processor.ran_ns = now_ns;
  }
}

}  // namespace ergotic::test
