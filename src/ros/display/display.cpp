// SPDX-License-Identifier: BSD-3-Clause
#include "ros/display/display.hpp"

#include <utility>

namespace ergotic::node {
namespace {

constexpr std::uint32_t kQueue = 100;
constexpr std::uint32_t kMarkersQueue = 2;
constexpr bool kLatched = true;

}  // namespace

Display::Display(const ::ros::NodeHandle& node, const FrameNames& names)
    : node_(node),
      names_(names),
      model_structure_(node_.advertise<ModelStructure>("model_structure", 1, kLatched)),
      model_state_(node_.advertise<ModelState>("model_state", kQueue)),
      markers_(node_.advertise<visualization_msgs::MarkerArray>("markers", kMarkersQueue)),
      end_effector_shapes_(
          node_.advertise<visualization_msgs::MarkerArray>("end_effector_shapes", kMarkersQueue)),
      news_([this](News& news) { draw(news); }) {}

void Display::show(std::shared_ptr<Picture> picture) {
  news_.tell([&](News& news) {
    news.picture = std::move(picture);
    news.has_moved = false;  // that was another model
  });
}

void Display::show(const tgr::EndEffectors& end_effectors) {
  news_.tell([&](News& news) { news.end_effectors = end_effectors; });
}

bool Display::isWatched() const {
  return model_state_.getNumSubscribers() > 0 || markers_.getNumSubscribers() > 0 ||
         end_effector_shapes_.getNumSubscribers() > 0;
}

void Display::show(const station::MotionFrame& motion) {
  if (!isWatched()) {
    return;
  }
  news_.tell([&](News& news) {
    news.has_moved = true;
    news.motion.header.stamp = ::ros::Time::now();
    news.motion.header.frame_id = names_("model");
    news.motion.tick = motion.tick;
    news.motion.displacement = motion.displacement;
  });
}

void Display::draw(News& news) {
  if (news.picture) {
    begin(std::move(*news.picture));
  }
  if (news.end_effectors) {
    frames_ = EndEffectorFrames(*news.end_effectors, names_);
    erases_ = erases_shapes_ = true;  // those that are gone
  }
  if (news.has_moved && picture_) {
    draw(news.motion);
  }
  news.picture.reset();
  news.end_effectors.reset();
  news.has_moved = false;
}

void Display::begin(std::shared_ptr<Picture> picture) {
  picture_ = std::move(picture);
  if (picture_) {
    picture_->markers.setFrame(names_("model"));
    picture_->structure.header.frame_id = names_("model");
    picture_->structure.header.stamp = ::ros::Time::now();
    model_structure_.publish(picture_->structure);
  }
  erases_ = true;
}

void Display::draw(ModelState& motion) {
  picture_->outlines.move(motion.displacement);
  if (model_state_.getNumSubscribers() > 0) {
    model_state_.publish(motion);
  }
  if (markers_.getNumSubscribers() > 0) {
    drawMarkers(motion);
  }
  if (end_effector_shapes_.getNumSubscribers() > 0) {
    drawShapes(motion.header.stamp);
  }
}

void Display::drawShapes(const ::ros::Time& stamp) {
  const auto& shapes = frames_.shapes(stamp);
  if (!std::exchange(erases_shapes_, false)) {
    return shapes.markers.empty() ? void() : end_effector_shapes_.publish(shapes);
  }
  visualization_msgs::MarkerArray all = Markers::eraseAll(names_("model"));
  all.markers.insert(all.markers.end(), shapes.markers.begin(), shapes.markers.end());
  end_effector_shapes_.publish(all);
}

/// Publishes the markers of a frame. The message that brings a new picture also erases the old one:
/// a subscriber that is slow for a moment gets both or neither.
void Display::drawMarkers(const ModelState& motion) {
  const ::ros::Time stamp = motion.header.stamp;
  const auto& model = picture_->markers.draw(motion.displacement, stamp);
  const auto& shapes = frames_.shapes(stamp);
  if (std::exchange(erases_, false)) {
    visualization_msgs::MarkerArray all = Markers::eraseAll(names_("model"));
    for (const auto* part : {&model, &shapes}) {
      all.markers.insert(all.markers.end(), part->markers.begin(), part->markers.end());
    }
    return markers_.publish(all);
  }
  markers_.publish(model);
  if (!shapes.markers.empty()) {
    markers_.publish(shapes);
  }
}

}  // namespace ergotic::node
