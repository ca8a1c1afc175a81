// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QPointer>
#include <QWidget>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Geometry>
#include <ros/ros.h>
#include <rviz/tool.h>

#include "rviz/framing.hpp"
#include "rviz/grab_geometry.hpp"
#include "rviz/grab_picture.hpp"
#include "rviz/key_rows.hpp"
#include "rviz/pen_filter.hpp"

class QKeyEvent;
namespace rviz {
class BoolProperty;
class EnumProperty;
class RenderPanel;
class StringProperty;
class ViewController;
class ViewportMouseEvent;
}  // namespace rviz

namespace ergotic::panel {

/// Plays the model with the mouse: what hands move can be taken, dragged and let go of, and so can
/// any module that moves by itself, which a hand of its own holds then. With nothing in hand the
/// mouse moves the camera as everywhere in rviz.
///
/// Left button: take and drag. Wheel, or the pressure of a tablet's pen: nearer, farther. Shift:
/// ten times finer. Right button, or letting go of the left: let go. Two rows of the computer's
/// keyboard play notes by the station's map of notes; Shift: harder, Page Up and Down: the octave,
/// Space: sustain pedal. A window that loses the focus lets go, and so does the station when it
/// does not hear of this tool for a second. Thread: of the window
class GrabTool : public rviz::Tool {
 public:
  GrabTool();
  ~GrabTool() override;

  void onInitialize() override;
  void activate() override;
  void deactivate() override;
  void update(float wall_dt, float ros_dt) override;
  int processMouseEvent(rviz::ViewportMouseEvent& event) override;

 private:
  void subscribe();
  struct View {
    Ray ray;
    Eigen::Vector3d looks;
  };
  /// Takes the time of mouse events, which rviz does not hand on, and the loss of the focus.
  bool eventFilter(QObject* watched, QEvent* event) override;

  bool playKey(const QKeyEvent& key, bool is_press);
  void sendNote(int note, int velocity);
  void endNotes(const std::vector<int>& notes);
  void tap(const Handle& handle, bool is_hard);

  std::optional<View> viewOf(const rviz::ViewportMouseEvent& event);
  /// Handle near the pointer, and its distance.
  struct Near {
    Handle handle;
    double pixels;
  };
  template <class Counts>
  std::optional<Near> nearest(const rviz::ViewportMouseEvent& event,
                              double pixels,
                              const Counts& counts) const;
  std::optional<Near> handleNear(const rviz::ViewportMouseEvent& event, double pixels) const;
  std::optional<Near> moduleNear(const rviz::ViewportMouseEvent& event, double pixels) const;
  std::optional<Near> playerNear(const rviz::ViewportMouseEvent& event) const;
  std::optional<Handle> under(const rviz::ViewportMouseEvent& event) const;
  void strike(rviz::ViewportMouseEvent& event);
  bool isClick(rviz::ViewportMouseEvent& event) const;
  void lookUnder(const rviz::ViewportMouseEvent& event);
  int hover(rviz::ViewportMouseEvent& event);
  int hold(rviz::ViewportMouseEvent& event);
  void push(double depth_m);
  void take(const Handle& handle, const View& view);
  void drop();   ///< releases the handle that is held
  void letGo();  ///< releases that handle and all keys
  void send();
  void draw();
  std::optional<Handle> asNow(const Handle& taken) const;
  std::optional<Handle> heldNow() const;
  bool mayBeClick() const;
  void frameModel();
  bool isFramed(rviz::ViewController& view, double aspect) const;
  Framing framingOf(const std::vector<Eigen::Vector3d>& places, Look& look);
  double markSize(const Eigen::Vector3d& place) const;
  std::int64_t nowOfEvents() const;

  rviz::StringProperty* station_;
  rviz::EnumProperty* grip_;
  rviz::BoolProperty* frames_;
  QPointer<QWidget> panel_;  // null once rviz has deleted it, which it does before its tools

  ros::NodeHandle node_;
  ros::Publisher targets_;
  ros::Publisher hold_targets_;
  ros::Publisher notes_;
  ros::Publisher taps_;
  ros::Subscriber structure_;
  ros::Subscriber handles_;
  ros::Subscriber state_;

  HandleSet set_;
  int version_ = 0;               // of the set that what is in hand, or under the pointer, is of
  int framed_ = 0;                // model that the camera was turned to
  double framed_aspect_ = 0.0;    // of the picture then
  double framed_distance_ = 0.0;  // m, of the camera
  std::optional<Look> chosen_;    // by the player, before a scene chose another one
  std::optional<Grab> grab_;
  KeyRows keys_;
  PenFilter pen_{[this](double depth_m) { push(depth_m); }};
  std::optional<Handle> hovered_;
  bool holds_ = false;  // the station was told of the module in hand
  std::unique_ptr<GrabPicture> picture_;
  Eigen::Isometry3d model_ = Eigen::Isometry3d::Identity();  // in the fixed frame

  int pressed_x_ = 0;  // where the left button went down, and when
  int pressed_y_ = 0;
  std::int64_t look_again_ns_ = 0;  // when the mouse moves
  std::int64_t pressed_ns_ = 0;
  std::int64_t event_ms_ = 0;       // of the latest mouse event, by the window system's clock
  std::int64_t event_wall_ns_ = 0;  // when it came
  std::int64_t sent_wall_ns_ = 0;
};

}  // namespace ergotic::panel
