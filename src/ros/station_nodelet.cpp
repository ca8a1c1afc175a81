// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>
#include <ros/callback_queue.h>

#include "ros/device/own_host.hpp"
#include "ros/device/parameters.hpp"
#include "ros/device/signal_guard.hpp"
#include "ros/interface/command_thread.hpp"
#include "ros/interface/console.hpp"
#include "ros/interface/diagnostics.hpp"
#include "ros/interface/parameter_watch.hpp"
#include "ros/interface/polling_spinner.hpp"
#include "ros/interface/publishers.hpp"
#include "ros/interface/services.hpp"

namespace ergotic::node {

/// `ergotic/Station`: a station as a nodelet. Ends with force at zero and the device closed when it
/// is unloaded, and on SIGINT, SIGTERM and SIGHUP.
class StationNodelet : public nodelet::Nodelet {
 public:
  ~StationNodelet() override {
    if (command_thread_) {
      command_thread_->close();  // before anything that may take its time
    }
  }

 private:
  /// Returns at once; models load in a thread of their own. Nothing may be thrown from here: a
  /// nodelet that fails in onInit leaves its name taken.
  void onInit() override {
    try {
      ::ros::NodeHandle shared = getNodeHandle();
      ::ros::NodeHandle node = getPrivateNodeHandle();
      shared.setCallbackQueue(&calls_);
      node.setCallbackQueue(&calls_);
      diagnostics_ = std::make_unique<Diagnostics>(shared, node, getName());
      const EarlyParameters early = readEarlyParameters(node);
      for (const std::string& refusal : early.refusals) {
        NODELET_ERROR_STREAM(refusal << "; until it is put right, what is usual counts");
      }
      publishers_ = std::make_unique<Publishers>(node, early.tf_prefix);
      own_host_ = std::make_unique<OwnHost>(early.allow_remote);
      command_thread_ =
          std::make_unique<CommandThread>(node, *publishers_, *diagnostics_, *own_host_);
      guard_ = std::make_unique<SignalGuard>(
          [this] { command_thread_->makeSafe(tgr::FaultReason::kMadeSafe); },
          [this] { command_thread_->close(); });
      services_ = std::make_unique<Services>(node, *command_thread_);
      parameter_watch_ = std::make_unique<ParameterWatch>(node);
      spinner_.start();
    } catch (const std::exception& failure) {
      NODELET_ERROR_STREAM(failure.what());
    }
  }

  const std::shared_ptr<Console> console_ = Console::ofThisProcess();  // of all that follows
  // Not the queues of nodelet: who is unloaded during a call from these is destroyed after them.
  ::ros::CallbackQueue calls_;
  PollingSpinner spinner_{calls_};
  std::unique_ptr<Diagnostics> diagnostics_;
  std::unique_ptr<Publishers> publishers_;
  std::unique_ptr<OwnHost> own_host_;
  std::unique_ptr<CommandThread> command_thread_;
  std::unique_ptr<Services> services_;
  std::unique_ptr<ParameterWatch> parameter_watch_;
  std::unique_ptr<SignalGuard> guard_;
};

}  // namespace ergotic::node

PLUGINLIB_EXPORT_CLASS(ergotic::node::StationNodelet, nodelet::Nodelet)
