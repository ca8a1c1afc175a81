// SPDX-License-Identifier: BSD-3-Clause
#include "integration/melody_player.hpp"

#include <smf.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <jack/midiport.h>

#include "ergotic/rt/clock.hpp"

namespace ergotic::test {
namespace {

using Song = std::unique_ptr<smf_t, decltype(&smf_delete)>;

Song requireSong(smf_t* song, const std::string& what) {
  if (song == nullptr) {
    throw std::runtime_error("libsmf: " + what + " failed");
  }
  return {song, smf_delete};
}

void addEvent(smf_track_t* track, int pulse, std::vector<std::uint8_t> bytes) {
  smf_event_t* const event =
      smf_event_new_from_pointer(bytes.data(), static_cast<int>(bytes.size()));
  if (event == nullptr) {
    throw std::runtime_error("libsmf refuses an event at pulse " + std::to_string(pulse));
  }
  smf_track_add_event_pulses(track, event, pulse);
}

jack_client_t* openClient(const std::string& name, const std::string& server) {
  const auto options = static_cast<jack_options_t>(JackNoStartServer | JackServerName);
  jack_client_t* const client = jack_client_open(name.c_str(), options, nullptr, server.c_str());
  if (client == nullptr) {
    throw std::runtime_error("no JACK server " + server + " for " + name);
  }
  return client;
}

void wire(jack_client_t* client, const std::string& from, const std::string& to) {
  if (jack_connect(client, from.c_str(), to.c_str()) != 0) {
    throw std::runtime_error("JACK does not connect " + from + " to " + to);
  }
}

}  // namespace

void MelodyWriter::add(int track, int pulse, std::vector<std::uint8_t> bytes) {
  tracks_[track].emplace(pulse, std::move(bytes));
}

void MelodyWriter::addNote(
    int track, int pulse, int length, std::uint8_t note, std::uint8_t velocity) {
  add(track, pulse, {0x90, note, velocity});
  add(track, pulse + length, {0x80, note, 64});
}

void MelodyWriter::addTempo(int pulse, std::uint32_t quarter_us) {
  const auto byte = [&](unsigned shift) {
    return static_cast<std::uint8_t>(quarter_us >> shift & 0xffU);
  };
  add(1, pulse, {0xff, 0x51, 3, byte(16), byte(8), byte(0)});
}

void MelodyWriter::save(const std::string& file) const {
  const Song song = requireSong(smf_new(), "a new song");
  if (smf_set_ppqn(song.get(), kPulses) != 0) {
    throw std::runtime_error("libsmf refuses the number of pulses");
  }
  for (const auto& [number, events] : tracks_) {
    smf_track_t* const track = smf_track_new();
    smf_add_track(song.get(), track);
    for (const auto& [pulse, bytes] : events) {
      addEvent(track, pulse, bytes);
    }
  }
  if (smf_save(song.get(), file.c_str()) != 0) {
    throw std::runtime_error("libsmf does not write " + file);
  }
}

std::vector<MelodyEvent> readMelody(const std::string& file) {
  const Song song = requireSong(smf_load(file.c_str()), "reading " + file);
  std::vector<MelodyEvent> melody;
  while (const smf_event_t* const event = smf_get_next_event(song.get())) {
    if (smf_event_is_metadata(event) == 0) {
      melody.push_back({event->time_seconds,
                        {event->midi_buffer, event->midi_buffer + event->midi_buffer_length}});
    }
  }
  return melody;
}

MelodyPlayer::MelodyPlayer(const std::string& name, const std::string& server)
    : client_(openClient(name, server)),
      port_(jack_port_register(client_, "out", JACK_DEFAULT_MIDI_TYPE, JackPortIsOutput, 0)) {
  jack_set_process_callback(
      client_,
      [](jack_nframes_t frames, void* self) {
        return static_cast<MelodyPlayer*>(self)->send(frames);
      },
      this);
  jack_activate(client_);
}

MelodyPlayer::~MelodyPlayer() {
  jack_client_close(client_);
}

void MelodyPlayer::connectTo(const std::string& port) const {
  wire(client_, jack_port_name(port_), port);
}

std::vector<std::int64_t> MelodyPlayer::play(const std::vector<MelodyEvent>& melody) {
  const double rate = jack_get_sample_rate(client_);
  const std::int64_t begin = jack_frame_time(client_) + std::llround(0.2 * rate);
  melody_ = melody;
  frames_.clear();
  for (const MelodyEvent& event : melody_) {
    frames_.push_back(begin + std::llround(event.time_s * rate));
  }
  sent_ns_.assign(frames_.size(), 0);
  next_ = 0;
  plays_.store(true, std::memory_order_release);
  return frames_;
}

std::int64_t MelodyPlayer::mostLateNs(std::int64_t from_ns, std::int64_t to_ns) const {
  std::int64_t most = 0;
  for (std::size_t i = 0; i < periods_.load(std::memory_order_acquire); ++i) {
    const bool is_inside = log_[i].time_ns > from_ns && log_[i].time_ns < to_ns;
    most = is_inside ? std::max(most, log_[i].late_ns) : most;
  }
  return most;
}

std::int64_t MelodyPlayer::logPeriod(std::int64_t first_frame) {
  constexpr std::int64_t kNsPerUs = 1000;
  const jack_time_t due_us = jack_frames_to_time(client_, static_cast<jack_nframes_t>(first_frame));
  const auto late_us = static_cast<std::int64_t>(jack_get_time() - due_us);
  const std::int64_t now_ns = rt::monotonicNs();
  if (const std::size_t period = periods_.load(std::memory_order_relaxed); period < log_.size()) {
    log_[period] = {now_ns, kNsPerUs * late_us};
    periods_.store(period + 1, std::memory_order_release);
  }
  return now_ns;
}

int MelodyPlayer::send(jack_nframes_t frames) {
  void* const buffer = jack_port_get_buffer(port_, frames);
  jack_midi_clear_buffer(buffer);
  const std::int64_t begin = jack_last_frame_time(client_);
  const std::int64_t now_ns = logPeriod(begin);
  if (!plays_.load(std::memory_order_acquire)) {
    return 0;
  }
  while (next_ < frames_.size() && frames_[next_] < begin + frames) {
    const std::vector<std::uint8_t>& bytes = melody_[next_].bytes;
    const std::int64_t offset = std::max<std::int64_t>(frames_[next_] - begin, 0);
    jack_midi_event_write(buffer, static_cast<jack_nframes_t>(offset), bytes.data(), bytes.size());
    sent_ns_[next_] = now_ns;
    ++next_;
  }
  if (next_ == frames_.size()) {
    plays_.store(false, std::memory_order_release);
  }
  return 0;
}

MelodyListener::MelodyListener(const std::string& server,
                               const std::vector<std::string>& ports,
                               double seconds)
    : client_(openClient("listener", server)) {
  const auto length = static_cast<std::size_t>(seconds * jack_get_sample_rate(client_));
  sound_.assign(ports.size(), std::vector<float>(length));
  for (std::size_t i = 0; i < ports.size(); ++i) {
    const std::string name = "in_" + std::to_string(i + 1);
    ports_.push_back(
        jack_port_register(client_, name.c_str(), JACK_DEFAULT_AUDIO_TYPE, JackPortIsInput, 0));
  }
  jack_set_process_callback(
      client_,
      [](jack_nframes_t frames, void* self) {
        return static_cast<MelodyListener*>(self)->hear(frames);
      },
      this);
  jack_activate(client_);
  for (std::size_t i = 0; i < ports.size(); ++i) {
    wire(client_, ports[i], jack_port_name(ports_[i]));
  }
}

MelodyListener::~MelodyListener() {
  jack_client_close(client_);
}

/// Frames that JACK leaves out stay silent.
int MelodyListener::hear(jack_nframes_t frames) {
  const std::int64_t now = jack_last_frame_time(client_);
  first_ = first_ < 0 ? now : first_;
  const std::int64_t at = now - first_;
  const auto end = static_cast<std::size_t>(at + frames);
  if (end > sound_.front().size()) {
    return 0;
  }
  for (std::size_t i = 0; i < ports_.size(); ++i) {
    const auto* const samples = static_cast<const float*>(jack_port_get_buffer(ports_[i], frames));
    std::copy_n(samples, frames, sound_[i].begin() + at);
  }
  heard_.store(static_cast<std::int64_t>(end), std::memory_order_release);
  return 0;
}

std::int64_t MelodyListener::firstLouder(std::size_t channel,
                                         float level,
                                         std::int64_t from,
                                         std::int64_t before) const {
  const std::int64_t end = std::min(before - first_, heard_.load(std::memory_order_acquire));
  for (std::int64_t i = std::max<std::int64_t>(from - first_, 0); i < end; ++i) {
    if (std::abs(sound_[channel][static_cast<std::size_t>(i)]) > level) {
      return first_ + i;
    }
  }
  return -1;
}

}  // namespace ergotic::test
