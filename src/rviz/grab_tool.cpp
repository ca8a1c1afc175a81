// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/grab_tool.hpp"

#include <OgreCamera.h>
#include <OgreSceneManager.h>
#include <OgreViewport.h>

#include <QEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <ergotic/Note.h>
#include <ergotic/Tap.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/string_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/viewport_mouse_event.h>

#include "rviz/grips.hpp"

namespace ergotic::panel {
namespace {

constexpr double kNearPixels = 16.0;    // from the pointer to a handle that it takes
constexpr double kModulePixels = 10.0;  // to a module, where no handle is
constexpr double kHandlePixels = 4.0;   // by which a module has to be nearer than a handle
constexpr double kTapPixels = 90.0;   // from a click beside everything to a handle that it strikes
constexpr double kClickPixels = 4.0;  // that the pointer may move in a click
constexpr std::int64_t kClickNs = 400'000'000;
constexpr double kMarkPixels = 14.0;     // diameter of a handle's mark
constexpr double kFine = 0.1;            // of the way of the mouse, with Shift
constexpr double kDepthPerStep = 0.002;  // m per step of the wheel
constexpr int kWheelStep = 120;
constexpr int kVelocity = 80;  // of keys that know only on and off
constexpr int kHardVelocity = 120;
constexpr double kTimeoutS = 1.0;
constexpr std::int64_t kRepeatNs = 100'000'000;  // a hand that stands still is told so often
constexpr std::uint32_t kQueue = 100;

constexpr std::size_t kFirm = 1;  // of kGrips

constexpr std::uint32_t kSpaceBar = 65;  // scan code

/// \param lowest  the note of Z
QString helpWith(int lowest) {
  return QString(
             "Click what lights up under the mouse, or drag it. Wheel: nearer, farther. Shift: "
             "finer. Right button: let go. Keys from Z (C%1) and Q (C%2) on play notes; Page Up, "
             "Page Down: their octave, Space: sustain pedal.")
      .arg(lowest / 12 - 1)
      .arg(lowest / 12);
}

std::int64_t wallNs() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

Eigen::Vector3d toEigen(const Ogre::Vector3& v) {
  return Eigen::Vector3f(v.x, v.y, v.z).cast<double>();
}

Eigen::Quaterniond toEigen(const Ogre::Quaternion& q) {
  return Eigen::Quaternionf(q.w, q.x, q.y, q.z).cast<double>();
}

/// Projection of frame `model` to pixels of the picture.
class Screen {
 public:
  Screen(const rviz::ViewportMouseEvent& event, const Eigen::Isometry3d& model)
      : model_(model),
        to_screen_(event.viewport->getCamera()->getProjectionMatrix() *
                   event.viewport->getCamera()->getViewMatrix()),
        width_(event.viewport->getActualWidth()),
        height_(event.viewport->getActualHeight()),
        pointer_(event.x, event.y) {}

  /// Distance from the pointer, pixels; infinite for places behind the camera.
  double distanceTo(const Eigen::Vector3d& place) const {
    const auto seen = pixelOf(place);
    return seen ? (*seen - pointer_).norm() : std::numeric_limits<double>::infinity();
  }
  /// To the nearest of what is drawn of a handle.
  double distanceTo(const Handle& handle) const {
    const double to_place = distanceTo(handle.place());
    const auto begin = pixelOf(handle.place() + handle.axis[0]);
    const auto end = pixelOf(handle.place() + handle.axis[1]);
    return begin && end ? std::min(to_place, distanceToLine(pointer_, *begin, *end)) : to_place;
  }

 private:
  /// None for what is behind the camera.
  std::optional<Eigen::Vector2d> pixelOf(const Eigen::Vector3d& place) const {
    const Ogre::Vector4 at = to_screen_ * Ogre::Vector4(toOgre(model_ * place));
    if (!(at.w > 0.0F)) {
      return std::nullopt;
    }
    return Eigen::Vector2d(0.5 * (1.0 + static_cast<double>(at.x / at.w)) * width_,
                           0.5 * (1.0 - static_cast<double>(at.y / at.w)) * height_);
  }

