// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "ergotic/rt/audio_processor.hpp"
#include "ergotic/rt/realtime.hpp"
#include "ergotic/rt/ring.hpp"

namespace ergotic::tgr {

struct StepMeterConfig {
  int channel = 0;    ///< number of the output with the step, and of the input with its answer
  double step = 0.1;  ///< full scale units
  double threshold = 1e-5;  ///< change of the answer that counts, units
  int latency_frames = 0;   ///< latency of converters in the output path
  int rest_frames = 4800;   ///< between steps, and how long an answer may take
};

/// Response to one step.
struct StepAnswer {
  std::int64_t frames = 0;  ///< frames from the step to the first changed sample of the answer
  bool answered = false;
  bool disturbed = false;  ///< `frames` is invalid: blocks were left out meanwhile, or the step
                           ///< before had no answer
};

/// Measures how many frames a step on an output needs to show on the input of the same number,
/// through whatever is in between: a cable, or a driver whose forces answer to positions. The other
/// outputs stay at zero.
///
/// Step n begins at frame n mod P of a block, so that it meets ticks of R frames at all of their
/// phases: a tick that starts with the step answers R frames after it, one that is nearly over one
/// frame after it.
class StepMeter final : public rt::AudioProcessor {
 public:
  explicit StepMeter(const StepMeterConfig& config) : config_(config) {}

  void audioStarted(double sample_rate_hz, std::uint32_t period_frames) override;
  void audioStopped() noexcept override {}
  ERGOTIC_REALTIME void process(const rt::Period& period) noexcept override;
  void xrun() noexcept override {}

  /// Thread: one, any
  bool poll(StepAnswer& answer) noexcept { return answers_.pop(answer); }

 private:
  void note(std::int64_t frames, bool answered) noexcept;

  StepMeterConfig config_;
  std::int64_t frame_ = 0;    // host frame of the block that comes next
  std::int64_t step_at_ = 0;  // of the last step, or of the next
  std::int64_t steps_ = 0;
  float level_ = 0.0F;
  float before_ = 0.0F;   // of the answer
  bool waiting_ = false;  // for an answer
  bool disturbed_ = false;
  bool is_first_ = true;   // block
  bool in_touch_ = false;  // the last step was answered
  rt::Ring<StepAnswer> answers_{1U << 10U};
};

/// Summary of many steps. With ticks of R frames in between, answers take from 1 to R frames more
/// than the round trip; without, all take the same time.
struct StepSummary {
  int answered = 0;
  int unanswered = 0;
  int disturbed = 0;
  std::int64_t fewest_frames = 0;
  std::int64_t most_frames = 0;
};
StepSummary summaryOf(const std::vector<StepAnswer>& answers);

}  // namespace ergotic::tgr
