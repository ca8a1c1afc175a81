// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/robot_models.hpp"

#include <rviz/display_context.h>
#include <rviz/display_group.h>

namespace ergotic::panel {
namespace {

void reloadIn(rviz::DisplayGroup& group) {
  for (int i = 0; i < group.numDisplays(); ++i) {
    rviz::Display& display = *group.getDisplayAt(i);
    if (auto* const inner = dynamic_cast<rviz::DisplayGroup*>(&display)) {
      reloadIn(*inner);
    } else if (display.getClassId() == "rviz/RobotModel" && display.isEnabled()) {
      display.setEnabled(false);  // it reads when it is switched on, and then alone
      display.setEnabled(true);
    }
  }
}

}  // namespace

void reloadRobotModels(rviz::DisplayContext& context) {
  reloadIn(*context.getRootDisplayGroup());
}

}  // namespace ergotic::panel
