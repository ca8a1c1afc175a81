// SPDX-License-Identifier: BSD-3-Clause
#include "audio/jack_session.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <utility>

#include <jack/jack.h>
#include <jack/midiport.h>

#include "audio/frame_counter.hpp"
#include "audio/gate.hpp"
#include "audio/jack_latency.hpp"
#include "audio/jack_library.hpp"
#include "audio/jack_wires.hpp"
#include "audio/midi_sources.hpp"
#include "ergotic/exception.hpp"
#include "ergotic/rt/thread.hpp"

namespace ergotic::audio {

namespace {

constexpr std::int64_t kNsPerUs = 1000;
constexpr std::size_t kMidiMessages = 256;

[[noreturn]] void fail(const std::string& what) {
  const std::string reason = jack_library::takeMessage();
  throw DeviceError("JACK: " + what + (reason.empty() ? "" : ": " + reason));
}

/// Returns the given names, or numbered ones if there are none.
std::vector<std::string> portNames(const std::vector<std::string>& given,
                                   int count,
                                   const std::string& prefix) {
  std::vector<std::string> names = given;
  for (int i = 1; given.empty() && i <= count; ++i) {
    names.push_back(prefix + std::to_string(i));
  }
  return names;
}

}  // namespace

/// State that callbacks use. It outlives the session if libjack does not return from a close.
struct JackSession::Core {
  jack_client_t* client = nullptr;
  std::shared_ptr<Semaphore> wake;
  rt::AudioProcessor* processor = nullptr;
  std::vector<jack_port_t*> inputs, outputs;
  jack_port_t* midi_input = nullptr;  // null: none
  std::optional<MidiSources> midi_sources;
  std::uint32_t latency_frames = 0;
  std::optional<JackTerminal> terminal;
  std::vector<JackWires> wires;
  std::vector<jack_port_t*> wired_ports;

  // Written while the gate is closed, read inside it.
  std::vector<const float*> input_buffers;
  std::vector<float*> output_buffers;
  std::array<rt::MidiMessage, kMidiMessages> midi_messages{};
  std::int64_t clock_offset_ns = 0;
  FrameCounter counter;

  Gate gate;
  std::atomic<std::uint32_t> period{0};
  std::atomic<std::int64_t> last_period_ns{0};
  std::atomic<bool> has_ports{false};  // all of them; callbacks do not look at them before
  std::atomic<bool> lost{false};
  std::atomic<bool> changed{false};
  std::atomic<bool> freewheeling{false};
  std::atomic<std::int64_t> xruns{0};
  std::atomic<bool> wired{false};  // as of the last look

  void noteChange() noexcept {
    if (!changed.exchange(true)) {
      wake->post();
    }
  }

  void silence(jack_nframes_t nframes) noexcept {
    for (jack_port_t* port : outputs) {
      auto* buffer = static_cast<float*>(jack_port_get_buffer(port, nframes));
      std::fill_n(buffer, nframes, 0.0F);
    }
  }

  /// A wire that breaks shows here at once, one that is shared at the next look.
  bool wiresHold() const noexcept {
    const auto hold = [](jack_port_t* port) { return jack_port_connected(port) == 1; };
    return wires.empty() || (wired && std::all_of(wired_ports.begin(), wired_ports.end(), hold));
  }

  rt::FrameTime startOfCycle() noexcept {
    jack_nframes_t frame = 0;
    jack_time_t start_us = 0;
    jack_time_t next_us = 0;
    float period_us = 0.0F;
    if (jack_get_cycle_times(client, &frame, &start_us, &next_us, &period_us) != 0) {
      // The server's own loop has not settled yet.
      return {counter.extend(jack_last_frame_time(client)), rt::monotonicNs()};
    }
    return {counter.extend(frame),
            static_cast<std::int64_t>(start_us) * kNsPerUs - clock_offset_ns};
  }

