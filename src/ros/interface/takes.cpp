// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/takes.hpp"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <utility>

#include <ros/console.h>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ros/device/hands.hpp"
#include "ros/interface/file_name.hpp"

namespace ergotic::node {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kPeriodNs = 200'000'000;
constexpr std::uint32_t kQueue = 1;
constexpr bool kLatched = true;

/// `2026-11-27_04-12-33_guitar` of `models/guitar.yaml`.
std::string nameNow(const std::string& instrument) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d_%H-%M-%S_", &local);
  return toFileName(text + fs::path(instrument).stem().string());
}

}  // namespace

Takes::Takes(const ::ros::NodeHandle& node, Publishers& publishers)
    : publishers_(publishers), folder_(homeFolder() + "/takes") {
  ::ros::NodeHandle handle(node);
  publisher_ = handle.advertise<ergotic::Takes>("takes", kQueue, kLatched);
  message_.folder = folder_.path();
  list();
  send();
}

Answer Takes::record(const std::string& name, const std::string& instrument) {
  try {
    const std::string wanted = name.empty() ? nameNow(instrument) : name;
    const std::string path = folder_.placeFor(wanted);
    endRecording();
    writer_ = std::make_shared<TakeWriter>(path);
    publishers_.record(writer_);
    path_ = path;
    message_.recording = wanted;
    message_.recorded = 0.0;
    send();
    return {true, "records " + path};
  } catch (const std::exception& refusal) {
    return {false, refusal.what()};
  }
}

void Takes::finish(const Promise& promise) {
  if (!writer_) {
    return answer(promise, false, "no take is recorded");
  }
  endRecording();
  endings_.back().promise = promise;
}

/// The one that is recorded, if there is one; the disk may take its time.
void Takes::endRecording() {
  if (!writer_) {
    return;
  }
  publishers_.record(nullptr);
  writer_->end();
  path_ = writer_->path();
  endings_.push_back({std::exchange(writer_, nullptr), nullptr});
  message_.recording.clear();
  send();
}

void Takes::replay(const std::string& name,
                   const station::AudioBridge* bridge,
                   double rate_hz,
                   double display_zoom,
                   const Promise& promise) {
  try {
    list();
    if (name.empty() && message_.names.empty()) {
      throw Exception("there is no take in " + folder_.path());
    }
    const std::string wanted = name.empty() ? message_.names.front() : name;
    const std::string path = folder_.find(wanted).path;
    if (bridge == nullptr || !bridge->status().running) {
      throw Exception(
          "there is no sound to play a take with, for no JACK server runs: `render --gesture` "
          "writes a take into a file");
    }
    if (player_ || !bridge->takes()->isSilent()) {
      throw Exception("a take is played already: halt it first");
    }
    path_ = path;
    player_ = std::make_unique<TakePlayer>(path_, bridge->takes(), rate_hz, display_zoom);
    begins_ = promise;
    message_.replaying = wanted;
    message_.replayed = message_.length = 0.0;
    send();
  } catch (const std::exception& refusal) {
    answer(promise, false, refusal.what());
  }
}

Answer Takes::halt() {
  if (!player_) {
    return {false, "no take is played"};
  }
  player_->halt();
  return {true, "the take ends"};
}

/// Renames, stars or deletes a take; refused for the take that plays, as it is still being read.
Answer Takes::change(const Take::Request& request) {
  const std::string& name = request.name;
  try {
    if (!name.empty() && name == message_.replaying) {
      throw Exception("take '" + name + "' is being played: halt it first");
    }
    std::string done;
    switch (request.action) {
      case Take::Request::RENAME:
        path_ = folder_.rename(name, request.new_name);
        done = "' is called '" + request.new_name + "' now";
        break;
      case Take::Request::DELETE:
        path_ = folder_.discard(name);
        done = "' is in the trash: " + path_;
        break;
      default:
        path_ = folder_.star(name, request.action == Take::Request::STAR);
        done = request.action == Take::Request::STAR ? "' is starred" : "' has no star";
        break;
    }
    list();
    send();
    return {true, "take '" + name + done};
  } catch (const std::exception& refusal) {
    return {false, refusal.what()};
  }
}