  Eigen::Isometry3d model_;
  Ogre::Matrix4 to_screen_;
  double width_;
  double height_;
  Eigen::Vector2d pointer_;
};

}  // namespace

GrabTool::GrabTool() {
  shortcut_key_ = 'g';
  // Properties belong to the container, which deletes them.
  station_ = new rviz::StringProperty("Station", "/station", "Name of the station's node.",
                                      getPropertyContainer());
  grip_ = new rviz::EnumProperty("Grip", kGrips[kFirm].name,
                                 "How firmly the hand holds: stiffness and greatest force.",
                                 getPropertyContainer());
  for (std::size_t i = 0; i < kGrips.size(); ++i) {
    grip_->addOption(kGrips[i].name, static_cast<int>(i));
  }
  frames_ = new rviz::BoolProperty("Frame models", true,
                                   "Whether the camera is moved to show all of a model that begins "
                                   "to play.",
                                   getPropertyContainer());
}

GrabTool::~GrabTool() {
  letGo();
}

void GrabTool::onInitialize() {
  setName("Play");
  picture_ = std::make_unique<GrabPicture>(*context_->getSceneManager());
  connect(station_, &rviz::Property::changed, this, [this] { subscribe(); });
  subscribe();
}

void GrabTool::subscribe() {
  letGo();
  const std::string station = station_->getStdString();
  std::string error;
  if (!ros::names::validate(station, error) || station.empty() || station[0] == '~') {
    setStatus(QString("There is no station of that name: ") + error.c_str());
    return;
  }
  targets_ = node_.advertise<HandTargets>(station + "/hand_targets", kQueue);
  hold_targets_ = node_.advertise<HoldTarget>(station + "/hold_targets", kQueue);
  notes_ = node_.advertise<Note>(station + "/notes", kQueue);
  taps_ = node_.advertise<Tap>(station + "/taps", kQueue);
  const auto show = [this](const auto& message) { set_.show(message); };
  structure_ = node_.subscribe<ModelStructure>(
      station + "/model_structure", 1,
      [show](const ModelStructure::ConstPtr& message) { show(*message); });
  handles_ = node_.subscribe<Handles>(station + "/handles", 1,
                                      [show](const Handles::ConstPtr& message) { show(*message); });
  state_ = node_.subscribe<ModelState>(
      station + "/model_state", 1, [show](const ModelState::ConstPtr& message) { show(*message); });
}

void GrabTool::activate() {
  panel_ = context_->getViewManager()->getRenderPanel();
  panel_->installEventFilter(this);
  panel_->installEventFilter(&pen_);
  setStatus(helpWith(keys_.lowest()));
}

void GrabTool::deactivate() {
  letGo();
  hovered_.reset();
  picture_->hide();
  if (panel_) {
    panel_->removeEventFilter(this);
    panel_->removeEventFilter(&pen_);
  }
}

bool GrabTool::eventFilter(QObject* /*watched*/, QEvent* event) {
  switch (event->type()) {
    case QEvent::MouseMove:
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
      event_wall_ns_ = wallNs();
      event_ms_ = static_cast<std::int64_t>(static_cast<QMouseEvent*>(event)->timestamp());
      break;
    case QEvent::KeyPress:
    case QEvent::KeyRelease:
      return playKey(*static_cast<QKeyEvent*>(event), event->type() == QEvent::KeyPress);
    case QEvent::FocusOut:
    case QEvent::WindowDeactivate:
    case QEvent::Hide:
      letGo();
      break;
    default:
      break;
  }
  return false;
}

/// \return whether it is a key that plays, which then has no other effect: letters switch tools
bool GrabTool::playKey(const QKeyEvent& key, bool is_press) {
  const std::uint32_t code = key.nativeScanCode();
  const bool is_command = (key.modifiers() & (Qt::ControlModifier | Qt::AltModifier)) != 0;
  const bool is_pedal = code == kSpaceBar;
  const int octaves = (key.key() == Qt::Key_PageUp) - (key.key() == Qt::Key_PageDown);
  if ((!noteOfKey(code) && !is_pedal && octaves == 0) || (is_press && is_command)) {
    return false;
  }
  if (key.isAutoRepeat()) {
    return true;
  }
  if (is_pedal) {
    endNotes(keys_.setPedal(is_press));
  } else if (is_press && octaves != 0) {
    keys_.shift(octaves);
    setStatus(helpWith(keys_.lowest()));
  } else if (const auto note = is_press ? keys_.press(code) : keys_.release(code)) {
    const bool is_hard = (key.modifiers() & Qt::ShiftModifier) != 0;
    sendNote(*note, !is_press ? 0 : is_hard ? kHardVelocity : kVelocity);
  }
  return true;
}

void GrabTool::endNotes(const std::vector<int>& notes) {
  for (const int note : notes) {
    sendNote(note, 0);
  }
}

void GrabTool::sendNote(int note, int velocity) {
  Note message;
  message.note = static_cast<std::uint8_t>(note);
  message.velocity = static_cast<std::uint8_t>(velocity);
  notes_.publish(message);
}

/// Time by the clock of the window system, which stamps mouse events when they happen; rviz may
/// process them a frame later.
std::int64_t GrabTool::nowOfEvents() const {
  constexpr std::int64_t kNsPerMs = 1'000'000;
  return event_ms_ * kNsPerMs + (wallNs() - event_wall_ns_);
}

void GrabTool::update(float /*wall_dt*/, float /*ros_dt*/) {
  if (grab_ && (!heldNow() || set_.version() != version_)) {
    drop();  // another model plays
  }
  if (set_.version() != version_) {
    hovered_.reset();
    version_ = set_.version();
  }
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (!set_.frame().empty() &&
      context_->getFrameManager()->getTransform(set_.frame(), ros::Time(), position, orientation)) {
    model_.translation() = toEigen(position);
    model_.linear() = toEigen(orientation).toRotationMatrix();
    picture_->setFrame(position, orientation);
    const Ogre::Camera* const camera = context_->getViewManager()->getRenderPanel()->getCamera();
    picture_->setUp(model_.linear().inverse() * toEigen(camera->getDerivedUp()));
    frameModel();
  }
  if (wallNs() - sent_wall_ns_ > kRepeatNs) {
    sent_wall_ns_ = wallNs();
    for (const int note : keys_.down()) {
      sendNote(note, Note::HELD);
    }
    if (grab_) {
      send();
    }
  }
  draw();
}

/// Camera of the scene, or one from the player's direction that shows the whole model.
Framing GrabTool::framingOf(const std::vector<Eigen::Vector3d>& places, Look& look) {
  if (const std::vector<Eigen::Vector3d> camera = set_.camera(); !camera.empty()) {
    const Shot shot{model_ * camera[0], model_ * camera[1]};
    chosen_ = chosen_.value_or(look);
    look = lookOf(shot, look);
    return {shot.at, (shot.from - shot.at).norm()};
  }
  if (chosen_) {
    look.yaw = chosen_->yaw;
    look.pitch = chosen_->pitch;
    chosen_.reset();
  }
  std::vector<Eigen::Vector3d> in_frame;
  for (const Eigen::Vector3d& place : places) {
    in_frame.push_back(model_ * place);
  }
  return frame(in_frame, look);
}

/// A window that gets its size late, or another, frames its model anew, unless the player has gone
/// nearer or farther meanwhile.
bool GrabTool::isFramed(rviz::ViewController& view, double aspect) const {
  constexpr double kAlike = 1e-3;
  const double distance = view.subProp("Distance")->getValue().toDouble();
  const bool is_moved = std::abs(distance - framed_distance_) > kAlike * framed_distance_;
  const bool is_other = std::abs(aspect - framed_aspect_) > kAlike * aspect;
  return framed_ == set_.models() && (is_moved || !is_other);
}

/// Once for each model and shape of the window; only of the camera that orbits around a point,
/// which is rviz's usual one.
void GrabTool::frameModel() {
  rviz::ViewController* const view = context_->getViewManager()->getCurrent();
  if (!frames_->getBool() || view == nullptr || view->getClassId() != "rviz/Orbit") {
    return;
  }
  const Ogre::Camera* const camera = context_->getViewManager()->getRenderPanel()->getCamera();
  Look look;
  look.yaw = view->subProp("Yaw")->getValue().toDouble();
  look.pitch = view->subProp("Pitch")->getValue().toDouble();
  look.field_of_view = static_cast<double>(camera->getFOVy().valueRadians());
  look.aspect = static_cast<double>(camera->getAspectRatio());
  const std::vector<Eigen::Vector3d> places =
      isFramed(*view, look.aspect) ? std::vector<Eigen::Vector3d>() : set_.places();
  if (places.empty()) {
    return;
  }
  framed_ = set_.models();
  framed_aspect_ = look.aspect;
  const Framing framing = framingOf(places, look);
  view->subProp("Yaw")->setValue(look.yaw);
  view->subProp("Pitch")->setValue(look.pitch);
  rviz::Property* const focus = view->subProp("Focal Point");
  focus->subProp("X")->setValue(framing.focus.x());
  focus->subProp("Y")->setValue(framing.focus.y());
  focus->subProp("Z")->setValue(framing.focus.z());
  view->subProp("Distance")->setValue(framing.distance);
  framed_distance_ = framing.distance;
}

std::optional<GrabTool::View> GrabTool::viewOf(const rviz::ViewportMouseEvent& event) {
  const Ogre::Camera* const camera = event.viewport->getCamera();
  const float width = static_cast<float>(event.viewport->getActualWidth());
  const float height = static_cast<float>(event.viewport->getActualHeight());
  if (width <= 0.0F || height <= 0.0F) {
    return std::nullopt;
  }
  const Ogre::Ray ray = camera->getCameraToViewportRay(static_cast<float>(event.x) / width,
                                                       static_cast<float>(event.y) / height);
  const Eigen::Isometry3d to_model = model_.inverse();
  return View{{to_model * toEigen(ray.getOrigin()),
               (to_model.linear() * toEigen(ray.getDirection())).normalized()},
              to_model.linear() * toEigen(camera->getDerivedDirection())};
}

/// The nearest of the handles that count.
template <class Counts>
std::optional<GrabTool::Near> GrabTool::nearest(const rviz::ViewportMouseEvent& event,
                                                double pixels,
                                                const Counts& counts) const {
  const Screen screen(event, model_);
  std::optional<Near> nearest;
  for (const Handle& handle : set_.handles()) {
    const double distance = counts(handle) ? screen.distanceTo(handle) : pixels;
    if (distance < pixels) {
      pixels = distance;
      nearest = {handle, distance};
    }
  }
  return nearest;
}

std::optional<GrabTool::Near> GrabTool::handleNear(const rviz::ViewportMouseEvent& event,
                                                   double pixels) const {
  return nearest(event, pixels, [](const Handle& /*any*/) { return true; });
}

std::optional<GrabTool::Near> GrabTool::moduleNear(const rviz::ViewportMouseEvent& event,
                                                   double pixels) const {
  const Screen screen(event, model_);
  double least = pixels;
  std::optional<std::size_t> nearest;
  // What swings is caught where it is at rest, too.
  set_.forEachModule([&](std::size_t module, const Eigen::Vector3d& now, const auto& at_rest) {
    const double distance = std::min(screen.distanceTo(now), screen.distanceTo(at_rest));
    if (distance < least) {
      least = distance;
      nearest = module;
    }
  });
  return nearest ? std::optional<Near>({set_.moduleAt(*nearest), least}) : std::nullopt;
}

/// Handle or module that a press of the button takes; at about equal distances the handle.
std::optional<Handle> GrabTool::under(const rviz::ViewportMouseEvent& event) const {
  const auto handle = handleNear(event, kNearPixels);
  const auto module = moduleNear(event, kModulePixels);
  if (handle && (!module || handle->pixels < module->pixels + kHandlePixels)) {
    return handle->handle;
  }
  return module ? std::optional<Handle>(module->handle) : std::nullopt;
}

/// A hand that plays what is nearest to the pointer of all that hands play.
std::optional<GrabTool::Near> GrabTool::playerNear(const rviz::ViewportMouseEvent& event) const {
  const Screen screen(event, model_);
  double least = kTapPixels;
  std::string nearest_name;
  set_.forEachModule([&](std::size_t module, const Eigen::Vector3d& now, const auto& /*at_rest*/) {
    const double distance = screen.distanceTo(now);
    if (distance < least && set_.isPlayed(module)) {
      least = distance;
      nearest_name = set_.moduleAt(module).name;
    }
  });
  return nearest(event, std::numeric_limits<double>::infinity(),
                 [&](const Handle& handle) { return handle.plays(nearest_name); });
}

/// Strikes by a click: with the hand under the pointer, or one that plays the string, bar or skin
/// there, as these have no handles of their own in their middle; else with the nearest hand.
void GrabTool::strike(rviz::ViewportMouseEvent& event) {
  const auto clicked = under(event);
  if (clicked && clicked->module < 0) {
    return tap(*clicked, event.shift());
  }
  const std::optional<Near> player = playerNear(event);
  if (const auto hand = player ? player : handleNear(event, kTapPixels)) {
    tap(hand->handle, event.shift());
  }
}

/// The left button comes up where and soon after it went down.
bool GrabTool::isClick(rviz::ViewportMouseEvent& event) const {
  return event.leftUp() && wallNs() - pressed_ns_ < kClickNs &&
         std::hypot(event.x - pressed_x_, event.y - pressed_y_) < kClickPixels;
}

void GrabTool::tap(const Handle& handle, bool is_hard) {
  const auto index =
      std::find_if(handle.indices.begin(), handle.indices.end(), [](int i) { return i >= 0; });
  if (index != handle.indices.end()) {
    Tap message;
    message.end_effector = handle.end_effector;
    message.index = static_cast<std::uint32_t>(*index);
    message.velocity = static_cast<std::uint8_t>(is_hard ? kHardVelocity : kVelocity);
    taps_.publish(message);
  }
}

int GrabTool::processMouseEvent(rviz::ViewportMouseEvent& event) {
  if (event.leftDown()) {
    pressed_x_ = event.x;
    pressed_y_ = event.y;
    pressed_ns_ = wallNs();
  }
  return grab_ ? hold(event) : hover(event);
}

/// Finds what a press would take. Among very many modules that takes a while, so while the mouse
/// only moves it is done for at most a fifth of the time.
void GrabTool::lookUnder(const rviz::ViewportMouseEvent& event) {
  constexpr int kPauses = 4;
  const bool moves = event.type == QEvent::MouseMove;
  if (moves && event.buttons_down != Qt::NoButton) {  // it turns the camera
    hovered_.reset();
    return;
  }
  const std::int64_t begun_ns = wallNs();
  if (moves && begun_ns < look_again_ns_) {
    if (hovered_ && Screen(event, model_).distanceTo(*hovered_) > kNearPixels) {
      hovered_.reset();
    }
    return;
  }
  hovered_ = under(event);
  const std::int64_t ended_ns = wallNs();
  look_again_ns_ = ended_ns + kPauses * (ended_ns - begun_ns);
}

int GrabTool::hover(rviz::ViewportMouseEvent& event) {
  lookUnder(event);
  const auto view = viewOf(event);
  if (hovered_ && event.leftDown() && view) {
    take(*hovered_, *view);
    return Render;
  }
  if (isClick(event)) {
    strike(event);
  }
  if (rviz::ViewController* const camera = event.panel->getViewController()) {
    camera->handleMouseEvent(event);
    setCursor(camera->getCursor());
  }
  if (hovered_) {  // the camera says what the mouse does where nothing lights up
    setStatus(helpWith(keys_.lowest()));
  }
  return Render;
}

void GrabTool::take(const Handle& handle, const View& view) {
  grab_.emplace(set_, handle, view.ray, view.looks);
  version_ = set_.version();
  holds_ = false;
  send();
}

/// The button went down so short a while ago that it may come up again as a click, which must not
/// mute what sounds.
bool GrabTool::mayBeClick() const {
  return wallNs() - pressed_ns_ < kClickNs &&
         (grab_->place() - grab_->handle().place()).norm() < markSize(grab_->place());
}

int GrabTool::hold(rviz::ViewportMouseEvent& event) {
  const auto view = viewOf(event);
  if (event.wheel_delta != 0) {
    grab_->drag().push(kDepthPerStep * event.wheel_delta / kWheelStep);
  } else if (view && event.type == QEvent::MouseMove) {
    grab_->drag().move(view->ray, event.shift() ? kFine : 1.0);
  }
  const bool lets_go = event.leftUp() || event.rightDown();
  if (!lets_go) {
    send();
    return Render;
  }
  const Handle handle = grab_->handle();
  drop();
  if (isClick(event) && handle.module < 0) {
    tap(handle, event.shift());
  } else if (isClick(event)) {
    strike(event);
  }
  return Render;
}

/// Pushes with a pen, which may press more without moving.
void GrabTool::push(double depth_m) {
  if (grab_) {
    grab_->drag().push(depth_m);
    send();
  }
}

void GrabTool::send() {
  const Grip& grip = kGrips[static_cast<std::size_t>(grip_->getOptionInt())];
  sent_wall_ns_ = wallNs();
  if (grab_->handle().module < 0) {
    HandTargets wanted = grab_->targets();
    wanted.header.stamp.fromNSec(
        static_cast<std::uint64_t>(std::max<std::int64_t>(nowOfEvents(), 1)));
    wanted.grip = grip.number;
    wanted.timeout = kTimeoutS;
    targets_.publish(wanted);
  } else if (holds_ || !mayBeClick()) {
    HoldTarget wanted = grab_->target();
    wanted.grip = grip.number;
    wanted.timeout = kTimeoutS;
    hold_targets_.publish(wanted);
    holds_ = true;
  }
}

void GrabTool::letGo() {
  endNotes(keys_.releaseAll());
  drop();
}

void GrabTool::drop() {
  if (!grab_) {
    return;
  }
  const bool is_module = grab_->handle().module >= 0;
  grab_.reset();
  if (is_module) {
    HoldTarget release;
    release.module = -1;
    release.release = 1U;
    hold_targets_.publish(release);
  } else {
    HandTargets release;
    release.release = 1U;
    targets_.publish(release);
  }
}

/// Present state of the handle that is held, or would be.
std::optional<Handle> GrabTool::asNow(const Handle& taken) const {
  if (taken.module >= 0) {
    const auto module = static_cast<std::size_t>(taken.module);
    return module < set_.modules() ? std::optional<Handle>(set_.moduleAt(module)) : std::nullopt;
  }
  for (const Handle& handle : set_.handles()) {
    if (handle.name == taken.name) {
      return handle;
    }
  }
  return std::nullopt;
}

std::optional<Handle> GrabTool::heldNow() const {
  return grab_ ? asNow(grab_->handle()) : std::nullopt;
}

/// Size of a mark, m, that gives about the same size on the screen everywhere.
double GrabTool::markSize(const Eigen::Vector3d& place) const {
  const Ogre::Camera* const camera = context_->getViewManager()->getRenderPanel()->getCamera();
  const double distance = (toEigen(camera->getDerivedPosition()) - model_ * place).norm();
  const double height = std::max(camera->getViewport()->getActualHeight(), 1);
  return kMarkPixels / height * 2.0 * distance *
         std::tan(0.5 * static_cast<double>(camera->getFOVy().valueRadians()));
}

void GrabTool::draw() {
  if (const auto held = heldNow()) {
    const Grip& grip = kGrips[static_cast<std::size_t>(grip_->getOptionInt())];
    const double newtons =
        pullOf(grip.stiffness, grip.most_n, grab_->stretchFrom(held->displacement));
    return picture_->showPull(held->place(), grab_->place(), newtons, newtons / grip.most_n,
                              markSize(held->place()));
  }
  if (const auto under = hovered_ ? asNow(*hovered_) : std::nullopt) {
    return picture_->showHover(under->place(), under->label(), markSize(under->place()));
  }
  picture_->hide();
}

}  // namespace ergotic::panel

#include <pluginlib/class_list_macros.hpp>
PLUGINLIB_EXPORT_CLASS(ergotic::panel::GrabTool, rviz::Tool)
