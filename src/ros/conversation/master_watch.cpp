// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversation/master_watch.hpp"

#include <chrono>
#include <utility>

#include <ros/master.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpc.h>

namespace ergotic::node {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kPause = 500ms;
constexpr auto kPatience = 2s;    // with a master that is there but does not answer
constexpr double kSliceS = 0.05;  // for so long the end of the watch goes unnoticed

}  // namespace

MasterWatch::MasterWatch(std::string service, std::function<void()> on_lost)
    : service_(std::move(service)), on_lost_(std::move(on_lost)), thread_([this] { run(); }) {}

MasterWatch::~MasterWatch() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  woken_.notify_all();
  thread_.join();
}

void MasterWatch::run() {
  RepeatedFailure lost;
  while (!stopped()) {
    missing_ = !masterKnows();
    if (lost.note(missing_) && !stopped()) {
      on_lost_();
    }
    std::unique_lock lock(mutex_);
    woken_.wait_for(lock, kPause, [this] { return stop_; });
  }
}

/// Not by ros::master::execute, which waits for ever for a master that was stopped.
bool MasterWatch::masterKnows() {
  XmlRpc::XmlRpcClient client(::ros::master::getHost().c_str(),
                              static_cast<int>(::ros::master::getPort()), "/");
  XmlRpc::XmlRpcValue request;
  request[0] = ::ros::this_node::getName();
  request[1] = service_;
  if (!client.executeNonBlock("lookupService", request)) {
    return false;
  }
  const auto end = Clock::now() + kPatience;
  while (!client._disp._sources.empty() && Clock::now() < end && !stopped()) {
    client._disp.work(kSliceS);
  }
  XmlRpc::XmlRpcValue response;  // code, text, address
  return client.executeCheckDone(response) && !client.isFault() &&
         response.getType() == XmlRpc::XmlRpcValue::TypeArray && response.size() > 0 &&
         response[0].getType() == XmlRpc::XmlRpcValue::TypeInt &&
         static_cast<int>(response[0]) == 1;
}

bool MasterWatch::stopped() {
  const std::lock_guard lock(mutex_);
  return stop_;
}

}  // namespace ergotic::node
