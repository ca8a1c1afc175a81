// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/station_link.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <ctime>
#include <filesystem>
#include <mutex>
#include <sstream>
#include <thread>

#include <ergotic/Event.h>
#include <ergotic/Levels.h>
#include <ergotic/ParameterValue.h>
#include <ros/callback_queue.h>
#include <ros/master.h>
#include <ros/names.h>
#include <ros/param.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Empty.h>
#include <std_msgs/Float64.h>
#include <std_msgs/String.h>

#include "rviz/message_log.hpp"
#include "rviz/peak_hold.hpp"
#include "rviz/words.hpp"

namespace ergotic::panel {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kLastWait(1);
constexpr double kPatienceS = 6.0;  // the station itself gives up after 5 s
constexpr double kLoadingPatienceS = 180.0;
constexpr double kTurnS = 0.05;
constexpr std::chrono::seconds kLookPeriod(2);

std::string timeOfDay() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[16];
  std::strftime(text, sizeof text, "%H:%M:%S", &local);
  return text;
}

}  // namespace

/// State shared by the listening thread and the window.
struct StationLink::Shared {
  Shared(std::string name, std::string models_folder)
      : station(std::move(name)), models(std::move(models_folder)) {}

  const std::string station;
  const std::string models;
  ::ros::CallbackQueue queue;  // publishers speak to it when they end, too
  std::mutex mutex;            // of what follows
  std::condition_variable changed;
  News news;
  Clock::time_point heard;  // of the status
  bool was_heard = false;
  MessageLog log;
  ::ros::Publisher parameter;
  ::ros::Publisher volume;
  ::ros::Publisher emergency;
  std::function<void()> give_up_late;  // of the callers
  std::function<void()> prepare;       // their connections
  bool wants_sound = false;
  bool quit = false;
  bool has_ended = false;

  double ageS() const {
    return was_heard ? std::chrono::duration<double>(Clock::now() - heard).count() : -1.0;
  }
  void tell(const Answer& answer) {
    const std::lock_guard lock(mutex);
    if (!answer.ok) {  // else events tell of it
      log.add(timeOfDay(), answer.text);
    }
    show(answer);
  }
  void show(const Answer& answer) {
    news.answer = answer;
    ++news.answers;
  }
};

namespace {

/// Hears a station, in a thread of its own.
class Listener {
 public:
  explicit Listener(std::shared_ptr<StationLink::Shared> shared) : shared_(std::move(shared)) {}
  /// Releases all of ROS before the thread ends, as the process may end after that.
  ~Listener() {
    ::ros::Publisher parameter;
    ::ros::Publisher volume;
    ::ros::Publisher emergency;
    const std::lock_guard lock(shared_->mutex);
    std::swap(parameter, shared_->parameter);
    std::swap(volume, shared_->volume);
    std::swap(emergency, shared_->emergency);
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  void run() {
    std::string fault;
    if (!::ros::names::validate(shared_->station, fault)) {
      return shared_->tell({false, "This is no name of a station: " + fault});
    }
    connect();
    while (!hasToQuit()) {
      shared_->queue.callAvailable(::ros::WallDuration(kTurnS));
      watchSound();
      lookAround();
    }
  }

 private:
  bool hasToQuit() {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->give_up_late) {
      shared_->give_up_late();
    }
    return shared_->quit || !::ros::ok();
  }

  /// Waits for the master.
  void connect() {
    ::ros::NodeHandle node(shared_->station);
    node.setCallbackQueue(&shared_->queue);
    constexpr std::uint32_t kEvents = 1000;
    subscribers_.clear();
    sound_ = {};
    subscribers_ = {node.subscribe("status", 1, &Listener::onStatus, this),
                    node.subscribe("joint_states", 1, &Listener::onJoints, this),
                    node.subscribe("levels", 1, &Listener::onLevels, this),
                    node.subscribe("model_parameters", 1, &Listener::onParameters, this),
                    node.subscribe("takes", 1, &Listener::onTakes, this),
                    node.subscribe("presets", 1, &Listener::onPresets, this),
                    node.subscribe("robot_description", 1, &Listener::onDevice, this),
                    node.subscribe("events", kEvents, &Listener::onEvent, this)};
    constexpr std::uint32_t kParameters = 100;
    ::ros::Publisher parameter = node.advertise<ParameterValue>("parameters", kParameters);
    ::ros::Publisher volume = node.advertise<std_msgs::Float64>("volume", 1);
    ::ros::Publisher emergency = node.advertise<std_msgs::Empty>("emergency_stop", 1);
    ::ros::param::get("/run_id", master_);
    const std::lock_guard lock(
        shared_->mutex);  // opened before the old ones end, for which the master is asked
    std::swap(shared_->parameter, parameter);
    std::swap(shared_->volume, volume);
    std::swap(shared_->emergency, emergency);
  }

