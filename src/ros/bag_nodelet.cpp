// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include "ros/interface/bag_show.hpp"

namespace ergotic::node {

/// `ergotic/BagShow`: a recording shown by the topics of a station.
class BagNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    const ::ros::NodeHandle& node = getPrivateNodeHandle();
    BagShow::Settings settings;
    node.getParam("bag", settings.bag);
    node.getParam("of", settings.station);
    node.getParam("tf_prefix", settings.tf_prefix);
    node.getParam("display_zoom", settings.display_zoom);
    node.getParam("loop", settings.loop);
    show_ = std::make_unique<BagShow>(node, settings);
  }

  std::unique_ptr<BagShow> show_;
};

}  // namespace ergotic::node

PLUGINLIB_EXPORT_CLASS(ergotic::node::BagNodelet, nodelet::Nodelet)
