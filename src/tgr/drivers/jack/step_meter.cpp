// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/jack/step_meter.hpp"

#include <algorithm>
#include <cmath>

namespace ergotic::tgr {

void StepMeter::audioStarted(double /*sample_rate_hz*/, std::uint32_t period_frames) {
  waiting_ = false;
  in_touch_ = false;
  is_first_ = true;
  level_ = 0.0F;
  config_.rest_frames =
      std::max(config_.rest_frames, config_.latency_frames + 4 * static_cast<int>(period_frames));
}

void StepMeter::process(const rt::Period& period) noexcept {
  for (int c = 0; c < period.output_channels; ++c) {
    std::fill_n(period.outputs[c], period.nframes, 0.0F);
  }
  const std::int64_t start = period.start.frames;
  if (is_first_) {
    step_at_ = start + config_.rest_frames;
    is_first_ = false;
  } else {
    disturbed_ = disturbed_ || start != frame_;
  }
  frame_ = start + period.nframes;
  const float* in = period.inputs[config_.channel];
  float* out = period.outputs[config_.channel];
  for (std::uint32_t i = 0; i < period.nframes; ++i) {
    const std::int64_t now = start + i;
    if (!waiting_ && now >= step_at_ && i == steps_ % period.nframes) {
      before_ = in[i];
      level_ = level_ == 0.0F ? static_cast<float>(config_.step) : 0.0F;
      step_at_ = now;
      waiting_ = true;
      disturbed_ = false;
      ++steps_;
    }
    const bool is_out = now - step_at_ >= config_.latency_frames || !waiting_;
    out[i] = is_out ? level_ : static_cast<float>(config_.step) - level_;
    const bool answered = std::abs(in[i] - before_) > static_cast<float>(config_.threshold);
    if (waiting_ && (answered || now - step_at_ >= config_.rest_frames)) {
      note(now - step_at_, answered);
      step_at_ = now + config_.rest_frames;
    }
  }
}

void StepMeter::note(std::int64_t frames, bool answered) noexcept {
  waiting_ = false;
  // Who does not poll does not want to know.
  answers_.push({frames, answered, answered && (disturbed_ || !in_touch_)});
  in_touch_ = answered;
}

StepSummary summaryOf(const std::vector<StepAnswer>& answers) {
  StepSummary summary;
  for (const StepAnswer& answer : answers) {
    if (answer.disturbed) {
      ++summary.disturbed;
    } else if (!answer.answered) {
      ++summary.unanswered;
    } else {
      const bool first = summary.answered++ == 0;
      summary.fewest_frames =
          first ? answer.frames : std::min(summary.fewest_frames, answer.frames);
      summary.most_frames = std::max(summary.most_frames, answer.frames);
    }
  }
  return summary;
}

}  // namespace ergotic::tgr
