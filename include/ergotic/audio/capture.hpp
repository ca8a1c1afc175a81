// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "ergotic/audio/wav.hpp"

namespace ergotic::audio {

struct CaptureConfig {
  std::string path;  ///< path of the WAV file
  WavFormat format = WavFormat::kFloat;
  std::vector<std::string> ports;  ///< full names, `client:port`, a channel each
  std::string match;               ///< and all ports matching this regular expression, after these
  std::string server;              ///< empty: $JACK_DEFAULT_SERVER, else `default`
  std::string client = "capture";  ///< name of the recording client
  double wait_s = 10.0;            ///< timeout for server and ports
  double seconds = 0.0;            ///< duration; 0: until stopped
};

struct CaptureReport {
  std::int64_t frames = 0;            ///< in the file
  std::int64_t first_jack_frame = 0;  ///< JACK frame time of the first frame of the file
  double sample_rate_hz = 0.0;
  std::int64_t dropped = 0;  ///< frames that came and are not in the file: the disk was too slow
                             ///< (zeros instead), or JACK gave two blocks one frame time
  std::int64_t lost = 0;     ///< frames in cycles that JACK lost, zeros in the file
  std::int64_t xruns = 0;    ///< number by JACK's count
  std::string message;       ///< why it ended before its time, empty: it did not
};

/// Records JACK ports to a file, sample by sample: frame n of the file is what the ports held at
/// JACK frame time first_jack_frame + n, zeros where that is not known.
///
/// Ends after `seconds`, on `stop`, or when the server goes away or changes its period (message).
/// \param stop     may be set by a signal handler
/// \param started  called once, when the ports are connected, with the names of the channels
/// Realtime: no. Thread: one
/// \throws DeviceError if server or ports do not appear in time, Exception from the WAV file
CaptureReport capture(
    const CaptureConfig& config,
    const std::atomic<bool>& stop,
    const std::function<void(const std::vector<std::string>&)>& started = nullptr);

}  // namespace ergotic::audio
