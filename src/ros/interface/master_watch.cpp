// SPDX-License-Identifier: BSD-3-Clause
#include "ros/interface/master_watch.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <ros/connection_manager.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpc.h>

namespace ergotic::node {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kPause = 500ms;
constexpr auto kPatience = 2s;    // with a master that is there but does not answer
constexpr double kSliceS = 0.05;  // for so long the end of the watch goes unnoticed

/// Address of this process's services, as roscpp registers it with the master.
std::string ownAddress() {
  return "rosrpc://" + ::ros::network::getHost() + ":" +
         std::to_string(::ros::ConnectionManager::instance()->getTCPPort());
}

}  // namespace

bool tellsOf(const XmlRpc::XmlRpcValue& answer, const std::string& address) {
  using Value = XmlRpc::XmlRpcValue;
  constexpr int kParts = 3;
  if (answer.getType() != Value::TypeArray || answer.size() != kParts ||
      answer[0].getType() != Value::TypeInt || answer[2].getType() != Value::TypeString) {
    return false;
  }
  return static_cast<const int&>(answer[0]) == 1 &&
         static_cast<const std::string&>(answer[2]) == address;
}

bool tellsOfListener(const XmlRpc::XmlRpcValue& answer,
                     const std::string& topic,
                     const std::string& node) {
  using Value = XmlRpc::XmlRpcValue;
  const auto part = [](const Value& of, int index, Value::Type type) -> const Value* {
    const bool has = of.getType() == Value::TypeArray && of.size() > index;
    return has && of[index].getType() == type ? &of[index] : nullptr;
  };
  const Value* const state = part(answer, 2, Value::TypeArray);
  const Value* const listeners = state == nullptr ? nullptr : part(*state, 1, Value::TypeArray);
  for (int i = 0; listeners != nullptr && i < listeners->size(); ++i) {
    const Value* const name = part((*listeners)[i], 0, Value::TypeString);
    const Value* const nodes = part((*listeners)[i], 1, Value::TypeArray);
    if (name == nullptr || nodes == nullptr || static_cast<const std::string&>(*name) != topic) {
      continue;
    }
    for (int n = 0; n < nodes->size(); ++n) {
      const Value* const listener = part(*nodes, n, Value::TypeString);
      if (listener != nullptr && static_cast<const std::string&>(*listener) == node) {
        return true;
      }
    }
  }
  return false;
}

MasterWatch::MasterWatch(std::vector<std::string> services,
                         std::vector<std::string> topics,
                         std::function<void()> on_lost)
    : services_(std::move(services)),
      topics_(std::move(topics)),
      on_lost_(std::move(on_lost)),
      address_(ownAddress()),
      thread_([this] { run(); }) {}

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
  while (!stopped() && !::ros::isShuttingDown()) {  // which makes safe by itself
    missing_ = !masterKnowsAll();
    if (lost.note(missing_) && !stopped()) {
      on_lost_();
    }
    std::unique_lock lock(mutex_);
    woken_.wait_for(lock, kPause, [this] { return stop_; });
  }
}

bool MasterWatch::masterKnowsAll() {
  XmlRpc::XmlRpcValue state;
  return std::all_of(services_.begin(), services_.end(),
                     [this](const std::string& service) {
                       XmlRpc::XmlRpcValue answer;
                       return ask("lookupService", service, answer) && tellsOf(answer, address_);
                     }) &&
         (topics_.empty() || ask("getSystemState", "", state)) &&
         std::all_of(topics_.begin(), topics_.end(), [&state](const std::string& topic) {
           return tellsOfListener(state, topic, ::ros::this_node::getName());
         });
}

/// Calls the master, with a timeout; ros::master::execute waits for ever for a stopped master.
/// \param argument  second argument, after our name; empty: none
bool MasterWatch::ask(const std::string& method,
                      const std::string& argument,
                      XmlRpc::XmlRpcValue& answer) {
  XmlRpc::XmlRpcClient client(::ros::master::getHost().c_str(),
                              static_cast<int>(::ros::master::getPort()), "/");
  XmlRpc::XmlRpcValue request;
  request[0] = ::ros::this_node::getName();
  if (!argument.empty()) {
    request[1] = argument;
  }
  if (!client.executeNonBlock(method.c_str(), request)) {
    return false;
  }
  const auto end = Clock::now() + kPatience;
  while (!client._disp._sources.empty() && Clock::now() < end && !stopped()) {
    client._disp.work(kSliceS);
  }
  return client.executeCheckDone(answer) && !client.isFault();
}

bool MasterWatch::stopped() {
  const std::lock_guard lock(mutex_);
  return stop_;
}

}  // namespace ergotic::node
