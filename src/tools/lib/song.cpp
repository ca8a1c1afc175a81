// SPDX-License-Identifier: BSD-3-Clause
#include "tools/lib/song.hpp"

#include <glib.h>  // before smf.h, which would read it as C
#include <smf.h>

#include <algorithm>
#include <memory>
#include <sstream>

#include "ergotic/exception.hpp"
#include "files/read_file.hpp"
#include "tools/lib/midi_check.hpp"

namespace ergotic::tools {
namespace {

constexpr std::size_t kMaxSongBytes = std::size_t{64} << 20U;
constexpr double kLongestSongS = 1e6;  // as --seconds

/// Keeps what libraries that log by GLib would write to the terminal.
class GlibLog {
 public:
  GlibLog() : before_(g_log_set_default_handler(&keep, &lines_)) {}
  ~GlibLog() { g_log_set_default_handler(before_, nullptr); }
  GlibLog(const GlibLog&) = delete;
  GlibLog& operator=(const GlibLog&) = delete;

  const std::vector<std::string>& lines() const { return lines_; }

 private:
  static void keep(const gchar* /*domain*/, GLogLevelFlags /*level*/, const gchar* text, void* to) {
    static_cast<std::vector<std::string>*>(to)->emplace_back(text);
  }
  std::vector<std::string> lines_;
  GLogFunc before_;
};

bool isOfAChannel(const smf_event_t& event) {
  constexpr unsigned char kFirst = 0x80;
  constexpr unsigned char kLast = 0xef;
  constexpr int kMaxBytes = 3;
  return event.midi_buffer_length >= 1 && event.midi_buffer_length <= kMaxBytes &&
         event.midi_buffer[0] >= kFirst && event.midi_buffer[0] <= kLast;
}

/// Events of all tracks, in order of time; at the same time in the order of the tracks. The next
/// event by libsmf is not always the earliest one.
std::vector<const smf_event_t*> eventsOf(const smf_t& song) {
  std::vector<const smf_event_t*> events;
  for (int t = 1; t <= song.number_of_tracks; ++t) {
    const smf_track_t* const track = smf_get_track_by_number(&song, t);
    for (int e = 1; e <= track->number_of_events; ++e) {
      events.push_back(smf_track_get_event_by_number(track, e));
    }
  }
  std::stable_sort(events.begin(), events.end(), [](const smf_event_t* a, const smf_event_t* b) {
    return a->time_pulses < b->time_pulses;
  });
  return events;
}

void addMessages(const smf_t& song, Song& read) {
  for (const smf_event_t* const event : eventsOf(song)) {
    if (!isOfAChannel(*event)) {
      continue;
    }
    Song::Message message;
    message.time_s = event->time_seconds;
    message.size = event->midi_buffer_length;
    std::copy_n(event->midi_buffer, message.size, message.bytes.begin());
    read.messages.push_back(message);
  }
}

}  // namespace

Song readSong(const std::string& file) {
  const std::string bytes = files::readFile(file, kMaxSongBytes);
  checkMidiFile(bytes, file);
  Song read;
  read.file = file;
  GlibLog log;
  const std::unique_ptr<smf_t, decltype(&smf_delete)> song(
      smf_load_from_memory(bytes.data(), static_cast<int>(bytes.size())), &smf_delete);
  if (!song) {
    throw Exception(file + ": error: libsmf does not read it" +
                    (log.lines().empty() ? "" : ": " + log.lines().back()));
  }
  addMessages(*song, read);
  for (const std::string& line : log.lines()) {
    read.warnings.push_back(file + ": warning: libsmf says: " + line);
  }
  if (read.messages.empty()) {
    throw Exception(file +
                    ": error: no message of a channel is in it, allowed: notes, or "
                    "controllers that the map names");
  }
  if (const double end_s = read.messages.back().time_s; !(end_s <= kLongestSongS)) {
    std::ostringstream text;
    text << file << ": error: its last message is at " << end_s << " s, allowed: 0...1e6 s";
    throw Exception(text.str());
  }
  return read;
}

}  // namespace ergotic::tools
