// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>

#include <Eigen/Core>

#include "algebra/decompositions.hpp"
#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/rig.hpp"

namespace ergotic::tgr {
namespace {

/// The ports and agents of a scene, all that a rig looks at, at the device's scales.
scene::Scene unscaledPorts(const scene::Scene& scene) {
  scene::Scene ports;
  ports.file = scene.file;
  ports.agents = scene.agents;
  ports.ports = scene.ports;
  for (scene::Port& port : ports.ports) {
    port.offset = 0.0;
    port.position_scale = 1.0;
    port.force_scale = 1.0;
  }
  return ports;
}

/// Factor by which the scales of its end-effector multiply stiffness or damping of a port.
double scaleOf(const scene::Port& port, const EndEffectors& end_effectors) {
  for (const EndEffectorConfig& config : end_effectors.list) {
    if (std::find(config.ports.begin(), config.ports.end(), port.name) != config.ports.end()) {
      return config.force_scale / config.position_scale;
    }
  }
  return 1.0;
}

EndEffectors unscaled(EndEffectors end_effectors) {
  for (EndEffectorConfig& config : end_effectors.list) {
    config.position_scale = 1.0;
    config.force_scale = 1.0;
  }
  return end_effectors;
}

/// [slices][slices] at the device. The forces that one newton at a port causes at the slices
/// are the port's row of the Jacobian, if nothing is scaled.
Eigen::MatrixXd matrixAtSlices(Rig& rig,
                               const scene::Scene& scene,
                               const EndEffectors& end_effectors,
                               const std::vector<double>& of_ports) {
  std::vector<double> ports(scene.ports.size());
  Eigen::VectorXd row = Eigen::VectorXd::Zero(kMaxSlices);
  rig.toModel(row.data(), 0.0, ports.data());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(kMaxSlices, kMaxSlices);
  for (std::size_t p = 0; p < ports.size(); ++p) {
    std::fill(ports.begin(), ports.end(), 0.0);
    ports[p] = 1.0;
    rig.toDevice(ports.data(), row.data());
    const double scale = scaleOf(scene.ports[p], end_effectors);
    matrix += scale * of_ports[p] * row * row.transpose();
  }
  return matrix;
}

double largestEigenvalue(const Eigen::MatrixXd& matrix, const std::vector<int>& slices) {
  const auto count = static_cast<Eigen::Index>(slices.size());
  Eigen::MatrixXd block(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      block(i, j) =
          matrix(slices[static_cast<std::size_t>(i)], slices[static_cast<std::size_t>(j)]);
    }
  }
  return algebra::symmetricEigenvalues(block).maxCoeff();
}

}  // namespace

std::vector<int> takenPorts(const scene::Scene& scene, const EndEffectors& end_effectors) {
  const auto has = [](const auto& list, const auto& wanted) {
    return std::find(list.begin(), list.end(), wanted) != list.end();
  };
  std::vector<int> taken;
  for (std::size_t p = 0; p < scene.ports.size(); ++p) {
    const scene::Port& port = scene.ports[p];
    const auto& list = end_effectors.list;
    if (port.slice >= 0 &&
        std::any_of(list.begin(), list.end(), [&](const EndEffectorConfig& config) {
          return has(config.ports, port.name) || has(config.slices, port.slice);
        })) {
      taken.push_back(static_cast<int>(p));
    }
  }
  return taken;
}

std::vector<Rendered> renderedAtSlices(const scene::Scene& scene,
                                       const EndEffectors& end_effectors,
                                       const std::vector<double>& of_ports) {
  const auto rig = makeRig(unscaledPorts(scene), unscaled(end_effectors), kMaxSlices);
  const Eigen::MatrixXd matrix = matrixAtSlices(*rig, scene, end_effectors, of_ports);
  std::array<double, kMaxSlices> together{};
  for (int slice = 0; slice < kMaxSlices; ++slice) {
    together[static_cast<std::size_t>(slice)] = matrix(slice, slice);
  }
  for (const EndEffectorConfig& config : end_effectors.list) {
    const double largest = largestEigenvalue(matrix, config.slices);
    for (const int slice : config.slices) {
      together[static_cast<std::size_t>(slice)] = largest;
    }
  }
  std::vector<Rendered> rendered;
  for (int slice = 0; slice < kMaxSlices; ++slice) {
    if ((rig->slicesInUse() >> static_cast<unsigned>(slice) & 1U) != 0) {
      rendered.push_back({slice, matrix(slice, slice), together[static_cast<std::size_t>(slice)]});
    }
  }
  return rendered;
}

}  // namespace ergotic::tgr
