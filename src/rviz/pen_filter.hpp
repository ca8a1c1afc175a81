// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QObject>
#include <functional>
#include <utility>

class QEvent;

namespace ergotic::panel {

/// An event filter that measures the pressure of a graphics tablet's pen on a widget. It passes the
/// events on: Qt makes mouse events of them, as long as they are not accepted. Thread: of the
/// window
class PenFilter : public QObject {
 public:
  static constexpr double kDepthM = 0.02;  ///< depth of full pressure below none

  /// \param pushed  gets the change of the pen's depth, m; below 0: less deep
  explicit PenFilter(std::function<void(double depth_m)> pushed) : pushed_(std::move(pushed)) {}

  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  std::function<void(double depth_m)> pushed_;
  double pressure_ = 0.0;  // 0...1
};

}  // namespace ergotic::panel
