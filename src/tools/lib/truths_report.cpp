// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <iostream>
#include <sstream>

#include "ergotic/scene/origin.hpp"
#include "tools/lib/report.hpp"
#include "tools/lib/truths.hpp"

namespace ergotic::tools {
namespace {

using scene::Truth;

/// A share of an amplitude, which one thinks of in decibels.
bool isLevel(const Truth& truth) {
  return truth.what == Truth::What::kHarmonicsLeft || truth.what == Truth::What::kSilence;
}

std::string numbers(const std::vector<double>& values, const Truth& truth) {
  std::ostringstream text;
  text.precision(isLevel(truth) ? 3 : 7);
  for (std::size_t i = 0; i < values.size(); ++i) {
    text << (i == 0 ? "" : ", ") << (isLevel(truth) ? 20.0 * std::log10(values[i]) : values[i]);
  }
  if (isLevel(truth)) {
    return text.str() + " dB";
  }
  const std::string unit = truth.what == Truth::What::kPartials ? "Hz" : unitOf(truth);
  return text.str() + (unit.empty() ? "" : " " + unit);
}

std::string tolerance(double value, const Truth& truth) {
  std::ostringstream text;
  text.precision(3);
  switch (truth.tolerance) {
    case Truth::Tolerance::kCents:
      text << value << (value == 1.0 ? " cent" : " cents");
      break;
    case Truth::Tolerance::kDecibels:
      text << value << " dB";
      break;
    case Truth::Tolerance::kRelative:
      text << 100.0 * value << " %";
      break;
    case Truth::Tolerance::kAbsolute:
      text << value << (*unitOf(truth) == '\0' ? "" : " ") << unitOf(truth);
      break;
  }
  return text.str();
}

std::string claim(const Truth& truth) {
  const std::vector<double> expected = expectedOf(truth);
  if (!expected.empty()) {
    return numbers(expected, truth) + " within " + tolerance(truth.within, truth);
  }
  std::string text;
  if (truth.least > -std::numeric_limits<double>::infinity()) {
    text = "at least " + numbers({truth.least}, truth);
  }
  if (truth.most < std::numeric_limits<double>::infinity()) {
    text += (text.empty() ? "at most " : ", at most ") + numbers({truth.most}, truth);
  }
  return text;
}

std::string howPlayed(const scene::Scene& scene, const Truth& truth) {
  switch (truth.play) {
    case Truth::Play::kTap:
    case Truth::Play::kPluck:
      return ", " + scene.mats[static_cast<std::size_t>(truth.struck.front().first)].name.str() +
             (truth.play == Truth::Play::kTap ? " tapped" : " plucked");
    case Truth::Play::kGesture:
      return ", played by " + truth.gesture;
    case Truth::Play::kStart:
      break;
  }
  return "";
}

std::string nameOfTruth(const scene::ClaimingScene& claims, const Truth& truth) {
  constexpr const char* kFigures[] = {"duration", "peak", "release", "stiffness", "work"};
  const scene::Scene& scene = claims.scene;
  std::string name = wordOf(truth.what);
  if (truth.what == Truth::What::kContact || truth.what == Truth::What::kForce) {
    name += std::string(" (") + kFigures[static_cast<std::size_t>(truth.figure)] + ")";
  }
  if (truth.output >= 0) {
    name += " of " + scene.outputs[static_cast<std::size_t>(truth.output)].name;
  } else if (truth.lia >= 0) {
    name += " of " + scene.lias[static_cast<std::size_t>(truth.lia)].name.str();
  } else if (truth.port >= 0) {
    name += " at " + scene.ports[static_cast<std::size_t>(truth.port)].name;
  }
  return name + howPlayed(scene, truth);
}

}  // namespace

bool tellTruths(const scene::ClaimingScene& claims,
                const std::vector<JudgedTruth>& judged,
                bool json) {
  bool all_hold = true;
  Json report = Json::array();
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const Truth& truth = claims.truths[i];
    const JudgedTruth& result = judged[i];
    all_hold = all_hold && result.holds;
    const std::string place = scene::textOf(claims.scene, truth.place);
    if (json) {
      Json entry = {{"place", place},
                    {"what", nameOfTruth(claims, truth)},
                    {"claim", claim(truth)},
                    {"expected", expectedOf(truth)},
                    {"measured", result.measured},
                    {"unit", unitOf(truth)},
                    {"holds", result.holds}};
      if (result.trouble.empty()) {
        entry["found"] = numbers(result.measured, truth);
      }
      if (!expectedOf(truth).empty() && result.trouble.empty()) {
        entry["off"] = tolerance(result.off, truth);
      }
      if (!truth.source.empty()) {
        entry["source"] = truth.source;
      }
      if (!result.trouble.empty()) {
        entry["trouble"] = result.trouble;
      }
      report.push_back(std::move(entry));
    } else if (!result.trouble.empty()) {
      std::cerr << place << ": error: " << nameOfTruth(claims, truth)
                << " cannot be measured: " << result.trouble << '\n';
    } else {
      std::cout << (result.holds ? "holds: " : "DOES NOT HOLD: ") << place << ": "
                << nameOfTruth(claims, truth) << ": " << numbers(result.measured, truth)
                << ", expected " << claim(truth);
      if (!expectedOf(truth).empty()) {
        std::cout << ", off by " << tolerance(result.off, truth);
      }
      std::cout << (truth.source.empty() ? "" : " (" + truth.source + ")") << '\n';
    }
  }
  if (json) {
    printJson(report, std::cout);
    std::cout << '\n';
  }
  return all_hold;
}

}  // namespace ergotic::tools
