// SPDX-License-Identifier: BSD-3-Clause
#include "tgr/drivers/comedi/comedi_board.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <functional>
#include <numeric>
#include <sstream>

#include "ergotic/exception.hpp"
#include "ergotic/rt/clock.hpp"
#include "ergotic/rt/realtime.hpp"

namespace ergotic::tgr {

struct ComediBoard::Side {
  const char* name;
  const char* key;  // of its settings
  int type;
  unsigned insn;
  int subdevice;
  const std::vector<int>& channels;
  const ComediRange& range;
  unsigned reference;
  unsigned flags;  // of a channel
};

namespace {

/// Errors after which the board has to be opened anew.
bool isGone(int error) noexcept {
  return error == ENODEV || error == ENXIO || error == EBADF || error == ESHUTDOWN;
}

std::string adviceOnOpen(int error) {
  switch (error) {
    case EACCES:
    case EPERM:
      return "; you may not use it: Debian's libcomedi gives it to the group `iocard`, so `sudo "
             "adduser $USER iocard` and log in again";
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return "; is it plugged in, is its kernel module loaded (`sudo modprobe`, `dmesg | grep "
             "comedi`), and, if it is no PCI or USB board, was `comedi_config` run?";
    case EBUSY:
      return "; another program uses it";
    default:
      return "; is it a comedi device? `ls -l /dev/comedi*`";
  }
}

std::string textOf(const comedi_range& range) {
  std::ostringstream text;
  text << '[' << range.min << ", " << range.max << "] V";
  return text.str();
}

}  // namespace

ERGOTIC_REALTIME lsampl_t ComediScale::toCount(double volts) const noexcept {
  const double count = std::round((volts - low_volts) / (high_volts - low_volts) * most);
  return static_cast<lsampl_t>(std::clamp(count, 0.0, most));
}

ComediBoard::ComediBoard(const ComediSettings& settings)
    : settings_(settings),
      slices_(settings.ai_channels.size()),
      conversions_(static_cast<std::size_t>(settings.discard + settings.average)),
      written_(slices_),
      read_(slices_ * conversions_),
      safe_(slices_),
      handle_(openHandle()),
      opened_ns_(rt::monotonicNs()) {
  const ComediSettings& s = settings_;
  insns_.reserve(2 * slices_);
  outputs_ = setUp({"output", "ao", COMEDI_SUBD_AO, INSN_WRITE, s.ao_subdevice, s.ao_channels,
                    s.ao_range, s.ao_reference, s.deglitch ? CR_DEGLITCH : 0U},
                   written_.data());
  safe_insns_ = insns_;
  inputs_ = setUp({"input", "ai", COMEDI_SUBD_AI, INSN_READ, s.ai_subdevice, s.ai_channels,
                   s.ai_range, s.ai_reference, 0U},
                  read_.data());
  for (std::size_t i = 0; i < slices_; ++i) {
    const ComediScale& scale = outputs_[i];
    if (s.safe_volts[i] < scale.low_volts || s.safe_volts[i] > scale.high_volts) {
      fail("safe_volts of slice " + std::to_string(i) + " = " + std::to_string(s.safe_volts[i]) +
           " V is not in the range of its output, " +
           textOf({scale.low_volts, scale.high_volts, UNIT_volt}));
    }
    safe_[i] = scale.toCount(s.safe_volts[i]);
    safe_insns_[i].data = &safe_[i];
  }
  std::vector<double> inputs(slices_);
  if (writeSafe() != kExchangeOk || exchange(s.safe_volts.data(), inputs.data()) != kExchangeOk) {
    fail(std::string("its channels cannot be written and read: ") +
         comedi_strerror(comedi_errno()) + "; does another program use them?");
  }
}

ComediBoard::~ComediBoard() {
  writeSafe();
}

void ComediBoard::fail(const std::string& what) const {
  throw DeviceError("comedi board " + settings_.board + ": " + what);
}

comedi_t* ComediBoard::openHandle() const {
  comedi_t* handle = comedi_open(settings_.board.c_str());
  if (handle == nullptr) {
    const int error = comedi_errno();
    fail(std::string("cannot be opened: ") + comedi_strerror(error) + adviceOnOpen(error));
  }
  return handle;
}

unsigned ComediBoard::subdevice(const Side& side) const {
  const std::string what = std::string("analog ") + side.name;
  if (side.subdevice < 0) {
    const int found = comedi_find_subdevice_by_type(handle_.get(), side.type, 0);
    if (found < 0) {
      fail("it has no subdevice for " + what + "; take another board");
    }
    return static_cast<unsigned>(found);
  }
  const auto chosen = static_cast<unsigned>(side.subdevice);
  if (comedi_get_subdevice_type(handle_.get(), chosen) != side.type) {
    const int found = comedi_find_subdevice_by_type(handle_.get(), side.type, 0);
    fail("subdevice " + std::to_string(chosen) + " is none for " + what +
         (found < 0 ? ", nor is any other" : "; the first is " + std::to_string(found)));
  }
  return chosen;
}

void ComediBoard::checkReference(const Side& side, unsigned subdevice) const {
  constexpr std::array<unsigned, 4> kFlags = {SDF_GROUND, SDF_COMMON, SDF_DIFF, SDF_OTHER};
  const auto has = static_cast<unsigned>(comedi_get_subdevice_flags(handle_.get(), subdevice));
  const unsigned any = std::accumulate(kFlags.begin(), kFlags.end(), 0U, std::bit_or<>());
  if ((has & any) != 0 && (has & kFlags[side.reference]) == 0) {  // some kernel drivers tell none
    std::string known;
    for (std::size_t i = 0; i < kFlags.size(); ++i) {
      known += (has & kFlags[i]) != 0 ? " " + kComediReferences[i] : "";
    }
    fail(std::string(side.key) + "_reference " + kComediReferences[side.reference] +
         " is not among those of its analog " + side.name + ":" + known);
  }
  if (side.flags == CR_DEGLITCH && (has & SDF_DEGLITCH) == 0) {
    fail("its outputs cannot deglitch; leave out the setting deglitch");
  }
}

std::vector<comedi_range> ComediBoard::rangesOf(unsigned subdevice, unsigned channel) const {
  std::vector<comedi_range> ranges;
  const int count = comedi_get_n_ranges(handle_.get(), subdevice, channel);
  for (int i = 0; i < count; ++i) {
    const comedi_range* range =
        comedi_get_range(handle_.get(), subdevice, channel, static_cast<unsigned>(i));
    ranges.push_back(range != nullptr ? *range : comedi_range{});
  }
  return ranges;
}

unsigned ComediBoard::rangeOf(const Side& side, unsigned subdevice, unsigned channel) const {
  const std::vector<comedi_range> ranges = rangesOf(subdevice, channel);
  const ComediRange& wanted = side.range;
  constexpr double kToleranceVolts = 1e-6;  // ranges are told in millionths
  int chosen = -1;
  std::string known;
  for (int i = 0; i < static_cast<int>(ranges.size()); ++i) {
    const comedi_range& range = ranges[static_cast<std::size_t>(i)];
    if (range.unit != UNIT_volt || !(range.min < range.max)) {
      continue;
    }
    known += (known.empty() ? "" : ", ") + std::to_string(i) + ": " + textOf(range);
    const bool holds = range.min <= wanted.low_volts + kToleranceVolts &&
                       range.max >= wanted.high_volts - kToleranceVolts;
    const bool narrower =
        chosen < 0 || range.max - range.min < ranges[static_cast<std::size_t>(chosen)].max -
                                                  ranges[static_cast<std::size_t>(chosen)].min;
    if (wanted.index == i || (wanted.index < 0 && holds && narrower)) {
      chosen = i;
    }
  }
  if (chosen < 0) {
    fail(std::string(side.key) + "_range " +
         (wanted.index >= 0 ? std::to_string(wanted.index)
                            : textOf({wanted.low_volts, wanted.high_volts, UNIT_volt})) +
         " does not exist at " + side.name + " channel " + std::to_string(channel) + "; it has " +
         (known.empty() ? "none in volts" : known));
  }
  return static_cast<unsigned>(chosen);
}

void ComediBoard::lock(const Side& side, unsigned subdevice) const {
  if (comedi_lock(handle_.get(), subdevice) != 0) {
    fail(std::string("its analog ") + side.name +
         " cannot be locked: " + comedi_strerror(comedi_errno()) + "; another program uses it");
  }
}

std::vector<ComediScale> ComediBoard::setUp(const Side& side, lsampl_t* data) {
  const unsigned chosen = subdevice(side);
  checkReference(side, chosen);
  lock(side, chosen);
  const int has = comedi_get_n_channels(handle_.get(), chosen);
  const auto samples = side.insn == INSN_READ ? static_cast<unsigned>(conversions_) : 1U;
  std::vector<ComediScale> scales;
  for (const int channel : side.channels) {
    if (channel >= has) {
      fail(std::string(side.key) + "_channels: there is no channel " + std::to_string(channel) +
           ", it has 0..." + std::to_string(has - 1));
    }
    const auto at = static_cast<unsigned>(channel);
    const unsigned range = rangeOf(side, chosen, at);
    const comedi_range volts = rangesOf(chosen, at)[range];
    const lsampl_t most = comedi_get_maxdata(handle_.get(), chosen, at);
    if (most == 0) {
      fail(std::string(side.name) + " channel " + std::to_string(channel) +
           " does not tell its resolution: " + comedi_strerror(comedi_errno()));
    }
    scales.push_back({volts.min, volts.max, static_cast<double>(most)});
    comedi_insn insn{};
    insn.insn = side.insn;
    insn.n = samples;
    insn.data = data;
    insn.subdev = chosen;
    insn.chanspec = CR_PACK_FLAGS(at, range, side.reference, side.flags);
    insns_.push_back(insn);
    data += samples;
  }
  return scales;
}

ERGOTIC_REALTIME std::uint32_t ComediBoard::exchange(const double* outputs,
                                                     double* inputs) noexcept {
  for (std::size_t i = 0; i < slices_; ++i) {
    written_[i] = std::isnan(outputs[i]) ? safe_[i] : outputs_[i].toCount(outputs[i]);
  }
  comedi_insnlist list{static_cast<unsigned>(insns_.size()), insns_.data()};
  const int result = comedi_do_insnlist(handle_.get(), &list);
  if (result < 0 && isGone(comedi_errno())) {
    return kDeviceLost;
  }
  const auto done = static_cast<std::size_t>(std::max(result, 0));
  const std::size_t fresh = std::max(done, slices_) - slices_;
  const auto discarded = static_cast<std::ptrdiff_t>(settings_.discard);
  for (std::size_t i = 0; i < fresh; ++i) {
    const auto first = read_.begin() + static_cast<std::ptrdiff_t>(i * conversions_);
    const double sum =
        std::accumulate(first + discarded, first + static_cast<std::ptrdiff_t>(conversions_), 0.0);
    inputs[i] = inputs_[i].toVolts(sum / settings_.average);
  }
  return (done < slices_ ? kWriteFailed : 0U) | (fresh < slices_ ? kMissingSample : 0U);
}

Guard ComediBoard::guard() const {
  Guard guard{{"comedi"}, comedi_fileno(handle_.get()), opened_ns_};
  for (const comedi_insn& insn : safe_insns_) {
    for (const unsigned number : {insn.subdev, insn.chanspec, *insn.data}) {
      guard.words.push_back(std::to_string(number));
    }
  }
  return guard;
}

ERGOTIC_REALTIME std::uint32_t ComediBoard::writeSafe() noexcept {
  comedi_insnlist list{static_cast<unsigned>(safe_insns_.size()), safe_insns_.data()};
  const int result = comedi_do_insnlist(handle_.get(), &list);
  if (result < 0 && isGone(comedi_errno())) {
    return kDeviceLost;
  }
  return result < static_cast<int>(slices_) ? kWriteFailed : kExchangeOk;
}

}  // namespace ergotic::tgr