/// Reads the folder; details from the bags follow later.
void Takes::list() {
  message_.names.clear();
  message_.starred.clear();
  message_.dates.clear();
  message_.lengths.clear();
  message_.instruments.clear();
  for (const TakeFile& take : folder_.list()) {
    const TakeDetails details = index_.at(take).value_or(TakeDetails());
    message_.names.push_back(take.name);
    message_.starred.push_back(take.is_starred ? 1U : 0U);
    const std::int64_t date_ns = details.began_ns > 0 ? details.began_ns : take.written_ns;
    message_.dates.push_back(::ros::Time().fromNSec(static_cast<std::uint64_t>(date_ns)));
    message_.lengths.push_back(details.length_s);
    message_.instruments.push_back(details.instrument);
  }
}

void Takes::poll(const std::shared_ptr<Picture>& picture) {
  pollPlayer(picture);
  pollWriters();
  retired_.erase(std::remove_if(retired_.begin(), retired_.end(),
                                [](const std::unique_ptr<TakePlayer>& player) {
                                  return player->news().state == TakePlayer::State::kOver;
                                }),
                 retired_.end());
  if (index_.hasNews()) {
    list();
    send();
  }
  if ((player_ || writer_) && rt::monotonicNs() >= due_ns_) {
    send();
  }
}

void Takes::pollPlayer(const std::shared_ptr<Picture>& picture) {
  if (!player_) {
    return;
  }
  TakePlayer::News news = player_->news();
  message_.replayed = news.played_s;
  message_.length = news.length_s;
  if (news.picture) {
    begin(news);
  }
  if (const auto seen = player_->motion(); seen && shows_) {
    if (seen->picture) {
      publishers_.showPicture(seen->picture);
    }
    publishers_.showTake(seen->motion);
  }
  if (news.state == TakePlayer::State::kOver) {
    end(news, picture);
  }
}

void Takes::begin(const TakePlayer::News& news) {
  shows_ = true;
  publishers_.showPicture(news.picture);
  if (begins_) {
    answer(std::exchange(begins_, nullptr), true, "plays " + path_);
  }
}

void Takes::end(const TakePlayer::News& news, const std::shared_ptr<Picture>& picture) {
  player_.reset();
  if (begins_) {
    answer(std::exchange(begins_, nullptr), !news.failed, news.message);
  } else if (!news.message.empty()) {
    ROS_WARN_STREAM(news.message);
    publishers_.addMessage(news.message);
  }
  if (std::exchange(shows_, false)) {
    publishers_.showPicture(picture);
  }
  message_.replaying.clear();
  send();
}

/// Looks at the writers. A take that cannot be written to its end is ended at once; its error is
/// published if no caller waits for it.
void Takes::pollWriters() {
  if (writer_) {
    message_.recorded = writer_->seconds();
    if (!writer_->trouble().empty()) {
      endRecording();
    }
  }
  for (auto ending = endings_.begin(); ending != endings_.end();) {
    const std::optional<std::string> problem = ending->writer->outcome();
    if (!problem) {
      ++ending;
      continue;
    }
    list();
    send();
    if (ending->promise) {
      answer(ending->promise, problem->empty(),
             problem->empty() ? ending->writer->path() : *problem);
    } else if (!problem->empty()) {
      ROS_ERROR_STREAM(*problem);
      publishers_.addMessage(*problem);
    }
    ending = endings_.erase(ending);
  }
}

void Takes::close() {
  endRecording();
  endings_.clear();  // which waits until they are written
  begins_.reset();
  if (player_) {
    player_->halt();
    retired_.push_back(std::move(player_));
    message_.replaying.clear();
    shows_ = false;
    send();
  }
}

void Takes::send() {
  due_ns_ = rt::monotonicNs() + kPeriodNs;
  message_.header.stamp = ::ros::Time::now();
  publisher_.publish(message_);
}

}  // namespace ergotic::node
