// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/services.hpp"

#include <functional>
#include <utility>

#include <ros/callback_queue_interface.h>
#include <ros/console.h>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "files/printable.hpp"
#include "ros/device/end_effectors.hpp"
#include "ros/device/parameters.hpp"

namespace ergotic::node {
namespace {

constexpr std::uint32_t kRequestQueue = 100;
constexpr std::uint32_t kParameterQueue = 10'000;  // taken at once: the newest of each name counts
constexpr std::uint32_t kHandsQueue = 1000;
constexpr std::int64_t kHeldNs = 1'000'000'000;
constexpr std::int64_t kTapNs = 200'000'000;  // from a tap to its release
constexpr std::uint32_t kMaxIndices = 64;     // slices, or coordinates
const ::ros::WallDuration kMidiPeriod(0.001);
constexpr double kRefusalPeriodS = 1.0;
constexpr std::int64_t kComplaintPeriodNs = 1'000'000'000;

/// Counts the calls that are inside a function.
class Counted {
 public:
  explicit Counted(std::atomic<int>& count) : count_(count), number_(++count) {}
  ~Counted() { --count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  int number() const { return number_; }

 private:
  std::atomic<int>& count_;
  int number_;
};

/// Runs once, in the thread of a queue.
class QueuedCall : public ::ros::CallbackInterface {
 public:
  explicit QueuedCall(std::function<void()> call) : call_(std::move(call)) {}
  CallResult call() override {
    call_();
    return Success;
  }