  /// \return how many there are. Of more than `kMidiMessages` in a period the rest is lost.
  int readMidi(jack_nframes_t nframes) noexcept {
    if (midi_input == nullptr) {
      return 0;
    }
    void* const buffer = jack_port_get_buffer(midi_input, nframes);
    const std::uint32_t count = jack_midi_get_event_count(buffer);
    std::size_t read = 0;
    for (std::uint32_t i = 0; i < count && read < midi_messages.size(); ++i) {
      jack_midi_event_t event{};
      rt::MidiMessage& message = midi_messages[read];
      if (jack_midi_event_get(&event, buffer, i) == 0 && event.size >= 1 &&
          event.size <= message.bytes.size()) {
        message.offset = event.time;
        message.size = static_cast<std::uint8_t>(event.size);
        std::copy_n(event.buffer, event.size, message.bytes.begin());
        ++read;
      }
    }
    return static_cast<int>(read);
  }

  void processInside(jack_nframes_t nframes) noexcept {
    const rt::FlushDenormals flush;
    rt::Period now;
    now.nframes = nframes;
    now.start = startOfCycle();
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      input_buffers[i] = static_cast<const float*>(jack_port_get_buffer(inputs[i], nframes));
    }
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      output_buffers[i] = static_cast<float*>(jack_port_get_buffer(outputs[i], nframes));
    }
    now.inputs = input_buffers.data();
    now.outputs = output_buffers.data();
    now.input_channels = static_cast<int>(inputs.size());
    now.output_channels = static_cast<int>(outputs.size());
    now.midi = midi_messages.data();
    now.midi_messages = readMidi(nframes);
    now.wired = wiresHold();
    processor->process(now);
  }

  static int onProcess(jack_nframes_t nframes, void* self) {
    auto& core = *static_cast<Core*>(self);
    core.last_period_ns = rt::monotonicNs();
    if (!core.has_ports) {
      return 0;
    }
    if (!core.gate.enter()) {
      core.silence(nframes);
      return 0;
    }
    if (nframes == core.period && !core.freewheeling) {
      core.processInside(nframes);
    } else {
      core.silence(nframes);
      core.noteChange();
    }
    core.gate.leave();
    return 0;
  }

  static int onXrun(void* self) {
    auto& core = *static_cast<Core*>(self);
    ++core.xruns;
    if (core.gate.enter()) {
      core.processor->xrun();
      core.gate.leave();
    }
    return 0;
  }

  static int onBufferSize(jack_nframes_t nframes, void* self) {
    auto& core = *static_cast<Core*>(self);
    if (nframes != core.period) {
      core.noteChange();
    }
    return 0;
  }

  static void onFreewheel(int starting, void* self) {
    auto& core = *static_cast<Core*>(self);
    core.freewheeling = starting != 0;
    core.noteChange();
  }

  static void onConnect(jack_port_id_t, jack_port_id_t, int, void* self) {
    static_cast<Core*>(self)->wake->post();
  }

  static void onShutdown(void* self) {
    auto& core = *static_cast<Core*>(self);
    core.lost = true;
    core.wake->post();
  }

  /// Declares latencies. Signals at our inputs (outputs) are older (younger) by our latency at the
  /// other side; with a terminal they begin and end here.
  static void onLatency(jack_latency_callback_mode_t mode, void* self) {
    auto& core = *static_cast<Core*>(self);
    if (!core.has_ports) {
      return;
    }
    const bool capture = mode == JackCaptureLatency;
    jack_latency_range_t total{};
    if (core.terminal) {
      total = latencyOf(*core.terminal, mode, jack_get_buffer_size(core.client));
    } else {
      total = latencyOf(capture ? core.inputs : core.outputs, mode);
      total.min += core.latency_frames;
      total.max += core.latency_frames;
    }
    setLatency(capture ? core.outputs : core.inputs, mode, total);
  }

  jack_port_t* registerPort(const std::string& name,
                            unsigned long flags,
                            const char* type = JACK_DEFAULT_AUDIO_TYPE) {
    jack_port_t* port = jack_port_register(client, name.c_str(), type, flags, 0);
    if (port == nullptr) {
      fail("port " + name + " cannot be registered");
    }
    return port;
  }

  void addWires(const std::vector<jack_port_t*>& ports,
                const std::vector<std::string>& peers,
                bool into_us) {
    wires.emplace_back(client, ports, peers, into_us);
    wired_ports.insert(wired_ports.end(), ports.begin(), ports.end());
  }

  void registerPorts(const JackConfig& config) {
    const unsigned long end = config.terminal ? 0UL + JackPortIsTerminal : 0UL;
    for (const std::string& name : portNames(config.input_names, config.inputs, "in_")) {
      inputs.push_back(registerPort(name, JackPortIsInput | end));
    }
    for (const std::string& name : portNames(config.output_names, config.outputs, "out_")) {
      outputs.push_back(registerPort(name, JackPortIsOutput | end));
    }
    if (config.midi) {
      midi_input = registerPort("midi_in", JackPortIsInput, JACK_DEFAULT_MIDI_TYPE);
      midi_sources.emplace(config.midi_connect);
    }
    input_buffers.resize(inputs.size());
    output_buffers.resize(outputs.size());
    if (!config.input_peers.empty()) {
      addWires(inputs, config.input_peers, true);
    }
    if (!config.output_peers.empty()) {
      addWires(outputs, config.output_peers, false);
    }
    has_ports = true;
    jack_recompute_total_latencies(client);  // that callback did nothing until here
  }

  void setCallbacks(bool follows_wires) {
    const bool ok =
        jack_set_process_callback(client, onProcess, this) == 0 &&
        jack_set_xrun_callback(client, onXrun, this) == 0 &&
        jack_set_buffer_size_callback(client, onBufferSize, this) == 0 &&
        jack_set_freewheel_callback(client, onFreewheel, this) == 0 &&
        (jack_library::isOfPipeWire() || jack_set_latency_callback(client, onLatency, this) == 0);
    if (!ok || (follows_wires && jack_set_port_connect_callback(client, onConnect, this) != 0)) {
      fail("callbacks are refused");
    }
    jack_on_shutdown(client, onShutdown, this);
  }
};

