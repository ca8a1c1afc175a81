// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include <ros/callback_queue_interface.h>

#include "ergotic/station/interlock.hpp"

namespace ergotic::node {

/// State at the time when a call arrived.
struct Arrival {
  std::int64_t time_ns = 0;    ///< CLOCK_MONOTONIC
  station::Ticket ticket = 0;  ///< ticket of the interlock
};

/// Filter in front of a callback queue: it stores the arrival of every call, however long the call
/// waits there. An emergency stop in between is then later than the call, whichever is served
/// first.
class ArrivalQueue : public ::ros::CallbackQueueInterface {
 public:
  /// \param next  outlives this
  ArrivalQueue(::ros::CallbackQueueInterface& next,
               std::shared_ptr<const station::Interlock> interlock)
      : next_(next), interlock_(std::move(interlock)) {}

  void addCallback(const ::ros::CallbackInterfacePtr& callback, std::uint64_t owner) override;
  void removeByID(std::uint64_t owner) override { next_.removeByID(owner); }

  /// Arrival of the call that this thread serves. \pre it came through an ArrivalQueue
  static const Arrival& ofThisCall();

 private:
  ::ros::CallbackQueueInterface& next_;
  std::shared_ptr<const station::Interlock> interlock_;
};

}  // namespace ergotic::node
