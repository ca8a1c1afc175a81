// SPDX-License-Identifier: BSD-3-Clause
#include "ros/display/markers.hpp"

#include <algorithm>
#include <array>

namespace ergotic::node {
namespace {

using visualization_msgs::Marker;

constexpr double kPointWidthM = 0.006;
constexpr double kLineWidthM = 0.004;

struct Colour {
  float r, g, b;
};
// Sections in turn; light on rviz's dark ground.
constexpr std::array<Colour, 6> kColours = {{{1.0F, 0.72F, 0.20F},
                                             {0.35F, 0.78F, 1.0F},
                                             {0.55F, 0.95F, 0.45F},
                                             {1.0F, 0.45F, 0.45F},
                                             {0.80F, 0.60F, 1.0F},
                                             {0.95F, 0.95F, 0.60F}}};

Marker markerOf(const scene::Section& section, std::size_t index, int type, int id) {
  Marker marker;
  marker.header.frame_id = "model";
  marker.ns = section.name + (type == Marker::POINTS ? "/modules" : "/links");
  marker.id = id;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.lifetime = ::ros::Duration(Markers::kLifetimeS);
  marker.scale.x = type == Marker::POINTS ? kPointWidthM : kLineWidthM;
  marker.scale.y = type == Marker::POINTS ? kPointWidthM : 0.0;
  const Colour& colour = kColours[index % kColours.size()];
  const float light = type == Marker::POINTS ? 1.0F : 0.8F;
  marker.color.r = light * colour.r;
  marker.color.g = light * colour.g;
  marker.color.b = light * colour.b;
  marker.color.a = 1.0F;
  return marker;
}

}  // namespace

bool isModeOfOutline(const scene::Scene& scene, int mat) {
  return std::any_of(scene.outlines.begin(), scene.outlines.end(),
                     [mat](const scene::Outline& outline) {
                       return mat >= outline.first_mat && mat < outline.first_mat + outline.modes;
                     });
}

Markers::Markers(const scene::Scene& scene, double zoom) {
  for (const scene::Section& section : scene.sections) {
    const double magnified = scene::dimensionsOf(section.geometry) == 1 ? zoom : 1.0;
    drawing_.emplace_back(section.pose * Eigen::Scaling(magnified, 1.0, 1.0));
  }
  std::vector<Indices> modules(scene.sections.size());
  std::vector<Indices> links(scene.sections.size());
  std::size_t first = 0;
  for (std::size_t i = 0; i < scene.mats.size(); ++i) {
    const scene::Mat& mat = scene.mats[i];
    const auto section = static_cast<std::size_t>(mat.section);
    const int dimensions = scene::dimensionsOf(scene.sections[section].geometry);
    modules_.push_back({mat.rest, section, first, dimensions});
    if (!isModeOfOutline(scene, static_cast<int>(i))) {
      modules[section].push_back(i);
    }
    first += static_cast<std::size_t>(dimensions);
  }
  for (const scene::Lia& lia : scene.lias) {
    const auto a = static_cast<std::size_t>(lia.a);
    const auto b = static_cast<std::size_t>(lia.b);
    Indices& ends = links[static_cast<std::size_t>(scene.mats[a].section)];
    ends.push_back(a);
    ends.push_back(b);
  }
  for (std::size_t s = 0; s < scene.sections.size(); ++s) {
    addMarkers(scene, s, Marker::POINTS, modules[s]);
    addMarkers(scene, s, Marker::LINE_LIST, links[s]);
  }
}

void Markers::addMarkers(const scene::Scene& scene,
                         std::size_t section,
                         int type,
                         const Indices& mats) {
  int id = 0;
  for (std::size_t first = 0; first < mats.size(); first += kChunkPoints) {
    const std::size_t last = std::min(first + kChunkPoints, mats.size());
    array_.markers.push_back(markerOf(scene.sections[section], section, type, id++));
    array_.markers.back().points.resize(last - first);
    points_.emplace_back(mats.begin() + static_cast<std::ptrdiff_t>(first),
                         mats.begin() + static_cast<std::ptrdiff_t>(last));
  }
}

void Markers::setFrame(const std::string& frame) {
  for (Marker& marker : array_.markers) {
    marker.header.frame_id = frame;
  }
}

const visualization_msgs::MarkerArray& Markers::draw(const std::vector<float>& displacements,
                                                     const ::ros::Time& stamp) {
  for (std::size_t m = 0; m < array_.markers.size(); ++m) {
    Marker& marker = array_.markers[m];
    marker.header.stamp = stamp;
    for (std::size_t p = 0; p < points_[m].size(); ++p) {
      marker.points[p] = place(modules_[points_[m][p]], displacements);
    }
  }
  return array_;
}

geometry_msgs::Point Markers::place(const Module& module,
                                    const std::vector<float>& displacements) const {
  Eigen::Vector3d moved = module.rest;
  for (int k = 0; k < module.dimensions; ++k) {
    moved[k] += static_cast<double>(displacements[module.first + static_cast<std::size_t>(k)]);
  }
  const Eigen::Vector3d drawn =
      drawing_[module.section] * (moved.allFinite() ? moved : module.rest);
  geometry_msgs::Point point;
  point.x = drawn.x();
  point.y = drawn.y();
  point.z = drawn.z();
  return point;
}

visualization_msgs::MarkerArray Markers::eraseAll(const std::string& frame) {
  visualization_msgs::MarkerArray array;
  array.markers.emplace_back();
  array.markers.back().header.frame_id = frame;
  array.markers.back().action = Marker::DELETEALL;
  return array;
}

}  // namespace ergotic::node
