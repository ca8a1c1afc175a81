// SPDX-License-Identifier: BSD-3-Clause
#include "support/scene_builder.hpp"

#include "support/test.hpp"

namespace ergotic::test {

SceneBuilder::SceneBuilder() {
  scene.name = "built";
  scene.file = "built.yaml";
  scene::Section audio;
  audio.name = "audio";
  scene::Section gestural;
  gestural.name = "gestural";
  gestural.gestural = true;
  scene.sections = {audio, gestural};
}

int SceneBuilder::add(scene::MatType type, double kg, double x, double v, int section) {
  scene::Mat mat;
  mat.type = type;
  mat.name = "m" + std::to_string(scene.mats.size());
  mat.mass = {kg};
  mat.position.x() = x;
  mat.push.edit().velocity.x() = v;
  mat.section = section;
  mat.place = {static_cast<int>(scene.mats.size()) + 1, 1};
  scene.mats.push_back(mat);
  return static_cast<int>(scene.mats.size()) - 1;
}

int SceneBuilder::mass(double kg, double x, double v, int section) {
  return add(scene::MatType::kMass, kg, x, v, section);
}

int SceneBuilder::cell(double kg, double k, double z, double x, double v, int section) {
  const int m = add(scene::MatType::kCell, kg, x, v, section);
  scene.mats.back().stiffness = {k};
  scene.mats.back().damping = {z};
  return m;
}

int SceneBuilder::ground(double x, int section) {
  return add(scene::MatType::kGround, 1.0, x, 0.0, section);
}

int SceneBuilder::slice(int slice_index) {
  const int m = add(scene::MatType::kSlice, 1.0, 0.0, 0.0, kGestural);
  scene::Port port;
  port.name = "port" + std::to_string(scene.ports.size());
  port.mat = m;
  port.slice = slice_index;
  scene.ports.push_back(port);
  return m;
}

int SceneBuilder::driven(int channel) {
  const int m = add(scene::MatType::kDriven, 1.0, 0.0, 0.0, kAudio);
  scene::Input input;
  input.name = "in" + std::to_string(channel + 1);
  input.quantity = scene::Quantity::kPosition;
  input.mat = m;
  input.channel = channel;
  scene.inputs.push_back(input);
  return m;
}

int SceneBuilder::grid(int first, int columns, int rows) {
  scene.grids.push_back({"g" + std::to_string(scene.grids.size()), first, columns, rows});
  return static_cast<int>(scene.grids.size()) - 1;
}

int SceneBuilder::point(int grid, double along, double across) {
  const scene::Grid& on = scene.grids[at(grid)];
  const int m = add(scene::MatType::kPoint, 1.0, 0.0, 0.0, scene.mats[at(on.first)].section);
  scene.mats.back().name = "p" + std::to_string(m);
  scene::Connection connection;
  connection.mat = m;
  connection.grid = grid;
  connection.along.at = {along};
  connection.across.at = {across};
  connection.place = {500 + static_cast<int>(scene.connections.size()), 1};
  scene.connections.push_back(connection);
  return m;
}

int SceneBuilder::tap(std::vector<scene::Tap::Share> shares) {
  const int section = scene.mats[at(shares.front().mat)].section;
  const int m = add(scene::MatType::kPoint, 1.0, 0.0, 0.0, section);
  scene::Mat& point = scene.mats.back();
  point.name = "t" + std::to_string(m);
  for (const scene::Tap::Share& share : shares) {
    point.rest += share.weight * scene.mats[at(share.mat)].rest;
    point.position += share.weight * scene.mats[at(share.mat)].position;
  }
  scene.taps.push_back({m, std::move(shares), {700 + static_cast<int>(scene.taps.size()), 1}, 0.0});
  return m;
}

int SceneBuilder::push(int mat, int channel) {
  scene::Input input;
  input.name = "push" + std::to_string(scene.inputs.size());
  input.mat = mat;
  input.channel = channel;
  scene.inputs.push_back(input);
  return static_cast<int>(scene.inputs.size()) - 1;
}

int SceneBuilder::link(scene::LiaType type, int a, int b, double k, double z) {
  scene::Lia lia;
  lia.type = type;
  lia.name = "l" + std::to_string(scene.lias.size());
  lia.a = a;
  lia.b = b;
  lia.stiffness = {k};
  lia.damping = {z};
  lia.place = {100 + static_cast<int>(scene.lias.size()), 1};
  scene.lias.push_back(lia);
  return static_cast<int>(scene.lias.size()) - 1;
}

int SceneBuilder::chain(int masses, double kg, double k, double z) {
  const int first = ground();
  for (int i = 0; i < masses; ++i) {
    const int m = mass(kg);
    spring(m - 1, m, k, z);
  }
  const int last = ground();
  spring(last - 1, last, k, z);
  return first;
}

void SceneBuilder::hear(int mat, int channel, scene::Quantity quantity) {
  scene::Output output;
  output.name = "out" + std::to_string(scene.outputs.size());
  output.quantity = quantity;
  output.point.mat = mat;
  output.channel = channel;
  scene.outputs.push_back(output);
}

void SceneBuilder::hearAxes(int mat, int first_channel, scene::Quantity quantity) {
  const int section = scene.mats[at(mat)].section;
  for (int axis = 0; axis < dimensionsOf(scene.sections[at(section)].geometry); ++axis) {
    hear(mat, first_channel + axis, quantity);
    scene.outputs.back().axis = axis;
  }
}

Player::Player(std::unique_ptr<physics::Instrument> made)
    : instrument(std::move(made)),
      positions(at(instrument->ports()), 0.0),
      forces(positions.size(), 0.0),
      inputs(at(instrument->rates().ratio * instrument->inputChannels())),
      heard(at(instrument->outputChannels())),
      outputs_(at(instrument->rates().ratio) * heard.size()) {}

void Player::tick() {
  instrument->tick(
      {positions.data(), forces.data(), inputs.data(), outputs_.data(), touches.data()});
  const std::size_t channels = heard.size();
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    heard[i % channels].push_back(outputs_[i]);
  }
}

}  // namespace ergotic::test
