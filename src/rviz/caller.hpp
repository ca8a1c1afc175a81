// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <std_srvs/Trigger.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <ergotic/LearnController.h>
#include <ergotic/LoadModel.h>
#include <ergotic/Preset.h>
#include <ergotic/Take.h>
#include <ros/node_handle.h>
#include <ros/service_client.h>

namespace ergotic::panel {

/// Answer of a service, in words.
struct Answer {
  bool ok = false;
  std::string text;
};

/// \return answer of the station, as text for a reader
std::string wordsOf(const std_srvs::Trigger::Response& response);
std::string wordsOf(const LearnController::Response& response);
std::string wordsOf(const LoadModel::Response& response);
std::string wordsOf(const Take::Response& response);
std::string wordsOf(const Preset::Response& response);

/// Calls services in a thread of its own, one after the other: a window never waits for a station.
/// Connections are kept: a service that was found once can be called when the ROS master is gone,
/// and roscpp loses answers over others (ros_comm issue 1976).
/// Thread: any; but the own thread calls `tell`
class Caller {
 public:
  /// \param tell  gets every answer
  explicit Caller(std::function<void(const Answer&)> tell);
  /// Gives up what is asked; waits for its thread, a second at most: a ROS master that hangs must
  /// not hang the window.
  ~Caller();
  Caller(const Caller&) = delete;
  Caller& operator=(const Caller&) = delete;

  /// \param what        is asked for, begins the answer: "Engage"
  /// \param service     its full name
  /// \param patience_s  after which no answer is waited for, s
  /// \param insists     asks once more over a new connection if the first was lost: only for what
  /// may
  ///                    come late
  template <class Service>
  void ask(const std::string& what,
           const std::string& service,
           const typename Service::Request& request,
           double patience_s,
           bool insists = false) {
    Job job;
    job.what = what;
    job.service = service;
    job.patience_s = patience_s;
    job.insists = insists;
    job.find = [service] { return find<Service>(service); };
    job.call = [request](::ros::ServiceClient& client, Answer& answer) {
      Service call;
      call.request = request;
      const bool answered = client.call(call);
      answer = {answered && call.response.success != 0U, wordsOf(call.response)};
      return answered;
    };
    add(std::move(job));
  }

  /// Connects to a service that will be asked, if it is there and not connected already.
  template <class Service>
  void prepare(const std::string& service) {
    Job job;
    job.service = service;
    job.find = [service] { return find<Service>(service); };
    add(std::move(job));
  }

  /// Drops the waiting calls, as newer ones replace them.
  void forgetWaiting();
  /// Drops the waiting calls, and gives up the present one, so that none takes effect late.
  void cancel();
  /// Gives up calls without an answer in time. To be called periodically.
  void giveUpLate();

 private:
  struct Job {
    std::string what;
    std::string service;
    double patience_s = 0.0;
    bool insists = false;
    std::uint64_t era = 0;  // of cancellations
    std::function<::ros::ServiceClient()> find;
    std::function<bool(::ros::ServiceClient&, Answer&)> call;  // none: to be prepared
  };
  struct Shared;

  template <class Service>
  static ::ros::ServiceClient find(const std::string& service) {
    constexpr bool kPersistent = true;
    return ::ros::NodeHandle().serviceClient<Service>(service, kPersistent);
  }
  void add(Job job);
  static void run(const std::shared_ptr<Shared>& shared);
  static ::ros::ServiceClient connectedTo(const Job& job, Shared& shared);
  static Answer answerTo(const Job& job, Shared& shared);
  static bool call(const Job& job, Shared& shared, ::ros::ServiceClient client, Answer& answer);

  std::shared_ptr<Shared> shared_;  // with the thread, which may be the last to leave
};

}  // namespace ergotic::panel
