// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QObject>
#include <functional>
#include <utility>

class QEvent;

namespace ergotic::panel {

/// An event filter that hears how hard the pen of a graphics tablet presses on a widget. The events
/// go on: Qt makes those of a mouse of them, as long as nobody accepts them. Thread: of the window
class PenFilter : public QObject {
 public:
  static constexpr double kDepthM = 0.02;  ///< by which the hardest press goes deeper than none

  /// \param pushed  is told by how much deeper the pen presses than before, m; below 0: less deep
  explicit PenFilter(std::function<void(double depth_m)> pushed) : pushed_(std::move(pushed)) {}

  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  std::function<void(double depth_m)> pushed_;
  double pressure_ = 0.0;  // 0...1
};

}  // namespace ergotic::panel
