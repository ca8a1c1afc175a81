// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scene/generate/scene_builder.hpp"

namespace ergotic::scene {

enum class Hardening {
  kNone,
  kLocal,   ///< each place by itself: sound climbs to higher modes
  kGlobal,  ///< all of it by the mean elongation: the pitch glides
};

/// The links by which a body that asks for a pitch grows stiffer where it is drawn far: cubic ones,
/// `name.hard.0` ..., in one tank `name.hard`. Its tuning scales them as it does its springs.
class HardLinks {
 public:
  /// Makes nothing if `hardening` is Hardening::kNone.
  HardLinks(SceneBuilder& builder, const std::string& name, Hardening hardening, Place place);

  /// \param nonlinearity  Q as the body is written, N/m^3. \pre not kNone
  void add(int a, int b, double nonlinearity);

 private:
  SceneBuilder& builder_;
  Name stem_;
  Place place_;
  int tank_ = -1;
  int count_ = 0;
};

}  // namespace ergotic::scene
