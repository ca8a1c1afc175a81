// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <ergotic/Take.h>
#include <ergotic/Takes.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "ergotic/station/audio_bridge.hpp"
#include "ros/interface/answer.hpp"
#include "ros/interface/publishers.hpp"
#include "ros/interface/take_folder.hpp"
#include "ros/interface/take_index.hpp"
#include "ros/interface/take_player.hpp"
#include "ros/interface/take_writer.hpp"

namespace ergotic::node {

/// The takes below `$ROS_HOME/ergotic/takes`: one may be recorded, and one be played again.
/// Thread: command thread, all but the constructor
class Takes {
 public:
  Takes(const ::ros::NodeHandle& node, Publishers& feed);

  /// Records all messages from now on into a bag. The caller asks for a keyframe.
  /// \param name        empty: date, time and `instrument`
  /// \return an error, or the path
  Answer record(const std::string& name, const std::string& instrument);
  /// Ends the recording. The promise is fulfilled when the take is written: with its path, or an
  /// error.
  void finish(const Promise& promise);

  /// Replays a take. The promise is fulfilled when its sound begins.
  /// \param name    empty: the newest
  /// \param bridge  null: there is no sound
  /// \param rate_hz  frame rate of the sound
  void replay(const std::string& name,
              const station::AudioBridge* bridge,
              double rate_hz,
              double display_zoom,
              const Promise& promise);
  Answer halt();
  /// Renames, stars or discards a take: RENAME...DELETE of Take.srv.
  Answer change(const Take::Request& request);
  /// \return whether the picture is that of a take
  bool isShown() const { return shows_; }

  /// Brings what changed to ROS.
  /// \param picture  of the model that plays, shown again after a take
  void poll(const std::shared_ptr<Picture>& picture);
  /// Ends recording and replay, when nothing plays any more.
  void close();

  /// Path of the take that was recorded or requested last.
  const std::string& path() const { return path_; }

 private:
  struct Ending {
    std::shared_ptr<TakeWriter> writer;
    Promise promise;  // null: nobody waits
  };
  void begin(const TakePlayer::News& news);
  void end(const TakePlayer::News& news, const std::shared_ptr<Picture>& picture);
  void pollPlayer(const std::shared_ptr<Picture>& picture);
  void pollWriters();
  void endRecording();
  void list();
  void send();

  Publishers& publishers_;
  ::ros::Publisher publisher_;
  TakeFolder folder_;
  TakeIndex index_;
  ergotic::Takes message_;
  std::string path_;
  std::shared_ptr<TakeWriter> writer_;                // null: none is recorded
  std::vector<Ending> endings_;                       // takes that are written to their end
  std::unique_ptr<TakePlayer> player_;                // null: none is played
  std::vector<std::unique_ptr<TakePlayer>> retired_;  // that are about to end
  Promise begins_;                                    // of who asked for the one that is read
  bool shows_ = false;
  std::int64_t due_ns_ = 0;
};

}  // namespace ergotic::node
