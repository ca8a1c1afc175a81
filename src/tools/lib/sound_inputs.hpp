// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ergotic/scene/scene.hpp"

namespace ergotic::tools {

/// The sound files that feed the inputs of a scene; silence after their ends and elsewhere.
class SoundInputs {
 public:
  /// \param files  NAME=FILE, NAME an input of the scene, FILE a sound of one channel
  /// \throws Exception if there is no such input, or the file is not at this rate
  SoundInputs(const std::vector<std::string>& files, const scene::Scene& scene, double rate_hz);

  int channels() const noexcept { return static_cast<int>(sounds_.size()); }
  bool areSilent() const noexcept { return !any_; }  ///< whether there is no file at all
  /// Warnings about files with unexpected properties, in full sentences.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// Fills [nframes][channels] from frame `first` on. Realtime: yes
  template <class Sample>
  void read(std::int64_t first, int nframes, Sample* to) const noexcept {
    for (int i = 0; i < nframes; ++i) {
      for (const std::vector<double>& sound : sounds_) {
        const auto n = static_cast<std::size_t>(first + i);
        *to++ = n < sound.size() ? static_cast<Sample>(sound[n]) : Sample{0};
      }
    }
  }

 private:
  std::vector<std::vector<double>> sounds_;  // [channels][frames of the file]
  std::vector<std::string> warnings_;
  bool any_;
};

}  // namespace ergotic::tools