  void onStatus(const Status& status) {
    const std::lock_guard lock(shared_->mutex);
    addNews(shared_->news.status.message, status.message);
    is_another_ = is_another_ || shared_->ageS() < 0.0 || shared_->ageS() > kStaleAfterS ||
                  status.model != shared_->news.status.model;
    shared_->news.status = status;
    shared_->heard = Clock::now();
    shared_->was_heard = true;
  }

  /// Lines that were not there before.
  void addNews(const std::string& before, const std::string& now) {
    std::istringstream lines(now);
    for (std::string line; before != now && std::getline(lines, line);) {
      const bool is_known = ("\n" + before + "\n").find("\n" + line + "\n") != std::string::npos;
      if (!is_known &&
          line.find(": note: ") == std::string::npos) {  // notes are for who writes scenes
        shared_->log.add(timeOfDay(), line);
      }
    }
  }

  void onJoints(const sensor_msgs::JointState& joints) {
    const std::lock_guard lock(shared_->mutex);
    shared_->news.forces = joints.effort;
    const std::chrono::duration<double> now = Clock::now().time_since_epoch();
    shared_->news.peaks = peaks_.follow(joints.effort, now.count());
  }

  void onLevels(const Levels& levels) {
    const std::vector<double> now(levels.peaks.begin(), levels.peaks.end());
    const std::lock_guard lock(shared_->mutex);
    shared_->news.levels = now;
    const std::chrono::duration<double> time = Clock::now().time_since_epoch();
    shared_->news.level_peaks = level_peaks_.follow(now, time.count());
    shared_->news.volume = static_cast<double>(levels.volume);
    shared_->news.is_limited = levels.limited != 0U;
    shared_->news.hears_sound = true;
  }

  /// Subscribes to the sound if it is wanted; the station copies it only for subscribers.
  void watchSound() {
    bool is_wanted = false;
    {
      const std::lock_guard lock(shared_->mutex);
      is_wanted = shared_->wants_sound;
    }
    if (is_wanted == static_cast<bool>(sound_)) {
      return;
    }
    if (is_wanted) {
      ::ros::NodeHandle node(shared_->station);
      node.setCallbackQueue(&shared_->queue);
      sound_ = node.subscribe("scope", 1, &Listener::onSound, this);
    } else {
      sound_ = {};
      onSound(nullptr);
    }
  }

  void onSound(const Scope::ConstPtr& sound) {
    const std::lock_guard lock(shared_->mutex);
    shared_->news.sound = sound;
  }

  void onParameters(const Parameters& parameters) {
    const std::size_t count = parameters.names.size();
    if (parameters.values.size() != count || parameters.lows.size() != count ||
        parameters.highs.size() != count || parameters.defaults.size() != count ||
        parameters.units.size() != count) {
      return;  // of somebody else
    }
    const std::lock_guard lock(shared_->mutex);
    shared_->news.parameters = parameters;
    ++shared_->news.parameters_version;
  }

  void onTakes(const Takes& takes) {
    const std::lock_guard lock(shared_->mutex);
    shared_->news.takes = takes;
    ++shared_->news.takes_version;
  }

  void onPresets(const Presets& presets) {
    const std::lock_guard lock(shared_->mutex);
    shared_->news.presets = presets;
  }

  void onDevice(const std_msgs::String& device) {
    if (std::exchange(device_, device.data) != device.data) {
      const std::lock_guard lock(shared_->mutex);
      ++shared_->news.device_version;
    }
  }

  void onEvent(const Event& event) {
    if (isWorthALine(event)) {
      const std::lock_guard lock(shared_->mutex);
      shared_->log.add(timeOfDay(), event.text, kindOf(event));
    }
  }

  /// Now and then: a master that is gone or another, limits of another station, scenes in the
  /// folders.
  void lookAround() {
    if (std::exchange(is_another_, false)) {
      const double limit = ::ros::param::param(shared_->station + "/force_limit", 20.0);
      const std::lock_guard lock(shared_->mutex);
      shared_->news.force_limit = limit;
      if (shared_->prepare) {
        shared_->prepare();
      }
    }
    if (Clock::now() < next_look_) {
      return;
    }
    next_look_ = Clock::now() + kLookPeriod;
    lookForMaster();
    lookForScenes();
  }

