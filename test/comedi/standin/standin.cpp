// SPDX-License-Identifier: BSD-3-Clause
#include "comedi/standin/standin.hpp"

#include <comedilib.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>

#include <sys/syscall.h>

#include "comedi/standin/board.hpp"

struct comedi_t_struct {
  int generation;
};

namespace ergotic::test {
namespace {

thread_local int last_error = 0;
const comedi_t_struct* lock_owner = nullptr;  // of both analog subdevices

int failed(int error) {
  last_error = error;
  return -1;
}

const char* fromEnvironment(const char* name, const char* fallback) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : fallback;
}

/// Says what is wrong and ends the process: there is nobody to throw to.
[[noreturn]] void refuse(const std::string& what) {
  std::fprintf(stderr, "comedi stand-in: %s\n", what.c_str());
  std::exit(2);
}

ComediFault kindNamed(const std::string& name) {
  const char* const names[] = {"short", "eio", "unplug", "stuck", "rail", "slow"};
  for (unsigned i = 0; i < std::size(names); ++i) {
    if (name == names[i]) {
      return static_cast<ComediFault>(i);
    }
  }
  refuse("COMEDI_STANDIN_FAULTS: no fault '" + name +
         "', allowed: short, eio, unplug, stuck, rail, slow");
}

ComediFaultOrder orderOf(const std::string& text) {
  std::istringstream fields(text);
  std::string name;
  std::getline(fields, name, ':');
  ComediFaultOrder order;
  order.kind = kindNamed(name);
  char colon = 0;
  fields >> order.channel >> colon >> order.after >> colon >> order.lists >> colon >> order.amount;
  return order;
}

ComediStandinBoard boardOfEnvironment() {
  ComediStandinBoard board;
  board.rate_hz = std::atof(fromEnvironment("COMEDI_STANDIN_RATE_HZ", "1000"));
  board.gesture_file = fromEnvironment("COMEDI_STANDIN_GESTURE", "");
  return board;
}

std::unique_ptr<StandinBoard> boardOf(const ComediStandinBoard& config) {
  try {
    return std::make_unique<StandinBoard>(config);
  } catch (const std::exception& problem) {
    refuse(problem.what());
  }
}

std::unique_ptr<StandinBoard> firstBoard() {
  auto board = boardOf(boardOfEnvironment());
  std::istringstream faults(fromEnvironment("COMEDI_STANDIN_FAULTS", ""));
  for (std::string fault; std::getline(faults, fault, ',');) {
    board->inject(orderOf(fault));
  }
  return board;
}

std::mutex& boardMutex() {
  static std::mutex mutex;
  return mutex;
}

/// \pre boardMutex() is held
std::unique_ptr<StandinBoard>& board() {
  static std::unique_ptr<StandinBoard> the_board = firstBoard();
  return the_board;
}

bool isAlive(const comedi_t* handle) {
  return board()->isPluggedIn() && handle->generation == board()->generation();
}

}  // namespace
}  // namespace ergotic::test

using namespace ergotic::test;  // NOLINT: the functions below have C names

#define STANDIN_EXPORT __attribute__((visibility("default")))
#define STANDIN_LOCKED const std::lock_guard<std::mutex> guard(boardMutex())

