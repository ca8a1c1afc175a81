// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/audio/capture.hpp"

#include <cmath>
#include <memory>
#include <sstream>
#include <utility>

#include "audio/jack_session.hpp"
#include "audio/recorder.hpp"
#include "audio/semaphore.hpp"
#include "ergotic/audio/wav.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"

namespace ergotic::audio {

namespace {

constexpr std::int64_t kLookNs = 200'000'000;  // at servers and ports that are not there yet
constexpr int kLooksAlike = 5;
constexpr std::int64_t kDrainNs = 20'000'000;
constexpr double kRingSeconds = 4.0;

/// Looks for a server and the wanted ports until all are there.
class Search {
 public:
  Search(const CaptureConfig& config, std::shared_ptr<Semaphore> wake)
      : config_(config), wake_(std::move(wake)) {}

  /// \throws DeviceError saying what is missing still
  void run(const std::atomic<bool>& stop) {
    const std::int64_t end_ns = rt::monotonicNs() + std::llround(config_.wait_s * 1e9);
    while (!look()) {
      if (stop || rt::monotonicNs() >= end_ns) {
        std::ostringstream message;
        message << "nothing recorded, waited for up to " << config_.wait_s << " s: " << missing_;
        throw DeviceError(message.str());
      }
      wake_->waitFor(kLookNs);
    }
  }

  std::unique_ptr<JackSession> takeSession() { return std::move(session_); }
  const std::vector<std::string>& sources() const { return sources_; }

 private:
  bool look() {
    try {
      if (!session_ || session_->isLost()) {
        session_.reset();
        session_ = std::make_unique<JackSession>(config_.server, config_.client, wake_);
      }
    } catch (const DeviceError& error) {
      missing_ = error.what();
      return false;
    }
    return lookForPorts();
  }

  bool lookForPorts() {
    for (const std::string& port : config_.ports) {
      if (!session_->isSource(port)) {
        missing_ = "no port `" + port + "` that gives sound";
        return false;
      }
    }
    std::vector<std::string> found = config_.ports;
    if (!config_.match.empty()) {
      const std::vector<std::string> matching = session_->findSources(config_.match);
      found.insert(found.end(), matching.begin(), matching.end());
      // A client may be at registering its ports, on a busy machine for long: believe what all
      // looks of a second agree on.
      missing_ = "no stable set of ports matching `" + config_.match + "`";
      alike_ = found == sources_ ? alike_ + 1 : 1;
      sources_ = found;
      return !matching.empty() && alike_ >= kLooksAlike;
    }
    sources_ = found;
    return true;
  }

  const CaptureConfig& config_;
  std::shared_ptr<Semaphore> wake_;
  std::unique_ptr<JackSession> session_;
  std::vector<std::string> sources_;
  int alike_ = 0;  // looks that found these
  std::string missing_;
};

/// Records until the limit is reached. \return reason for an earlier end, empty: none
std::string record(JackSession& session,
                   const std::vector<std::string>& sources,
                   Semaphore& wake,
                   const std::atomic<bool>& stop,
                   Recorder& recorder,
                   WavWriter& file,
                   std::int64_t limit) {
  while (!stop && file.frames() < limit) {
    wake.waitFor(kDrainNs);
    recorder.drain(file, limit);
    if (session.isLost()) {
      return "the JACK server went away";
    }
    if (session.takeChange()) {
      return "the JACK server changed its period or freewheels";
    }
    for (std::size_t i = 0; i < sources.size(); ++i) {
      if (!session.isConnected(static_cast<int>(i))) {  // from here on there would be silence
        return "`" + sources[i] + "` went away";
      }
    }
  }
  return "";
}

}  // namespace

CaptureReport capture(const CaptureConfig& config,
                      const std::atomic<bool>& stop,
                      const std::function<void(const std::vector<std::string>&)>& started) {
  if (config.ports.empty() && config.match.empty()) {
    throw Exception("capture: no ports to record");
  }
  auto wake = std::make_shared<Semaphore>();
  Search search(config, wake);
  search.run(stop);
  const std::vector<std::string>& sources = search.sources();
  const auto channels = static_cast<int>(sources.size());

  CaptureReport report;
  std::unique_ptr<JackSession> found = search.takeSession();
  report.sample_rate_hz = found->sampleRate();
  Recorder recorder(channels, static_cast<std::size_t>(kRingSeconds * report.sample_rate_hz));
  WavWriter file(config.path, report.sample_rate_hz, channels, config.format);
  JackConfig ports;
  ports.inputs = channels;
  const std::unique_ptr<JackSession> session = std::move(found);  // ends before what it calls
  session->activate(ports, recorder);
  for (int i = 0; i < channels; ++i) {
    session->connectInput(i, sources[static_cast<std::size_t>(i)]);
  }
  session->resume();
  if (started) {
    started(sources);
  }
  const std::int64_t limit =
      config.seconds > 0.0 ? std::llround(config.seconds * report.sample_rate_hz) : INT64_MAX;
  report.message = record(*session, sources, *wake, stop, recorder, file, limit);
  session->pause();
  recorder.finish(file, limit);
  file.finish();
  report.frames = file.frames();
  report.first_jack_frame = recorder.firstFrame();
  report.dropped = recorder.droppedFrames();
  report.lost = recorder.lostFrames();
  report.xruns = session->takeXruns();
  return report;
}

}  // namespace ergotic::audio
