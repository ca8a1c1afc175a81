// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace ergotic::guardian {

/// Access of a guardian to one device.
class Hold {
 public:
  virtual ~Hold() = default;
  /// Takes the force off, repeatedly if necessary. Returns at once.
  virtual void makeSafe() noexcept = 0;
};

// \param words  after the kind, as in Driver::guards. \throws DeviceError, std::exception
/// A device process: NAME of its shared memory, and BORN_NS of it. Its latch is set, as
/// Driver::makeSafe would.
std::unique_ptr<Hold> holdSharedMemory(const std::vector<std::string>& words);
/// A board: SUBDEVICE CHANNEL COUNT of every output. The counts of no force are written.
/// \param file  the board as the station has opened it: locks of its outputs do not keep us out
std::unique_ptr<Hold> holdComedi(const std::vector<std::string>& words, int file);
/// Ports: SERVER and the full names of what gives forces. All their wires are cut.
std::unique_ptr<Hold> holdJack(const std::vector<std::string>& words);

}  // namespace ergotic::guardian
