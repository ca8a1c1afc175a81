// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "ergotic/rt/audio_processor.hpp"

namespace ergotic::test {

/// An audio host without a sound card or a clock: the test says when a block happens.
class AudioHost {
 public:
  AudioHost(rt::AudioProcessor& processor, int outputs, int inputs, double rate_hz)
      : processor_(processor),
        outputs_(static_cast<std::size_t>(outputs)),
        inputs_(static_cast<std::size_t>(inputs)),
        rate_hz_(rate_hz) {}

  void start(std::uint32_t period, std::int64_t first_frame, std::int64_t time_ns) {
    period_ = period;
    next_ = first_frame;
    origin_frame_ = first_frame;
    origin_ns_ = time_ns;
    processor_.audioStarted(rate_hz_, period);
  }

  /// Exact time at which a host frame begins.
  std::int64_t timeOf(std::int64_t frame) const {
    return origin_ns_ + static_cast<std::int64_t>(
                            static_cast<double>(frame - origin_frame_) * 1e9 / rate_hz_ + 0.5);
  }

  /// One block of `input` on every input; returns output channel 0.
  std::vector<float> period(float input = 0.0F) {
    return period(std::vector<float>(period_, input));
  }
  std::vector<float> period(const std::vector<float>& input) {
    std::vector<std::vector<float>> out(outputs_, std::vector<float>(period_, -99.0F));
    std::vector<float*> out_pointers;
    for (auto& channel : out) {
      out_pointers.push_back(channel.data());
    }
    const std::vector<const float*> in_pointers(inputs_, input.data());
    rt::Period made;
    made.nframes = period_;
    made.start = {next_, timeOf(next_)};
    made.inputs = in_pointers.data();
    made.outputs = out_pointers.data();
    made.input_channels = static_cast<int>(inputs_);
    made.output_channels = static_cast<int>(outputs_);
    made.midi = midi_.data();
    made.midi_messages = static_cast<int>(midi_.size());
    processor_.process(made);
    midi_.clear();
    next_ += period_;
    last_ = std::move(out);
    return last_[0];
  }

  /// A MIDI message for the next block.
  void send(const rt::MidiMessage& message) { midi_.push_back(message); }

  /// The host's frame count goes on without a call, as after an xrun.
  void skip(std::int64_t frames) { next_ += frames; }

  std::int64_t nextFrame() const { return next_; }
  /// All output channels of the last block.
  const std::vector<std::vector<float>>& last() const { return last_; }

 private:
  std::vector<rt::MidiMessage> midi_;
  rt::AudioProcessor& processor_;
  std::size_t outputs_;
  std::size_t inputs_;
  double rate_hz_;
  std::uint32_t period_ = 0;
  std::int64_t next_ = 0;
  std::int64_t origin_frame_ = 0;
  std::int64_t origin_ns_ = 0;
  std::vector<std::vector<float>> last_;
};

}  // namespace ergotic::test