extern "C" {

// libcomedi's functions.

STANDIN_EXPORT comedi_t* comedi_open(const char* path) {
  STANDIN_LOCKED;
  const int error = board()->config().open_error;
  if (error != 0 || !board()->isPluggedIn() || std::strcmp(path, "/dev/comedi0") != 0) {
    failed(error != 0 ? error : ENOENT);
    return nullptr;
  }
  ++board()->counters.opened;
  return new comedi_t_struct{board()->generation()};
}

STANDIN_EXPORT int comedi_close(comedi_t* handle) {
  STANDIN_LOCKED;
  ++board()->counters.closed;
  lock_owner = lock_owner == handle ? nullptr : lock_owner;
  delete handle;
  return 0;
}

STANDIN_EXPORT int comedi_errno() {
  return last_error;
}

STANDIN_EXPORT const char* comedi_strerror(int error) {
  return std::strerror(error);
}

STANDIN_EXPORT int comedi_get_subdevice_type(comedi_t*, unsigned subdevice) {
  constexpr int kTypes[kSubdevices] = {COMEDI_SUBD_DIO, COMEDI_SUBD_AI, COMEDI_SUBD_AO};
  return subdevice < kSubdevices ? kTypes[subdevice] : failed(EINVAL);
}

STANDIN_EXPORT int comedi_find_subdevice_by_type(comedi_t* handle, int type, unsigned first) {
  for (unsigned i = first; i < kSubdevices; ++i) {
    if (comedi_get_subdevice_type(handle, i) == type) {
      return static_cast<int>(i);
    }
  }
  return failed(ENODEV);
}

STANDIN_EXPORT int comedi_get_subdevice_flags(comedi_t*, unsigned subdevice) {
  STANDIN_LOCKED;
  switch (subdevice) {
    case kInputSubdevice:
      return SDF_READABLE | SDF_GROUND | SDF_DIFF;
    case kOutputSubdevice:
      return SDF_WRITABLE | SDF_GROUND | (board()->config().can_deglitch ? SDF_DEGLITCH : 0);
    default:
      return 0;
  }
}

STANDIN_EXPORT int comedi_get_n_channels(comedi_t*, unsigned) {
  STANDIN_LOCKED;
  return board()->config().channels;
}

STANDIN_EXPORT int comedi_get_n_ranges(comedi_t*, unsigned subdevice, unsigned) {
  return static_cast<int>(rangesOf(subdevice).size());
}

STANDIN_EXPORT comedi_range* comedi_get_range(comedi_t*,
                                              unsigned subdevice,
                                              unsigned,
                                              unsigned range) {
  static thread_local comedi_range given;
  if (range >= rangesOf(subdevice).size()) {
    failed(EINVAL);
    return nullptr;
  }
  given = rangesOf(subdevice)[range];
  return &given;
}

STANDIN_EXPORT lsampl_t comedi_get_maxdata(comedi_t*, unsigned, unsigned) {
  return kComediMost;
}

STANDIN_EXPORT int comedi_lock(comedi_t* handle, unsigned) {
  STANDIN_LOCKED;
  if (!isAlive(handle)) {
    return failed(ENODEV);
  }
  if (lock_owner != nullptr && lock_owner != handle) {
    return failed(EACCES);
  }
  lock_owner = handle;
  return 0;
}

STANDIN_EXPORT int comedi_do_insnlist(comedi_t* handle, comedi_insnlist* list) {
  STANDIN_LOCKED;
  const int done = isAlive(handle) ? board()->run(*list) : -ENODEV;
  return done < 0 ? failed(-done) : done;
}

STANDIN_EXPORT int comedi_fileno(comedi_t*) {
  STANDIN_LOCKED;
  return board()->terminals();
}

/// A guardian asks the kernel itself, with the file that it got: its own board has these terminals.
STANDIN_EXPORT int ioctl(int file, unsigned long request, ...) {
  va_list more;
  va_start(more, request);
  void* const argument = va_arg(more, void*);
  va_end(more);
  if (request != COMEDI_INSNLIST) {
    return static_cast<int>(::syscall(SYS_ioctl, file, request, argument));
  }
  STANDIN_LOCKED;
  ::dup2(file, board()->terminals());
  return board()->run(*static_cast<comedi_insnlist*>(argument));
}

// For tests.

STANDIN_EXPORT void comediStandinReset(const ComediStandinBoard* config) {
  STANDIN_LOCKED;
  board() = boardOf(*config);
  lock_owner = nullptr;
}

STANDIN_EXPORT void comediStandinInject(const ComediFaultOrder* order) {
  STANDIN_LOCKED;
  board()->inject(*order);
}

STANDIN_EXPORT void comediStandinPlugIn() {
  STANDIN_LOCKED;
  board()->plugIn();
}

STANDIN_EXPORT void comediStandinHold(int channel, double target_m) {
  STANDIN_LOCKED;
  board()->hold(channel, target_m);
}

STANDIN_EXPORT double comediStandinOutputVolts(int channel) {
  STANDIN_LOCKED;
  return board()->outputVolts(channel);
}

STANDIN_EXPORT void comediStandinCounters(ComediCounters* counters) {
  STANDIN_LOCKED;
  *counters = board()->counters;
}

}  // extern "C"
