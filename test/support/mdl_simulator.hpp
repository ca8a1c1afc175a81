// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "support/test.hpp"

namespace ergotic::test {

constexpr double kMdlSampleRate = 44100.0;  ///< Hz, of every `.mdl` model

/// Samples of some audio channels, [channels][frames].
using Channels = std::vector<std::vector<double>>;

inline double peakOf(const std::vector<double>& channel) {
  double peak = 0.0;
  for (const double x : channel) {
    peak = std::max(peak, std::abs(x));
  }
  return peak;
}

/// Plays a MIMS `.mdl` text (the newer language) in double precision at 44.1 kHz, one object per
/// element and none of the product's code: what the product's reader, compiler and kernels are
/// measured against.
///
/// Conventions, at sample n:
///   x[n] = A x[n-1] + B x[n-2] + (F[n-1] - g / 44100) / M, F[-1] = 0,
///   x[-1] = pos, x[-2] = pos - vel / 44100; a posInput is where its input is, pos before that;
///   then F[n] = sum of the link forces at x[n] and v[n] = x[n] - x[n-1], and of frcInputs.
///
/// \param params  values in place of those of the text's `param` lines; `faust_clip` asks for the
///                clipped laws of Faust's library in place of mi-gen's
/// \param inputs  [k-1] is heard by `@in<k>`; missing channels and frames are 0
/// \return [k-1] is what `@out<k>` gives
/// \throws std::runtime_error naming the line that is not understood
Channels simulateMdl(const std::string& text,
                     const std::map<std::string, double>& params,
                     const Channels& inputs,
                     std::size_t frames);

}  // namespace ergotic::test
