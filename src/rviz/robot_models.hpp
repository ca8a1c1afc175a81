// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace rviz {
class DisplayContext;
}  // namespace rviz

namespace ergotic::panel {

/// Lets all displays `RobotModel` of a window that are switched on read their URDF anew, from the
/// ROS master. Thread: of the window
void reloadRobotModels(rviz::DisplayContext& context);

}  // namespace ergotic::panel
