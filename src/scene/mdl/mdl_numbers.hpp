// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "ergotic/scene/text/read_scene.hpp"
#include "scene/limits.hpp"
#include "scene/mdl/mdl_lexer.hpp"

namespace ergotic::scene {

constexpr double kMdlRateHz = 44100.0;  ///< rate that the plain coefficients are meant for
/// A param, or an override of a text without it: 1 if clipped laws are those of Faust's library, 0
/// if they are those of mi-gen.
constexpr const char* kFaustClipName = "faust_clip";

/// The numbers of an `.mdl` text: its `param`s, which may use one another in any order, and the
/// expressions and vectors of its arguments. The `audioParam`s are those of the builder's scene.
/// Every function throws TextError at the argument.
class MdlNumbers {
 public:
  /// \param overrides  take the place of what the text gives
  /// \throws Exception if an override is unknown
  MdlNumbers(SceneBuilder& builder, const std::vector<MdlLine>& lines, const Overrides& overrides);

  bool isParam(const std::string& name) const { return params_.count(name) > 0; }
  bool isFaust() const { return is_faust_; }
  /// Evaluates every `param`, used or not.
  void check();
  double number(const MdlToken& token);
  double number(const MdlToken& token, const std::string& what, const Limits& limits);
  /// A number, or one that is a constant plus a constant times an `audioParam`. Only the first is
  /// refused where it is out of `limits`.
  Value value(const MdlToken& token, const std::string& what, const Limits& limits);
  /// The same, and what follows an `audioParam` is cut to the limits of what must be above 0.
  Value positiveValue(const MdlToken& token, const std::string& what, const Limits& limits);

  struct Vector {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
  };
  /// `[x y z]`, plain numbers; or an expression s that stands for [0 0 s].
  Vector vector(const MdlToken& token);

 private:
  struct Param {
    const MdlLine* line = nullptr;
    double value = 0.0;
    bool known = false;
    bool open = false;  // being evaluated: asked for again, it defines itself
  };
  double evaluateAt(const MdlToken& token);
  double nameValue(const std::string& name, Place place);
  double evaluateWith(const MdlToken& token, double sample);
  std::optional<AudioParameter> straightLine(const MdlToken& token, const std::string& what);
  Value followed(const MdlToken& token, AudioParameter parameter);
  bool isStraight(const MdlToken& token, double offset, double scale);
  double paramValue(const std::string& name, Place place);

  SceneBuilder& builder_;
  std::unordered_map<std::string, Param> params_;
  std::vector<std::string> names_;  // in the order of the text
  int depth_ = 0;
  bool is_faust_ = false;
  // While an argument that may follow an audio input is tried: the sample, and which it follows.
  std::optional<double> sample_;
  int followed_ = -1;
};

}  // namespace ergotic::scene