  void lookForMaster() {
    bool is_silent = false;
    {
      const std::lock_guard lock(shared_->mutex);
      is_silent = shared_->ageS() < 0.0 || shared_->ageS() > kStaleAfterS;
    }
    const bool has_master = !is_silent || ::ros::master::check();
    std::string master = master_;
    if (is_silent && has_master && ::ros::param::get("/run_id", master) && master != master_) {
      connect();  // it knows nothing of us
    }
    const std::lock_guard lock(shared_->mutex);
    shared_->news.has_master = has_master;
  }

  void lookForScenes() {
    const std::vector<std::string> folders = modelFolders();
    const std::string seen = tracesOf(folders);
    if (seen == seen_) {
      return;
    }
    seen_ = seen;
    std::vector<SceneEntry> scenes = scenesIn(folders);
    const std::lock_guard lock(shared_->mutex);
    shared_->news.scenes = std::move(scenes);
    ++shared_->news.scenes_version;
  }

  /// Folders of the parameter `~models`, which is asked for once.
  const std::vector<std::string>& modelFolders() {
    if (folders_.empty() && !::ros::param::get("~models", folders_)) {
      folders_ = {::ros::param::param<std::string>("~models", shared_->models)};
    }
    return folders_;
  }

  /// Fingerprint of the folders: files and their times of modification.
  static std::string tracesOf(const std::vector<std::string>& folders) {
    std::vector<std::string> traces;
    for (const std::string& folder : folders) {
      std::error_code failure;
      for (const auto& file : std::filesystem::directory_iterator(folder, failure)) {
        const auto written = file.last_write_time(failure).time_since_epoch().count();
        traces.push_back(file.path().string() + " " + std::to_string(written));
      }
    }
    std::sort(traces.begin(), traces.end());
    std::string all = "\n";
    for (const std::string& trace : traces) {
      all += trace + "\n";
    }
    return all;
  }

  std::shared_ptr<StationLink::Shared> shared_;
  std::vector<::ros::Subscriber> subscribers_;
  ::ros::Subscriber sound_;  // void while it is not watched
  PeakHold peaks_;
  PeakHold level_peaks_;
  std::string device_;       // its URDF
  std::string master_;       // run id of the one that knows us
  bool is_another_ = false;  // station or model since its limits were asked for
  Clock::time_point next_look_;
  std::vector<std::string> folders_;
  std::string seen_;
};

void listen(const std::shared_ptr<StationLink::Shared>& shared) {
  try {
    Listener(shared).run();
  } catch (const std::exception& failure) {
    shared->tell({false, failure.what()});
  }
  const std::lock_guard lock(shared->mutex);
  shared->has_ended = true;
  shared->changed.notify_all();
}

}  // namespace

StationLink::StationLink(const std::string& station, const std::string& models)
    : shared_(std::make_shared<Shared>(station, models)) {
  for (std::unique_ptr<Caller>* caller :
       {&force_, &stop_, &emergency_, &loading_, &takes_, &presets_, &learning_}) {
    *caller = std::make_unique<Caller>(
        [shared = shared_](const Answer& answer) { shared->tell(answer); });
  }
  shared_->give_up_late = [this] {
    for (Caller* caller : {force_.get(), stop_.get(), emergency_.get(), loading_.get(),
                           takes_.get(), presets_.get(), learning_.get()}) {
      caller->giveUpLate();
    }
  };
  shared_->prepare = [this] {  // to take force away when the master is gone
    stop_->prepare<std_srvs::Trigger>(shared_->station + "/stop");
    emergency_->prepare<std_srvs::Trigger>(shared_->station + "/emergency_stop");
  };
  std::thread([shared = shared_] { listen(shared); }).detach();
}

StationLink::~StationLink() {
  std::unique_lock lock(shared_->mutex);
  shared_->quit = true;
  shared_->give_up_late = nullptr;
  shared_->prepare = nullptr;
  shared_->changed.wait_for(lock, kLastWait, [this] { return shared_->has_ended; });
}

const std::string& StationLink::station() const {
  return shared_->station;
}

void StationLink::refresh(News& news) const {
  const std::lock_guard lock(shared_->mutex);
  const News& newest = shared_->news;
  news.status = newest.status;
  news.age_s = shared_->ageS();
  news.has_master = newest.has_master;
  news.forces = newest.forces;
  news.peaks = newest.peaks;
  news.force_limit = newest.force_limit;
  news.levels = newest.levels;
  news.level_peaks = newest.level_peaks;
  news.volume = newest.volume;
  news.is_limited = newest.is_limited;
  news.hears_sound = newest.hears_sound;
  news.sound = newest.sound;
  news.answer = newest.answer;
  news.answers = newest.answers;
  news.presets = newest.presets;
  news.device_version = newest.device_version;
  if (news.parameters_version != newest.parameters_version) {
    news.parameters_version = newest.parameters_version;
    news.parameters = newest.parameters;
  }
  if (news.takes_version != newest.takes_version) {
    news.takes_version = newest.takes_version;
    news.takes = newest.takes;
  }
  if (news.scenes_version != newest.scenes_version) {
    news.scenes_version = newest.scenes_version;
    news.scenes = newest.scenes;
  }
  if (news.log_version != shared_->log.version()) {
    news.log_version = shared_->log.version();
    news.log = shared_->log.text();
  }
}

