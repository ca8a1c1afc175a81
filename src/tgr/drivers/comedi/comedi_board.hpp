// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <comedilib.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ergotic/tgr/driver.hpp"
#include "tgr/drivers/comedi/comedi_settings.hpp"

namespace ergotic::tgr {

/// Conversion between the volts and the numbers of one channel, linear over its range.
struct ComediScale {
  double low_volts = 0.0;
  double high_volts = 0.0;
  double most = 0.0;  ///< the highest number

  /// Exactly the end of the range at its ends: by this a sensor at its rail is known.
  double toVolts(double count) const noexcept {
    return low_volts + (high_volts - low_volts) * (count / most);
  }
  /// The nearest within the range. \pre volts is a number
  lsampl_t toCount(double volts) const noexcept;
};

/// An open board, its two subdevices locked against other programs.
class ComediBoard {
 public:
  /// Opens it with the safe volts at its outputs, and sees that all channels can be read.
  /// \throws DeviceError saying which board, what failed, and what to do
  explicit ComediBoard(const ComediSettings& settings);
  /// Safe volts, then gives the board back.
  ~ComediBoard();
  ComediBoard(const ComediBoard&) = delete;
  ComediBoard& operator=(const ComediBoard&) = delete;

  /// Runs one list of instructions: every output is written, then every input is read.
  /// \param[in]  outputs  [slices] V, limited to the range; what is not a number is the safe volts
  /// \param[out] inputs   [slices] V; those that were not read are left as they are
  /// \return ExchangeFlag bits. Realtime: yes, if the board's kernel driver is. Thread: tick
  std::uint32_t exchange(const double* outputs, double* inputs) noexcept;

  /// Writes the safe volts to every output. The kernel runs one list after the other, and this one
  /// reads nothing that changes.
  /// \return ExchangeFlag bits. Realtime: as exchange. Thread: any
  std::uint32_t writeSafe() noexcept;

  /// Data for a guardian: the open file, and the instructions that write the safe volts. Realtime:
  /// no
  Guard guard() const;

 private:
  struct Close {
    void operator()(comedi_t* handle) const noexcept { comedi_close(handle); }
  };
  struct Side;  // inputs or outputs

  [[noreturn]] void fail(const std::string& what) const;
  comedi_t* openHandle() const;
  unsigned subdevice(const Side& side) const;
  void checkReference(const Side& side, unsigned subdevice) const;
  unsigned rangeOf(const Side& side, unsigned subdevice, unsigned channel) const;
  std::vector<comedi_range> rangesOf(unsigned subdevice, unsigned channel) const;
  void lock(const Side& side, unsigned subdevice) const;
  /// Instructions of one side, appended to insns_.
  std::vector<ComediScale> setUp(const Side& side, lsampl_t* data);

  ComediSettings settings_;
  std::size_t slices_;
  std::size_t conversions_;  // of a channel
  std::vector<lsampl_t> written_;
  std::vector<lsampl_t> read_;  // [slices][conversions]
  std::vector<lsampl_t> safe_;
  std::vector<comedi_insn> insns_;  // writes, reads
  std::vector<comedi_insn> safe_insns_;
  std::vector<ComediScale> outputs_;
  std::vector<ComediScale> inputs_;
  std::unique_ptr<comedi_t, Close> handle_;
  std::int64_t opened_ns_;
};

}  // namespace ergotic::tgr
