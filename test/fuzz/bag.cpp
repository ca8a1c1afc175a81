// SPDX-License-Identifier: BSD-3-Clause
// Messages of a bag: rosbag, which opens it, is not ours. The bytes are messages, each behind its
// type and its length.
#include <array>
#include <cmath>

#include <ergotic/Event.h>
#include <ergotic/GestureBlock.h>
#include <ergotic/Keyframe.h>

#include "bag/recorded_message.hpp"
#include "ergotic/tgr/driver.hpp"
#include "fuzz/fuzz.hpp"

namespace ergotic::fuzz {
namespace {

template <class T>
bag::RecordedMessage messageOf(const std::uint8_t* data, std::size_t size) {
  return {ros::message_traits::DataType<T>::value(),
          ros::message_traits::MD5Sum<T>::value(),
          {data, data + size}};
}

bag::RecordedMessage messageOf(unsigned type, const std::uint8_t* data, std::size_t size) {
  switch (type % 3) {
    case 0:
      return messageOf<GestureBlock>(data, size);
    case 1:
      return messageOf<Keyframe>(data, size);
    default:
      return messageOf<Event>(data, size);
  }
}

bag::Recording read(const std::uint8_t* data, std::size_t size) {
  bag::Recording recording;
  while (size >= 3) {
    const std::size_t length = std::min<std::size_t>(data[1] + 256U * data[2], size - 3);
    bag::RecordedMessage message = messageOf(data[0], data + 3, length);
    bag::add(recording, message, kFile);
    data += 3 + length;
    size -= 3 + length;
  }
  bag::finish(recording, kFile);
  return recording;
}

void follow(const bag::Recording& recording) {
  const auto positions = bag::positionsOf(recording, kFile);
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
  try {
    fuzz::follow(fuzz::read(data, size));
  } catch (const Exception&) {
  }
  return 0;
}
