// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>

#include <Eigen/Eigenvalues>

#include "ergotic/tgr/driver.hpp"
#include "ergotic/tgr/rig.hpp"
#include "scene/limits.hpp"
#include "scene/names.hpp"

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

/// By what the scales of its end-effector multiply the stiffness of a port.
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

/// [slices][slices] N/m at the device. The forces that one newton at a port causes at the slices
/// are the port's row of the Jacobian, if nothing is scaled.
Eigen::MatrixXd stiffnessMatrix(Rig& rig,
                                const scene::Scene& scene,
                                const EndEffectors& end_effectors,
                                const std::vector<double>& port_stiffness) {
  std::vector<double> ports(scene.ports.size());
  Eigen::VectorXd row = Eigen::VectorXd::Zero(kMaxSlices);
  rig.toModel(row.data(), 0.0, ports.data());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(kMaxSlices, kMaxSlices);
  for (std::size_t p = 0; p < ports.size(); ++p) {
    std::fill(ports.begin(), ports.end(), 0.0);
    ports[p] = 1.0;
    rig.toDevice(ports.data(), row.data());
    const double scale = scaleOf(scene.ports[p], end_effectors);
    matrix += scale * port_stiffness[p] * row * row.transpose();
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
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(block, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
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

std::vector<RenderedStiffness> renderedStiffness(const scene::Scene& scene,
                                                 const EndEffectors& end_effectors,
                                                 const std::vector<double>& port_stiffness,
                                                 double damping,
                                                 double tick_rate_hz,
                                                 double delay_ticks) {
  const auto rig = makeRig(unscaledPorts(scene), unscaled(end_effectors), kMaxSlices);
  const Eigen::MatrixXd matrix = stiffnessMatrix(*rig, scene, end_effectors, port_stiffness);
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
  const double limit = 2.0 * damping * tick_rate_hz / (1.0 + 2.0 * delay_ticks);
  std::vector<RenderedStiffness> rendered;
  for (int slice = 0; slice < kMaxSlices; ++slice) {
    if ((rig->slicesInUse() >> static_cast<unsigned>(slice) & 1U) != 0) {
      rendered.push_back(
          {slice, matrix(slice, slice), together[static_cast<std::size_t>(slice)], limit});
    }
  }
  return rendered;
}

StiffnessFindings judgeStiffness(const EndEffectors& end_effectors,
                                 const std::vector<RenderedStiffness>& rendered) {
  StiffnessFindings findings;
  for (const EndEffectorConfig& config : end_effectors.list) {
    const auto found =
        std::find_if(rendered.begin(), rendered.end(), [&config](const RenderedStiffness& r) {
          return std::find(config.slices.begin(), config.slices.end(), r.slice) !=
                 config.slices.end();
        });
    if (found == rendered.end() || !(found->together > kWarnedStiffness * found->limit)) {
      continue;
    }
    const bool refused = found->together > kRefusedStiffness * found->limit;
    const std::string place = end_effectors.file + ":" + std::to_string(config.place.line) + ":" +
                              std::to_string(config.place.column);
    (refused ? findings.refusals : findings.warnings)
        .push_back(
            place + (refused ? ": error: " : ": warning: ") + "end-effector " +
            scene::quoted(config.name) + " renders up to " + scene::numberText(found->together) +
            " N/m at its slices, which are passive up "
            "to " +
            scene::numberText(found->limit) + " N/m" + (refused ? ": it will buzz or jump" : "") +
            ". Lower its force_scale, raise its position_scale, or raise the gestural rate");
  }
  return findings;
}

}  // namespace ergotic::tgr
