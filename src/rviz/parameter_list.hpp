// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QLabel>
#include <QScrollArea>
#include <QSlider>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <ergotic/Parameters.h>

#include "rviz/slider_scale.hpp"

namespace ergotic::panel {

/// Name, value, unit, range and slider of one parameter.
class ParameterRow : public QWidget {
 public:
  /// \param learn  is called when a MIDI controller shall move the parameter
  ParameterRow(const Parameters& parameters,
               std::size_t index,
               const std::function<void(const std::string&)>& learn,
               QWidget* parent);

  /// Takes the station's value; ignored while the player moves the slider.
  void follow(double value, double now_s);
  void toDefault();
  /// Value to be sent now, if any. \param now_s  of a clock that never goes back, s
  std::optional<double> take(double now_s);

  const std::string& name() const { return name_; }
  QSlider* slider() const { return slider_; }

 private:
  void offerToLearn(const std::function<void(const std::string&)>& learn);
  QWidget* makeSlider(const Parameters& parameters, std::size_t index);
  void show(double value);
  void set(double value);

  std::string name_;
  double default_;
  QString unit_;
  SliderScale scale_;
  Throttle throttle_;
  QLabel* value_;
  QSlider* slider_;
  bool follows_ = false;  // the slider is moved by us
  double moved_s_ = -1e9;
  bool was_moved_ = false;
};

/// List of the parameters of the scene that plays.
class ParameterList : public QScrollArea {
 public:
  /// \param learn  gets the name of a parameter that a MIDI controller shall move
  ParameterList(std::function<void(const std::string&)> learn, QWidget* parent);

  void follow(const Parameters& parameters, double now_s);
  void toDefaults();
  /// \param send  gets names and values to be sent now
  void send(const std::function<void(const std::string&, double)>& send, double now_s);
  /// The keyboard moves the first slider from now on.
  void takeFocus();

 private:
  bool isShown(const Parameters& parameters) const;
  void rebuild();

  std::function<void(const std::string&)> learn_;
  Parameters shown_;
  std::vector<ParameterRow*> rows_;
};

}  // namespace ergotic::panel