JackSession::JackSession(const std::string& server,
                         const std::string& name,
                         std::shared_ptr<Semaphore> wake)
    : core_(std::make_shared<Core>()) {
  if (jack_library::isStuck()) {
    throw DeviceError("JACK: libjack has not come back from closing the last client; waiting");
  }
  core_->wake = std::move(wake);
  jack_library::silence();
  jack_library::takeMessage();
  jack_status_t status{};
  if (server.empty()) {
    core_->client = jack_client_open(name.c_str(), JackNoStartServer, &status);
  } else {
    const auto options = static_cast<jack_options_t>(JackNoStartServer | JackServerName);
    core_->client = jack_client_open(name.c_str(), options, &status, server.c_str());
  }
  if (core_->client == nullptr) {
    if ((status & JackServerFailed) != 0) {
      const std::string which = server.empty() ? "" : " `" + server + "`";
      throw DeviceError("no JACK server" + which + " is running; start one, e.g. with qjackctl");
    }
    fail("client `" + name + "` cannot be opened, status " + std::to_string(status));
  }
}

JackSession::~JackSession() {
  pause();
  jack_library::callPatiently([core = core_] { jack_client_close(core->client); });
}

/// Activates the client before its ports are visible. A server accepts connections to a client
/// before the client is in its graph: connected to one that is only about to be activated, a
/// synchronous server waits for it, for 20 s, and ignores its latencies.
void JackSession::activate(const JackConfig& config, rt::AudioProcessor& processor) {
  core_->processor = &processor;
  core_->latency_frames = config.latency_frames;
  core_->terminal = config.terminal;
  core_->period = jack_get_buffer_size(core_->client);  // activation reports it: not a change
  core_->setCallbacks(!config.input_peers.empty() || !config.output_peers.empty());
  if (jack_activate(core_->client) != 0) {
    fail("the client cannot be activated");
  }
  core_->registerPorts(config);
}

