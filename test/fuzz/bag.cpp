// SPDX-License-Identifier: BSD-3-Clause
// Messages of a bag that is whole: rosbag itself is not ours. The bytes are messages, each behind
// its type and its length.
#include <array>
#include <cmath>

#include <ergotic/Event.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/Keyframe.h>
#include <rosbag/bag.h>

#include "bag/raw_message.hpp"
#include "ergotic/bag/positions.hpp"
#include "ergotic/bag/recording.hpp"
#include "fuzz/fuzz.hpp"
#include "fuzz/memory_file.hpp"

namespace ergotic::fuzz {
namespace {

bag::RawMessage messageOf(unsigned type, const std::uint8_t* data, std::size_t size) {
  switch (type % 3) {
    case 0:
      return bag::rawMessage<GestureBlock>(data, size);
    case 1:
      return bag::rawMessage<Keyframe>(data, size);
    default:
      return bag::rawMessage<Event>(data, size);
  }
}

void write(const std::uint8_t* data, std::size_t size, const std::string& path) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  while (size >= 3) {
    const std::size_t length = std::min<std::size_t>(data[1] + 256U * data[2], size - 3);
    if (length > 0) {  // rosbag copies nothing from nowhere
      bag.write("/station", ros::TIME_MIN, messageOf(data[0], data + 3, length));
    }
    data += 3 + length;
    size -= 3 + length;
  }
}

void read(const std::string& path) {
  bag::readRecording(path);
  const auto positions = bag::readPositions(path);
  std::array<double, tgr::kMaxSlices> x{};
  for (int tick = 0; tick < 100 && positions->next(x.data()); ++tick) {
    if (!std::all_of(x.begin(), x.end(), [](double value) { return std::isfinite(value); })) {
      fail("a position that is not finite");
    }
  }
}

}  // namespace
}  // namespace ergotic::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ergotic;
  const fuzz::MemoryFile file;
  fuzz::write(data, size, file.path());
  try {
    fuzz::read(file.path());
  } catch (const Exception&) {
  }
  return 0;
}
