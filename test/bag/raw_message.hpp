// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>

#include <ros/message_traits.h>
#include <ros/serialization.h>

namespace ergotic::bag {

/// Bytes that say that they are a message of some type.
struct RawMessage {
  const char* type;
  const char* md5;
  const char* definition;
  const std::uint8_t* data;
  std::uint32_t size;
};

template <class T>
RawMessage rawMessage(const std::uint8_t* data, std::size_t size) {
  using namespace ros::message_traits;
  return {DataType<T>::value(), MD5Sum<T>::value(), Definition<T>::value(), data,
          static_cast<std::uint32_t>(size)};
}

}  // namespace ergotic::bag

namespace ros {
namespace message_traits {
using ergotic::bag::RawMessage;
template <>
struct MD5Sum<RawMessage> {
  static const char* value(const RawMessage& message) { return message.md5; }
};
template <>
struct DataType<RawMessage> {
  static const char* value(const RawMessage& message) { return message.type; }
};
template <>
struct Definition<RawMessage> {
  static const char* value(const RawMessage& message) { return message.definition; }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<ergotic::bag::RawMessage> {
  template <class Stream>
  static void write(Stream& stream, const ergotic::bag::RawMessage& message) {
    if (message.size > 0) {
      std::memcpy(stream.advance(message.size), message.data, message.size);
    }
  }
  static std::uint32_t serializedLength(const ergotic::bag::RawMessage& message) {
    return message.size;
  }
};
}  // namespace serialization
}  // namespace ros
