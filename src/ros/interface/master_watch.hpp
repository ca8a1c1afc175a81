// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <xmlrpcpp/XmlRpcValue.h>

namespace ergotic::node {

/// Counts consecutive failures: two in a row are reported.
class RepeatedFailure {
 public:
  /// \return whether this one and the one before failed
  bool note(bool failed) noexcept {
    failures_ = failed ? std::min(failures_ + 1, kEnough) : 0;
    return failures_ == kEnough;
  }

 private:
  static constexpr int kEnough = 2;
  int failures_ = 0;
};

/// Whether the master's answer to `lookupService` (code, text, address) says that the service is at
/// this address. Another node may have taken its name since. Realtime: no. Thread: any
bool tellsOf(const XmlRpc::XmlRpcValue& answer, const std::string& address);

/// Whether the master's answer to `getSystemState` (code, text, [publishers, subscribers,
/// services]) lists the node as a subscriber of the topic. Any program may have changed that entry.
/// Realtime: no. Thread: any
bool tellsOfListener(const XmlRpc::XmlRpcValue& answer,
                     const std::string& topic,
                     const std::string& node);

/// Asks the ROS master twice a second, in a thread of its own, for the addresses of the services
/// that end force, and the subscribers of the topics that do: if the master is gone, hangs for two
/// seconds, is a new one that does not know this node, or leads callers to another node, these can
/// no longer be called.
class MasterWatch {
 public:
  /// \param services  full names, advertised by this process
  /// \param topics    full names, which this process listens to
  /// \param on_lost   called from the watch's own thread when the master failed twice in a row, and
  ///                  again each time that it does
  MasterWatch(std::vector<std::string> services,
              std::vector<std::string> topics,
              std::function<void()> on_lost);
  ~MasterWatch();  ///< does not wait for an answer
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

  /// Whether the last question failed. Thread: any
  bool isMissing() const noexcept { return missing_; }

 private:
  void run();
  bool masterKnowsAll();
  bool ask(const std::string& method, const std::string& argument, XmlRpc::XmlRpcValue& answer);
  bool stopped();

  std::vector<std::string> services_;
  std::vector<std::string> topics_;
  std::function<void()> on_lost_;
  const std::string address_;  // roscpp has none any more while it shuts down
  std::mutex mutex_;           // of stop_
  std::condition_variable woken_;
  bool stop_ = false;
  std::atomic<bool> missing_{false};
  std::thread thread_;
};

}  // namespace ergotic::node