void StationLink::ask(Caller& caller, const char* what, const char* service, bool insists) {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->show({true, std::string(what) + " ..."});
  }
  caller.ask<std_srvs::Trigger>(what, shared_->station + service, {}, kPatienceS, insists);
}

void StationLink::engage() {
  ask(*force_, "Engage", "/engage");
}
void StationLink::recover() {
  ask(*force_, "Recover", "/recover");
}
void StationLink::stop() {
  force_->cancel();  // it must not come after the stop
  ask(*stop_, "Stop", "/stop", true);
}

void StationLink::emergencyStop() {
  force_->cancel();
  ::ros::Publisher emergency;
  {
    const std::lock_guard lock(shared_->mutex);
    emergency = shared_->emergency;
  }
  if (emergency) {
    emergency.publish(std_msgs::Empty());
  }
  ask(*emergency_, "Emergency stop", "/emergency_stop", true);
}

void StationLink::load(const std::string& model, const std::string& title) {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->show({true, "Loading " + title + " ..."});
  }
  LoadModel::Request request;
  request.model = model;
  request.end_effectors = "auto";  // an instrument brings what it is played with
  loading_->forgetWaiting();
  loading_->ask<LoadModel>("Load", shared_->station + "/load_model", request, kLoadingPatienceS);
}

void StationLink::reload() {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->show({true, "Reading the scene again ..."});
  }
  loading_->forgetWaiting();
  loading_->ask<std_srvs::Trigger>("Read again", shared_->station + "/reload", {},
                                   kLoadingPatienceS);
}

void StationLink::ask(const char* what, const Take::Request& request) {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->show({true, std::string(what) + " ..."});
  }
  takes_->ask<Take>(what, shared_->station + "/take", request, kLoadingPatienceS);
}

void StationLink::record() {
  Take::Request request;
  request.action = Take::Request::RECORD;
  ask("Record", request);
}

void StationLink::finishTake() {
  Take::Request request;
  request.action = Take::Request::FINISH;
  ask("Finish", request);
}

void StationLink::replay(const std::string& name) {
  Take::Request request;
  request.action = Take::Request::REPLAY;
  request.name = name;
  ask("Replay", request);
}

void StationLink::haltTake() {
  Take::Request request;
  request.action = Take::Request::HALT;
  ask("Halt", request);
}

void StationLink::changeTake(const char* what,
                             std::uint8_t action,
                             const std::string& name,
                             const std::string& new_name) {
  Take::Request request;
  request.action = action;
  request.name = name;
  request.new_name = new_name;
  ask(what, request);
}

void StationLink::preset(const char* what,
                         std::uint8_t action,
                         const std::string& name,
                         double seconds) {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->show({true, std::string(what) + " ..."});
  }
  Preset::Request request;
  request.action = action;
  request.name = name;
  request.seconds = seconds;
  presets_->ask<Preset>(what, shared_->station + "/preset", request, kPatienceS);
}

void StationLink::setParameter(const std::string& name, double value) {
  ::ros::Publisher parameter;
  {
    const std::lock_guard lock(shared_->mutex);
    parameter = shared_->parameter;
  }
  if (parameter) {
    ParameterValue message;
    message.name = name;
    message.value = value;
    parameter.publish(message);
  }
}

void StationLink::learnController(const std::string& parameter) {
  LearnController::Request request;
  request.parameter = parameter;
  learning_->ask<LearnController>("Learn", shared_->station + "/learn_controller", request,
                                  kPatienceS);
}

void StationLink::watchSound(bool is_wanted) {
  const std::lock_guard lock(shared_->mutex);
  shared_->wants_sound = is_wanted;
}

void StationLink::setVolume(double volume) {
  ::ros::Publisher publisher;
  {
    const std::lock_guard lock(shared_->mutex);
    publisher = shared_->volume;
  }
  if (publisher) {
    std_msgs::Float64 message;
    message.data = volume;
    publisher.publish(message);
  }
}

}  // namespace ergotic::panel