void JackSession::resume() {
  core_->clock_offset_ns = jack_library::clockOffsetNs();
  core_->changed = false;  // what changes from here on is noted again
  core_->period = jack_get_buffer_size(core_->client);
  core_->processor->audioStarted(sampleRate(), core_->period);
  core_->last_period_ns = rt::monotonicNs();
  flowing_ = true;
  core_->gate.open();
}

void JackSession::pause() noexcept {
  if (flowing_) {
    core_->gate.close();
    flowing_ = false;
    core_->processor->audioStopped();
  }
}

std::shared_ptr<const std::atomic<std::int64_t>> JackSession::lastPeriodNs() const {
  return {core_, &core_->last_period_ns};
}

bool JackSession::isLost() const noexcept {
  return core_->lost;
}
bool JackSession::isFreewheeling() const noexcept {
  return core_->freewheeling;
}
bool JackSession::takeChange() noexcept {
  return core_->changed.exchange(false);
}
std::int64_t JackSession::takeXruns() noexcept {
  return core_->xruns.exchange(0);
}

std::string JackSession::clientName() const {
  return jack_get_client_name(core_->client);
}
double JackSession::sampleRate() const noexcept {
  return jack_get_sample_rate(core_->client);
}
std::uint32_t JackSession::periodFrames() const noexcept {
  return core_->period;
}

std::vector<std::string> JackSession::findSources(const std::string& regex) const {
  return jackPorts(core_->client, regex.c_str(), JackPortIsOutput);
}

bool JackSession::isSource(const std::string& exact) const {
  const jack_port_t* port = jack_port_by_name(core_->client, exact.c_str());
  return port != nullptr && (jack_port_flags(port) & JackPortIsOutput) != 0;
}

bool JackSession::isConnected(int input) const {
  return jack_port_connected(core_->inputs[static_cast<std::size_t>(input)]) > 0;
}

void JackSession::connectInput(int input, const std::string& source) {
  const char* own = jack_port_name(core_->inputs[static_cast<std::size_t>(input)]);
  if (jack_connect(core_->client, source.c_str(), own) != 0) {
    fail(source + " cannot be connected to " + own);
  }
}

void JackSession::connectToPlayback() {
  const auto sinks = jackPorts(core_->client, nullptr, JackPortIsInput | JackPortIsPhysical);
  for (std::size_t i = 0; i < std::min(sinks.size(), core_->outputs.size()); ++i) {
    if (!ReservedSinks::has(sinks[i], i + 1) &&
        jack_connect(core_->client, jack_port_name(core_->outputs[i]), sinks[i].c_str()) != 0) {
      fail(std::string(jack_port_name(core_->outputs[i])) + " cannot be connected to " + sinks[i]);
    }
  }
}

void JackSession::connectMidi() {
  if (core_->midi_sources) {
    core_->midi_sources->connect(core_->client, core_->midi_input);
  }
}

void JackSession::mendWires() {
  bool mended = false;
  try {
    for (const JackWires& wires : core_->wires) {
      mended = wires.mend() || mended;
    }
  } catch (const DeviceError&) {
    core_->wired = false;
    throw;
  }
  if (mended) {
    jack_port_connected(core_->wired_ports.back());  // waits for the graph that has the wires
    jack_recompute_total_latencies(core_->client);
  }
  core_->wired = true;
}

bool JackSession::isWired() const noexcept {
  return core_->wired;
}
std::uint32_t JackSession::inputLatency() const noexcept {
  return latencyOf(core_->inputs, JackCaptureLatency).max;
}
std::uint32_t JackSession::outputLatency() const noexcept {
  return latencyOf(core_->outputs, JackPlaybackLatency).max;
}

}  // namespace ergotic::audio
