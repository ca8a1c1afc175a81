// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>

#include "ergotic/exception.hpp"
#include "ergotic/tgr/calibration.hpp"
#include "scene/names.hpp"
#include "scene/text/number.hpp"
#include "tgr/calibration_rules.hpp"

namespace ergotic::tgr {
namespace {

using scene::Limits;
using scene::Place;
using scene::YamlMap;

struct Field {
  const char* key;
  double SliceCalibration::*member;
  Limits limits;
};

/// Every number of a slice, in the order in which they are written.
constexpr std::array<Field, 11> kFields{
    {{"metres_per_volt", &SliceCalibration::metres_per_volt, kMetresPerVoltLimits},
     {"rest_volts", &SliceCalibration::rest_volts, kVoltsLimits},
     {"low_volts", &SliceCalibration::low_volts, kVoltsLimits},
     {"high_volts", &SliceCalibration::high_volts, kVoltsLimits},
     {"volts_per_newton", &SliceCalibration::volts_per_newton, kVoltsPerNewtonLimits},
     {"zero_volts", &SliceCalibration::zero_volts, kVoltsLimits},
     {"max_volts", &SliceCalibration::max_volts, kMaxVoltsLimits},
     {"full_scale_newtons", &SliceCalibration::full_scale_newtons, kFullScaleLimits},
     {"checked", &SliceCalibration::checked, kCheckedLimits},
     {"residual_m", &SliceCalibration::residual_m, kErrorLimits},
     {"noise_m", &SliceCalibration::noise_m, kErrorLimits}}};

std::string sliceText(const SliceCalibration& calibration) {
  const SliceCalibration plain;
  std::string text;
  for (const Field& field : kFields) {
    const bool is_position = field.member == &SliceCalibration::metres_per_volt ||
                             field.member == &SliceCalibration::rest_volts;
    const double value = calibration.*field.member;
    if (calibration.is_calibrated || (!is_position && value != plain.*field.member)) {
      text += (text.empty() ? "" : ", ") + std::string(field.key) + ": " + scene::shortest(value);
    }
  }
  return text.empty() ? "~" : "{" + text + "}";
}

}  // namespace

SliceCalibration readSliceCalibration(const Settings& settings,
                                      const scene::Node& node,
                                      const std::string& what,
                                      Place fallback) {
  SliceCalibration calibration;
  if (node.isNull()) {
    return calibration;
  }
  const Place place = scene::placeOf(node, fallback);
  const YamlMap map(settings.builder(), node, what, place);
  std::vector<std::string> keys;
  for (const Field& field : kFields) {
    keys.emplace_back(field.key);
    calibration.*field.member = map.number(field.key, field.limits, calibration.*field.member);
  }
  map.allow(keys);
  calibration.is_calibrated = map.has("metres_per_volt") && map.has("volts_per_newton");
  try {
    checkCalibration(calibration, " of " + what);
  } catch (const Exception& error) {
    settings.builder().fail(place, error.what());
  }
  return calibration;
}

std::vector<SliceCalibration> readSliceCalibrations(const Settings& settings,
                                                    const scene::Node& list,
                                                    Place place) {
  if (!list.isList() || list.size() > kMaxSlices) {
    settings.builder().fail(place, "calibration of the slices is " + scene::kindOf(list) +
                                       ", allowed: a list of at most " +
                                       std::to_string(kMaxSlices) +
                                       " maps, one for each slice from 0 on");
  }
  std::vector<SliceCalibration> slices;
  for (const scene::Node& node : list) {
    slices.push_back(readSliceCalibration(
        settings, node, "calibration of slice " + std::to_string(slices.size()), place));
  }
  return slices;
}

std::string sliceCalibrationsText(const Calibration& calibration) {
  std::string text;
  for (const SliceCalibration& slice : calibration.slices) {
    text += (text.empty() ? "" : ", ") + sliceText(slice);
  }
  return "[" + text + "]";
}

Calibration readCalibration(const std::string& text, const std::string& name) {
  const Settings settings(parseSettings(text, name), name, "the calibration");
  settings.top().allow({"slices"});
  return {readSliceCalibrations(settings, settings.top().at("slices"),
                                settings.top().placeAt("slices"))};
}

std::string toYaml(const Calibration& calibration) {
  std::string text = "slices:\n";
  for (const SliceCalibration& slice : calibration.slices) {
    text += "  - " + sliceText(slice) + "\n";
  }
  return calibration.slices.empty() ? "slices: []\n" : text;
}

}  // namespace ergotic::tgr
