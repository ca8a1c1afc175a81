// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "physics/disjoint_sets.hpp"
#include "physics/network/network.hpp"

namespace ergotic::physics {

/// Rest positions of the modules of a scene while hands are still, and their quasi-static
/// displacements with a hand that moves slowly. Springs hold, by the linear part of their laws;
/// what may let go is open. In scalar sections what hangs between several things is worked out; in
/// the others a module follows if it hangs on the slice alone, and is else held where it starts.
/// All lengths are in the model's units. Thread: one. Realtime: no
class Statics {
 public:
  /// \param network  must outlive it
  explicit Statics(const Network& network);

  /// Position of a module or point, m, in its section, with all hands at 0 and agents as they
  /// begin.
  Eigen::Vector3d placeOf(int mat);
  /// How far it goes for a metre of the hand, in its section.
  Eigen::Vector3d wayOf(int mat, const scene::Port& port);
  /// [mats] not 0: what the slice is, what springs hang on it, and points on those.
  std::vector<unsigned char> movedBy(const scene::Port& port);
  /// Modules of the body of `thing`, for a metre of the hand once something pushes at that: all are
  /// drawn along by springs, and both give way by theirs. Empty: nothing says how far.
  /// \param by        what pushes, in another body or the slice \param softness  between both, m/N
  std::vector<double> pushedWays(int thing, int by, const scene::Port& port, double softness);
  /// Displacement of a module or point among these; 0 elsewhere.
  double among(int body, const std::vector<double>& ways, int mat);
  /// Names the body of a free module, or of the first under a point: what springs join, but for
  /// what is held. -1: held.
  int bodyOf(int mat);
  /// Modules that go as far as the slice, as nothing else holds them, in the order of the scene.
  std::vector<int> followersOf(const scene::Port& port);
  /// Bodies on a slice of which it is not known how they follow it: they are taken as held.
  int untold() const { return static_cast<int>(untold_.size()); }

 private:
  struct Spring {
    Shares ends;  ///< ends on modules, held ones too
    double stiffness = 0.0;
    double elongation = 0.0;  ///< at the start, m; of scalar ones
  };
  struct Body {
    std::vector<int> mats;  ///< ascending
    std::vector<Spring> springs;
    std::set<int> holders;          ///< held modules at its springs
    bool is_scalar = true;          ///< with its holders
    bool is_levered = false;        ///< by a tap: it does not move as a whole with what it hangs on
    bool is_held_by_cells = false;  ///< each by its own spring
    bool is_settled = false;        ///< `offsets` are known
    std::vector<double> offsets;    ///< [mats] m, from where they start to where they rest
  };

  Shares sharesOf(int mat) const;
  Eigen::Vector3d startOf(int mat) const;
  Eigen::Vector3d beginningOf(int mat) const;
  template <class Places>
  Eigen::Vector3d placeBy(int mat, const Places& place_of_module) const;
  void addSprings();
  void add(Spring spring);
  static std::size_t placeIn(const Body& body, int mat);
  bool followsAlone(const Body& body, int slice) const;
  const std::vector<double>& offsetsOf(Body& body);
  const std::vector<double>& waysOf(int name, const scene::Port& port);
  std::vector<double> yieldOf(int mat);
  bool solve(const Body& body, std::vector<double>& pushed) const;
  Eigen::Vector3d wayOfSlice(const scene::Port& port, const scene::Section& seen_from) const;

  const Network& network_;
  const scene::Scene& scene_;
  DisjointSets sets_;
  std::map<int, Body> bodies_;                                              ///< by their names
  std::map<std::pair<int, const scene::Port*>, std::vector<double>> ways_;  ///< [mats] of bodies
  std::set<int> untold_;
};

}  // namespace ergotic::physics
