// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/pen_filter.hpp"

#include <QTabletEvent>

namespace ergotic::panel {

/// Handles events of the pen. A pen that is lifted pushes nothing back: its handle is released.
bool PenFilter::eventFilter(QObject* /*watched*/, QEvent* event) {
  if (event->type() == QEvent::TabletRelease) {
    pressure_ = 0.0;
  } else if (event->type() == QEvent::TabletPress || event->type() == QEvent::TabletMove) {
    const double pressure = static_cast<QTabletEvent*>(event)->pressure();
    const double depth_m = kDepthM * (pressure - pressure_);
    pressure_ = pressure;
    if (depth_m != 0.0) {
      pushed_(depth_m);
    }
  }
  return false;
}

}  // namespace ergotic::panel