 private:
  std::function<void()> call_;
};

template <class Response>
bool fill(Response& response, const Answer& answer) {
  response.success = answer.ok ? 1U : 0U;
  response.message = files::printableLines(answer.message);
  return true;  // the call itself went well, whatever came of it
}

void complain(const std::string& topic, const Answer& answer) {
  if (!answer.ok) {
    ROS_WARN_STREAM_THROTTLE(kRefusalPeriodS, topic << ": " << answer.message);
  }
}

/// Below JACK and the ticks, above everything ordinary.
int urgencyOf(const ::ros::NodeHandle& node) {
  constexpr int kUrgent = 40;
  const EarlyParameters early = readEarlyParameters(node);
  return early.realtime == Realtime::kOff ? 0 : std::min(kUrgent, early.priority - 1);
}

}  // namespace

Services::Services(const ::ros::NodeHandle& node, CommandThread& command_thread)
    : command_thread_(command_thread),
      description_(node),
      loader_(node, command_thread, description_),
      presets_(command_thread),
      queue_(*node.getCallbackQueue(), command_thread.interlock()),
      node_(node),
      loading_node_(node),
      loading_spinner_(1, &loading_queue_),
      hands_node_(node),
      safety_node_(node),
      safety_spinner_(safety_queue_, urgencyOf(node), [this] { followShutdown(); }),
      hands_spinner_(
          hands_queue_,
          std::max(urgencyOf(node) - 1, 0),
          [this] {
            playMidi();
            releaseNotes();
            command_thread_.expireHolds();
          },
          kMidiPeriod) {
  node_.setCallbackQueue(&queue_);
  loading_node_.setCallbackQueue(&loading_queue_);
  hands_node_.setCallbackQueue(&hands_queue_);
  safety_node_.setCallbackQueue(&safety_queue_);
  servers_ = {
      loading_node_.advertiseService("load_model", &Services::onLoadModel, this),
      loading_node_.advertiseService("reload", &Services::onReload, this),
      node_.advertiseService("engage", &Services::onEngage, this),
      node_.advertiseService("set_parameter", &Services::onSetParameter, this),
      node_.advertiseService("recover", &Services::onRecover, this),
      node_.advertiseService("configure_end_effectors", &Services::onConfigure, this),
      node_.advertiseService("calibrate", &Services::onCalibrate, this),
      node_.advertiseService("inject_fault", &Services::onInjectFault, this),
      node_.advertiseService("play_map", &Services::onPlayMap, this),
      node_.advertiseService("preset", &Services::onPreset, this),
      node_.advertiseService("take", &Services::onTake, this),
      node_.advertiseService("learn_controller", &Services::onLearnController, this),
      safety_node_.advertiseService("emergency_stop", &Services::onEmergencyStop, this),
      safety_node_.advertiseService("stop", &Services::onStop, this),
  };
  subscribers_ = {
      loading_node_.subscribe("model", 1, &Services::onModel, this),
      node_.subscribe("parameters", kParameterQueue, &Services::onParameter, this),
      hands_node_.subscribe("hand_targets", kHandsQueue, &Services::onHandTargets, this,
                            ::ros::TransportHints().tcpNoDelay()),
      hands_node_.subscribe("hold_targets", kHandsQueue, &Services::onHoldTarget, this,
                            ::ros::TransportHints().tcpNoDelay()),
      hands_node_.subscribe("notes", kHandsQueue, &Services::onNote, this,
                            ::ros::TransportHints().tcpNoDelay()),
      hands_node_.subscribe("taps", kHandsQueue, &Services::onTap, this,
                            ::ros::TransportHints().tcpNoDelay()),
      node_.subscribe("volume", 1, &Services::onVolume, this),
      node_.subscribe("end_effectors", 1, &Services::onEndEffectors, this),
      safety_node_.subscribe("emergency_stop", 1, &Services::onEmergencyTopic, this,
                             ::ros::TransportHints().tcpNoDelay()),
      safety_node_.subscribe("presence", kRequestQueue, &Services::onPresence, this,
                             ::ros::TransportHints().tcpNoDelay()),
  };
  constexpr bool kOnce = true;
  first_load_ = loading_node_.createWallTimer(
      ::ros::WallDuration(0.0), [this](const auto& /*event*/) { loader_.loadFromParameters(); },
      kOnce);
  loading_spinner_.start();
  if (readEarlyParameters(node).gamepads) {
    gamepads_ = std::make_unique<gamepads::GamepadWatch>(gamepadListener());
  }
}

Services::~Services() {
  loader_.giveUp();
  loading_spinner_.stop();  // after the load that runs, if one does
}

bool Services::onLoadModel(Call<LoadModel>& call) {
  const LoadModel::Request& request = call.getRequest();
  call.getResponse() = loader_.load(request.model, request.allow_unproven != 0U,
                                    call.getCallerName(), request.end_effectors);
  return true;
}

bool Services::onReload(Call<Trigger>& call) {
  return fill(call.getResponse(), loader_.reload(call.getCallerName()));
}

void Services::onModel(const ::ros::MessageEvent<const std_msgs::String>& model) {
  // It logs what goes wrong, and the status says it.
  loader_.load(model.getConstMessage()->data, false, model.getPublisherName());
}

bool Services::onEngage(Call<Trigger>& call) {
  return fill(call.getResponse(),
              command_thread_.engage({ArrivalQueue::ofThisCall(), call.getCallerName()}));
}

bool Services::onStop(Trigger::Request& /*request*/, Trigger::Response& response) {
  command_thread_.stop();
  return fill(response, {true, "force is zero until engage"});
}

bool Services::onSetParameter(SetParameter::Request& request, SetParameter::Response& response) {
  return fill(response, command_thread_.setParameter(request.name, request.value));
}

void Services::onParameter(const ParameterValue& parameter) {
  if (!command_thread_.setParameterSoon(parameter.name, parameter.value)) {
    complain("parameters", {false, "too many names at once: " + parameter.name});
  }
}

void Services::onHandTargets(const ::ros::MessageEvent<const HandTargets>& targets) {
  const std::string refusal =
      command_thread_.moveHands(*targets.getConstMessage(), targets.getPublisherName());
  complainAtTimes("hand_targets of " + targets.getPublisherName(), refusal);
}

/// Reports errors of messages that come by the hundred a second, at most one error a second.
void Services::complainAtTimes(const std::string& whose, const std::string& refusal) {
  const std::int64_t now_ns = rt::monotonicNs();
  if (!refusal.empty() && now_ns - complained_ns_ > kComplaintPeriodNs) {
    complained_ns_ = now_ns;
    const std::string text = whose + ": " + refusal;
    ROS_WARN_STREAM(files::printableLines(text));
    command_thread_.tell(files::printableLines(text));
  }
}

void Services::onHoldTarget(const ::ros::MessageEvent<const HoldTarget>& target) {
  const std::string refusal =
      command_thread_.hold(*target.getConstMessage(), target.getPublisherName());
  complainAtTimes("hold_targets of " + target.getPublisherName(), refusal);
}

void Services::onNote(const Note& note) {
  constexpr int kMax = 127;
  if (note.note > kMax || note.velocity > Note::HELD) {
    return complain("notes",
                    {false, "note " + std::to_string(note.note) + " at velocity " +
                                std::to_string(note.velocity) + ", allowed: 0...127 at 0...128"});
  }
  if (note.velocity == Note::HELD) {
    held_notes_[note.note] = rt::monotonicNs() + kHeldNs;
    return;
  }
  held_notes_.erase(note.note);
  command_thread_.playNote(note.note, note.velocity);
}

void Services::onTap(const Tap& tap) {
  constexpr int kMax = 127;
  if (tap.velocity < 1 || tap.velocity > kMax || tap.index >= kMaxIndices) {
    return complain("taps",
                    {false, "index " + std::to_string(tap.index) + " at velocity " +
                                std::to_string(tap.velocity) + ", allowed: below 64 at 1...127"});
  }
  const auto note =
      command_thread_.tap(tap.end_effector, static_cast<int>(tap.index), tap.velocity);
  if (note) {
    held_notes_[*note] = rt::monotonicNs() + kTapNs;
  }
}

/// Releases notes that are no longer reported as held, and those of taps.
void Services::releaseNotes() {
  const std::int64_t now_ns = rt::monotonicNs();
  for (auto held = held_notes_.begin(); held != held_notes_.end();) {
    if (now_ns > held->second) {
      command_thread_.playNote(held->first, 0);
      held = held_notes_.erase(held);
    } else {
      ++held;
    }
  }
}

void Services::onVolume(const std_msgs::Float64& volume) {
  complain("volume", command_thread_.setVolume(volume.data));
}

bool Services::onPlayMap(PlayMap::Request& request, PlayMap::Response& response) {
  const std::string refusal = request.map.empty() ? "" : command_thread_.usePlayMap(request.map);
  return fill(response, {refusal.empty(), refusal});
}

bool Services::onPreset(Preset::Request& request, Preset::Response& response) {
  response = presets_.serve(request);
  response.message = files::printableLines(response.message);
  return true;
}

bool Services::onTake(Take::Request& request, Take::Response& response) {
  response = command_thread_.take(request);
  response.message = files::printableLines(response.message);
  return true;
}

bool Services::onLearnController(LearnController::Request& request,
                                 LearnController::Response& response) {
  return fill(response, command_thread_.learnControl(request.parameter));
}

/// Programs are loaded where all models are: of several that come meanwhile, the last.
void Services::playMidi() {
  const auto program = command_thread_.playMidi();
  if (!program || program_.exchange(*program) != kNoProgram) {
    return;
  }
  const auto load = [this] { loader_.loadProgram(program_.exchange(kNoProgram)); };
  loading_queue_.addCallback(boost::make_shared<QueuedCall>(load));
}

/// Listener for gamepads. The names of gamepads are arbitrary texts of their makers.
gamepads::GamepadListener Services::gamepadListener() {
  return {[this](int pad, const tgr::GamepadMove& move) { command_thread_.playGamepad(pad, move); },
          [this](int pad) { command_thread_.unplugGamepad(pad); },
          [](const std::string& news) { ROS_INFO_STREAM(files::printableLines(news)); },
          [this](const std::string& why) {
            ROS_WARN_STREAM(files::printableLines(why));
            command_thread_.tell(files::printableLines(why));
          }};
}

bool Services::onRecover(Call<Trigger>& call) {
  const Answer answer = command_thread_.recover({ArrivalQueue::ofThisCall(), call.getCallerName()});
  if (answer.ok) {
    presence_owner_.acceptAnother(rt::monotonicNs());
  }
  return fill(call.getResponse(), answer);
}

/// Changes end-effectors; a second call meanwhile is refused, as waiting calls would block the
/// threads.
Answer Services::configure(const std::vector<EndEffector>& end_effectors) {
  const Counted counted(configurations_);
  if (counted.number() > 1) {
    return {false, "other end-effectors are being put in place: ask again after that"};
  }
  try {
    Answer answer = command_thread_.configure(fromMessages(end_effectors));
    if (answer.ok) {
      description_.update(command_thread_);
    }
    return answer;
  } catch (const Exception& refusal) {
    return {false, refusal.what()};
  }
}

bool Services::onConfigure(ConfigureEndEffectors::Request& request,
                           ConfigureEndEffectors::Response& response) {
  return fill(response, configure(request.end_effectors));
}

void Services::onEndEffectors(const EndEffectors& end_effectors) {
  complain("end_effectors", configure(end_effectors.end_effectors));
}

bool Services::onCalibrate(Calibrate::Request& request, Calibrate::Response& response) {
  response = command_thread_.calibrate(request, ArrivalQueue::ofThisCall());
  return true;
}

bool Services::onInjectFault(InjectFault::Request& request, InjectFault::Response& response) {
  return fill(response, command_thread_.inject(request));
}

bool Services::onEmergencyStop(Trigger::Request& /*request*/, Trigger::Response& response) {
  const bool latched = command_thread_.makeSafe(tgr::FaultReason::kEmergencyStop);
  return fill(response, {true, latched ? "force is latched at zero until recover"
                                       : "no device is open; none gets force before recover"});
}

void Services::onEmergencyTopic(const std_msgs::Empty& /*stop*/) {
  command_thread_.makeSafe(tgr::FaultReason::kEmergencyStop);
}

/// Makes the station safe when ROS shuts down (`rosnode kill`, a second node of this name). The
/// nodelet itself is destroyed much later, when nobody has found the station for half a second.
void Services::followShutdown() {
  if (::ros::isShuttingDown() && !std::exchange(is_shut_down_, true)) {
    command_thread_.makeSafe(tgr::FaultReason::kMadeSafe);
  }
}

void Services::onPresence(const ::ros::MessageEvent<const std_msgs::Bool>& present) {
  if (presence_owner_.hears(present.getPublisherName(), rt::monotonicNs())) {
    command_thread_.tellPresence(present.getMessage()->data != 0U);
    return;
  }
  ROS_WARN_STREAM_THROTTLE(kRefusalPeriodS,
                           "presence: " << present.getPublisherName() << " is not heard, for "
                                        << presence_owner_.name()
                                        << " holds the switch; when that is silent, recover "
                                           "accepts another");
}

}  // namespace ergotic::node
