// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/lib/feel.hpp"
#include "tools/lib/options.hpp"

namespace ergotic::tools {

/// Options of `render`.
struct RenderOptions {
  SceneOptions scene;
  CompileChoice compile;
  double seconds = 0.0;  ///< 0: 10, or the duration of the recording or the song
  std::string out;       ///< empty: nothing is kept
  std::string out_format = "float";
  double loudness = 0.0;            ///< LUFS; 0: the sound is not normalized
  double fade_s = 0.0;              ///< duration of the fade at its end
  std::vector<std::string> inputs;  ///< NAME=FILE
  std::string gesture;              ///< empty: no gesture
  std::string midi;                 ///< empty: no song plays
  std::string map;                  ///< map of the notes; empty: that of the scene
  std::string station;              ///< recorded station of a bag; empty: the only one
  std::string end_effectors;        ///< file; empty: ports move with their own slices
  std::string target;               ///< empty: the scene is played as it is
  FeelChoice feel;                  ///< in place of a sound
  bool energies = false;
  bool allow_unstable = false;
  bool allow_gaps = false;
};

void addOptions(CLI::App& app, RenderOptions& options);

/// Plays a scene offline into a file; a line of figures to stderr. Or says on stdout what a hand
/// feels at a slice. \return kSuccess, or kRefused if a recording has gaps \throws TextError,
/// Exception
int render(const RenderOptions& options);

}  // namespace ergotic::tools
