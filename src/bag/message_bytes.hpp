// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include <ros/serialization.h>

namespace ergotic::bag {

/// The bytes of a message, in which no list is longer than what is left of them: ROS by itself
/// makes room for whatever a list says that it has, and then looks.
class MessageBytes : public ros::serialization::IStream {
 public:
  MessageBytes(std::uint8_t* data, std::uint32_t size) : IStream(data, size) {}

  /// \throws ros::serialization::StreamOverrunException
  template <class T>
  void next(T& value) {
    ros::serialization::deserialize(*this, value);
  }
  template <class T>
  void next(std::vector<T>& list) {
    std::uint32_t size = 0;
    if (getLength() >= sizeof size) {
      std::memcpy(&size, getData(), sizeof size);
    }
    if (size > getLength()) {
      ros::serialization::throwStreamOverrun();
    }
    ros::serialization::deserialize(*this, list);
  }
};

}  // namespace ergotic::bag
