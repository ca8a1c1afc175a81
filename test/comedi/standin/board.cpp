// SPDX-License-Identifier: BSD-3-Clause
#include "comedi/standin/board.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include <sys/mman.h>
#include <sys/syscall.h>

#include "support/passing_call.hpp"

namespace ergotic::test {
namespace {

using Clock = std::chrono::steady_clock;

tgr::VirtualDriverConfig bankOf(const ComediStandinBoard& config) {
  tgr::VirtualDriverConfig bank;
  bank.slices = config.channels;
  bank.slice = config.slice;
  bank.gesture_file = config.gesture_file;
  return bank;
}

/// A file that COMEDI_STANDIN_TERMINALS names, or one without a name.
int openTerminals() {
  const char* const path = std::getenv("COMEDI_STANDIN_TERMINALS");
  return path != nullptr ? ::open(path, O_RDWR | O_CREAT, 0600) : ::memfd_create("terminals", 0);
}

int nextGeneration() {
  static int last = 0;
  return ++last;
}

Clock::duration secondsOf(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

bool reads(const comedi_insnlist& list) {
  return std::any_of(list.insns, list.insns + list.n_insns,
                     [](const comedi_insn& insn) { return insn.insn == INSN_READ; });
}

}  // namespace

const std::vector<comedi_range>& rangesOf(unsigned subdevice) {
  static const std::vector<comedi_range> inputs = {
      {-10.0, 10.0, UNIT_volt}, {-5.0, 5.0, UNIT_volt}, {0.0, 10.0, UNIT_volt}};
  static const std::vector<comedi_range> outputs = {{-10.0, 10.0, UNIT_volt},
                                                    {0.0, 20.0, UNIT_mA},
                                                    {-5.0, 5.0, UNIT_volt},
                                                    {0.0, 10.0, UNIT_volt}};
  static const std::vector<comedi_range> none;
  return subdevice == kInputSubdevice ? inputs : subdevice == kOutputSubdevice ? outputs : none;
}

StandinBoard::StandinBoard(const ComediStandinBoard& config)
    : config_(config),
      bank_(bankOf(config)),
      outputs_(static_cast<std::size_t>(config.channels), config.no_force_volts),
      sensed_(outputs_.size()),
      stuck_(outputs_.size()),
      railed_(outputs_.size()),
      generation_(nextGeneration()),
      terminals_(openTerminals()) {
  bank_.start(1.0 / config.rate_hz, config.rate_hz);
}

StandinBoard::~StandinBoard() {
  ::close(terminals_);
}

bool StandinBoard::isPluggedIn() {
  if (!plugged_ && Clock::now() >= back_) {
    plugIn();
  }
  return plugged_;
}

void StandinBoard::plugIn() {
  plugged_ = true;
  generation_ = nextGeneration();
  faults_.clear();
}

void StandinBoard::step() {
  std::array<double, tgr::kMaxSlices> forces{};
  std::array<double, tgr::kMaxSlices> positions{};
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    forces[i] = config_.newtons_per_volt * (outputs_[i] - config_.no_force_volts);
  }
  bank_.step(forces.data());
  bank_.read(positions.data());
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (!stuck_[i]) {
      sensed_[i] = config_.rest_volts + positions[i] / config_.metres_per_volt;
    }
  }
}

StandinBoard::Trouble StandinBoard::meetFaults(const comedi_insnlist& list) {
  Trouble trouble{0, list.n_insns, 0.0};
  std::fill(stuck_.begin(), stuck_.end(), false);
  std::fill(railed_.begin(), railed_.end(), false);
  for (ComediFaultOrder& fault : faults_) {
    if (fault.after-- > 0 || fault.lists == 0) {
      continue;
    }
    fault.lists -= fault.lists > 0 ? 1 : 0;
    const auto channel = static_cast<std::size_t>(fault.channel);
    switch (fault.kind) {
      case ComediFault::kShort:
        trouble.instructions = std::min(list.n_insns, static_cast<unsigned>(fault.amount));
        break;
      case ComediFault::kError:
        trouble.error = EIO;
        break;
      case ComediFault::kUnplug:
        plugged_ = false;
        back_ =
            fault.amount > 0.0 ? Clock::now() + secondsOf(fault.amount) : Clock::time_point::max();
        trouble.error = ENODEV;
        break;
      case ComediFault::kStuck:
        stuck_[channel] = true;
        break;
      case ComediFault::kRail:
        railed_[channel] = true;
        break;
      case ComediFault::kSlow:
        trouble.delay_s = fault.amount;
        break;
    }
  }
  return trouble;
}

int StandinBoard::run(comedi_insnlist& list) {
  ++counters.lists;
  Trouble trouble{0, list.n_insns, 0.0};
  if (reads(list)) {
    ++counters.reading_lists;
    trouble = meetFaults(list);
    step();
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(trouble.delay_s));
  if (trouble.error != 0) {
    return -trouble.error;
  }
  for (unsigned i = 0; i < trouble.instructions; ++i) {
    const int error = execute(list.insns[i]);
    if (error != 0) {
      return -error;
    }
  }
  return static_cast<int>(trouble.instructions);
}

/// \return 0 or an errno
int StandinBoard::execute(const comedi_insn& insn) {
  const unsigned channel = CR_CHAN(insn.chanspec);
  const std::vector<comedi_range>& ranges = rangesOf(insn.subdev);
  const unsigned range = CR_RANGE(insn.chanspec);
  const unsigned kind = insn.subdev == kInputSubdevice ? INSN_READ : INSN_WRITE;
  if (channel >= outputs_.size() || range >= ranges.size() || insn.insn != kind || insn.n < 1) {
    return EINVAL;
  }
  return kind == INSN_READ ? read(channel, ranges[range], insn)
                           : write(channel, ranges[range], insn);
}

int StandinBoard::write(unsigned channel, const comedi_range& range, const comedi_insn& insn) {
  const lsampl_t count = insn.data[insn.n - 1];
  if (count > kComediMost || range.unit != UNIT_volt) {
    return EINVAL;
  }
  const double volts = comediVolts(count, range.min, range.max);
  outputs_[channel] = volts;
  const auto at = static_cast<off_t>(channel * sizeof volts);
  const auto written = ::syscall(SYS_pwrite64, terminals_, &volts, sizeof volts, at, 0L,
                                 kPassingCall);  // it stands for the board's own system call
  return written == sizeof volts ? 0 : EIO;
}

int StandinBoard::read(unsigned channel, const comedi_range& range, const comedi_insn& insn) {
  const double volts = railed_[channel] ? range.max : sensed_[channel];
  const double count = std::round((volts - range.min) / (range.max - range.min) * kComediMost);
  const double most = kComediMost;
  std::fill_n(insn.data, insn.n, static_cast<lsampl_t>(std::clamp(count, 0.0, most)));
  return 0;
}

}  // namespace ergotic::test
