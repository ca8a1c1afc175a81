// SPDX-License-Identifier: BSD-3-Clause
#include "ergotic/scene/truth.hpp"

namespace ergotic::scene {
namespace {

const char* unitOf(Truth::Figure figure) {
  switch (figure) {
    case Truth::Figure::kDuration:
      return "s";
    case Truth::Figure::kStiffness:
      return "N/m";
    case Truth::Figure::kWork:
      return "J";
    case Truth::Figure::kPeak:
    case Truth::Figure::kRelease:
      break;
  }
  return "N";
}

}  // namespace

const char* wordOf(Truth::What what) {
  constexpr const char* kWords[] = {
      "pitch",        "partials", "ratios",   "t60",   "harmonics_left", "contact", "beats",
      "double_decay", "force",    "centroid", "glide", "silence",        "energy"};
  return kWords[static_cast<std::size_t>(what)];
}

const char* unitOf(const Truth& truth) {
  switch (truth.what) {
    case Truth::What::kPitch:
    case Truth::What::kBeats:
      return "Hz";
    case Truth::What::kCentroid:
      return truth.times_s.size() == 1 ? "Hz" : "";
    case Truth::What::kT60:
    case Truth::What::kDoubleDecay:
      return "s";
    case Truth::What::kContact:
    case Truth::What::kForce:
      return unitOf(truth.figure);
    case Truth::What::kPartials:
    case Truth::What::kRatios:
    case Truth::What::kHarmonicsLeft:
    case Truth::What::kGlide:
    case Truth::What::kSilence:
    case Truth::What::kEnergy:
      break;
  }
  return "";
}

}  // namespace ergotic::scene
