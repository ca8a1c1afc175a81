// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "physics/network/rated_network.hpp"

namespace ergotic::physics {

/// The modules of one island by themselves, as scenes to be stepped.
class Island {
 public:
  Island(const RatedNetwork& networks, int island);

  int masses() const { return masses_; }

  /// Scenes of the island with everything outside held: contacts open and, if there are any, closed
  /// at their steepest slope; each with the present values of the parameters that it follows and
  /// with both ends of their ranges.
  std::vector<scene::Scene> cases() const;

  /// Why eigenvalues of these cases are no proof; empty: they are one.
  std::string doubt() const;

 private:
  bool isMember(int mat) const;
  bool isMember(const scene::Lia& lia) const;
  bool isOneLine() const;
  bool follows(const scene::Value& v) const;
  bool followsParameters() const;
  /// \param closed  links that switch are springs as stiff as they can be
  scene::Scene isolated(bool closed) const;

  const RatedNetwork& networks_;
  int island_;
  int masses_ = 0;
};

}  // namespace ergotic::physics
