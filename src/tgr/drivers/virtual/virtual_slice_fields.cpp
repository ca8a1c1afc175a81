// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/virtual/virtual_slice_fields.hpp"

#include "ergotic/exception.hpp"
#include "tgr/calibration_rules.hpp"

namespace ergotic::tgr {

void checkSlice(const VirtualSliceConfig& config) {
  for (const VirtualSliceField& field : kVirtualSliceFields) {
    const double value = config.*field.member;
    if (!(value >= field.limits.minimum && value <= field.limits.maximum)) {
      throw Exception(scene::outOfRange(field.key, value, field.limits));
    }
  }
  if (config.volts) {
    checkCalibration(*config.volts, " of volts");
    if (!config.volts->is_calibrated) {
      throw Exception("volts of a virtual slice, allowed: those of a calibrated one");
    }
  }
}

}  // namespace ergotic::tgr
