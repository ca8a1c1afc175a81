// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace ergotic::test {

/// YAML of bars and plates of links of many ends, of masses of 1 g, with grounds around them, in
/// one scalar section of 44.1 kHz. It has a parameter p of 0.5...2.
class Bars {
 public:
  enum class Edge { kFree, kHinged, kClamped };

  /// \param kappa  h^2 K / M of its bends
  /// \param keys   of them beside, each after a comma
  explicit Bars(double kappa, std::string keys = "") : kappa_(kappa), keys_(std::move(keys)) {}

  /// Masses m1 ... m<count>.
  std::string bar(int count, Edge left, Edge right);
  /// Hinged all around: one cross for each mass m<row>_<column>, counted from 1.
  std::string supportedPlate(int side);
  /// Bends along rows and columns, crosses inside, a twist in each cell, more of it at the edges.
  std::string freePlate(int side, double poisson);

  std::string section = "{}";         ///< keys of the only section
  std::vector<double> displacements;  ///< of masses at the start, as they come; none: 0

 private:
  void mat(const std::string& name, bool is_free);
  void bend(const std::vector<std::string>& ends, const std::string& weights, double share);
  std::string text() const;

  double kappa_;
  std::string keys_;  // of bends
  std::string mats_;
  std::string lias_;
  std::size_t masses_ = 0;
  int bends_ = 0;
};

}  // namespace ergotic::test
