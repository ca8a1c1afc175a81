// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <istream>
#include <map>
#include <string>
#include <vector>

#include "scene/limits.hpp"
#include "scene/text/csv.hpp"

namespace ergotic::scene {

/// Reads a gesture file row by row. There are two kinds:
///
/// - `time_s,slice,target_m`, a line that may stand on top: where one slice wants to be at a time.
///   The rows of a slice come in increasing time; slices may interleave. A row `time_s,$name,value`
///   sets the parameter `name` of a scene instead, as if that were a slice.
/// - `tick,x0,x1,...`, a line that must stand on top: where all slices were at a tick. Ticks
///   increase.
class GestureReader {
 public:
  /// \param slices  most of them that a file may name
  /// \param metres  of targets and positions
  /// \throws TextError if the text does not begin as either kind
  GestureReader(std::istream& in, const std::string& file, int slices, const Limits& metres);

  bool isInTicks() const { return in_ticks_; }  ///< the second kind
  int slices() const { return slices_; }  ///< slices that have columns; of the first kind: most

  /// Goes to the next row. \return false at the end \throws TextError
  bool next();
  double time() const { return time_; }  ///< s, or a tick
  int slice() const { return slice_; }   ///< slice of a target; kNoSlice: the row sets a parameter
  double target() const { return x_.front(); }
  bool isParameter() const { return slice_ == kNoSlice; }
  const std::string& parameter() const { return parameter_; }  ///< its name, without the `$`
  double value() const { return x_.front(); }                  ///< value of the parameter, finite
  Place place(std::size_t field) const { return csv_.place(field); }
  const std::vector<double>& positions() const { return x_; }  ///< [slices]

  /// Fails at the first field of the row. \throws TextError
  [[noreturn]] void fail(const std::string& what) const { csv_.fail(0, what); }
  /// Fails at the line that was read last. \throws TextError
  [[noreturn]] void failAtLine(const std::string& what) const { csv_.failAtLine(what); }

 private:
  void readHeader();
  void readColumns();
  void readPositions();
  void readTarget();
  void readValue();
  void requireLater(double& last_s, const std::string& whose) const;

  static constexpr int kNoSlice = -1;
  CsvReader csv_;
  Limits metres_;
  int slices_;
  bool in_ticks_ = false;
  bool has_row_ = false;  ///< the first one was no header
  double time_ = -1.0;
  int slice_ = 0;
  std::vector<double> x_;
  std::string parameter_;
  std::vector<double> last_s_;                  ///< last times of targets, [slices]
  std::map<std::string, double> last_value_s_;  ///< last times of parameters
};

}  // namespace ergotic::scene
