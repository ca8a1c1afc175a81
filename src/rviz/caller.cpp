// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/caller.hpp"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <thread>

#include <ros/master.h>

namespace ergotic::panel {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kLastWait(1);

}  // namespace

struct Caller::Shared {
  explicit Shared(std::function<void(const Answer&)> tell_answer) : tell(std::move(tell_answer)) {}

  std::function<void(const Answer&)> tell;
  std::mutex mutex;  // of what follows
  std::condition_variable changed;
  std::deque<Job> waiting;
  std::uint64_t era = 0;                                // grows with each cancellation
  std::map<std::string, ::ros::ServiceClient> clients;  // by their services
  ::ros::ServiceClient asked;                           // that has not answered yet
  Clock::time_point give_up = Clock::time_point::max();
  bool quit = false;
  bool has_ended = false;
};

std::string wordsOf(const std_srvs::Trigger::Response& response) {
  return response.message;
}

std::string wordsOf(const LearnController::Response& response) {
  return response.message;
}

std::string wordsOf(const LoadModel::Response& response) {
  const std::string verdict =
      response.verdict.empty() ? "" : " (certificate: " + response.verdict + ")";
  const std::size_t line = response.message.find('\n');
  return line == std::string::npos
             ? response.message + verdict
             : response.message.substr(0, line) + verdict + response.message.substr(line);
}

std::string wordsOf(const Preset::Response& response) {
  return response.message;
}

std::string wordsOf(const Take::Response& response) {
  return response.message;
}

Caller::Caller(std::function<void(const Answer&)> tell)
    : shared_(std::make_shared<Shared>(std::move(tell))) {
  std::thread([shared = shared_] { run(shared); }).detach();
}

Caller::~Caller() {
  std::unique_lock lock(shared_->mutex);
  shared_->quit = true;
  shared_->waiting.clear();
  shared_->asked.shutdown();
  shared_->changed.notify_all();
  shared_->changed.wait_for(lock, kLastWait, [this] { return shared_->has_ended; });
}

void Caller::add(Job job) {
  const std::lock_guard lock(shared_->mutex);
  job.era = shared_->era;
  shared_->waiting.push_back(std::move(job));
  shared_->changed.notify_all();
}

void Caller::forgetWaiting() {
  const std::lock_guard lock(shared_->mutex);
  shared_->waiting.clear();
}

void Caller::cancel() {
  const std::lock_guard lock(shared_->mutex);
  ++shared_->era;
  shared_->waiting.clear();
  shared_->asked.shutdown();
}

void Caller::giveUpLate() {
  const std::lock_guard lock(shared_->mutex);
  if (Clock::now() > shared_->give_up) {
    shared_->give_up = Clock::time_point::max();
    shared_->asked.shutdown();  // who waits for it hears so
  }
}

void Caller::run(const std::shared_ptr<Shared>& shared) {
  std::unique_lock lock(shared->mutex);
  for (;;) {
    shared->changed.wait(lock, [&] { return shared->quit || !shared->waiting.empty(); });
    if (shared->quit) {
      break;
    }
    const Job job = std::move(shared->waiting.front());
    shared->waiting.pop_front();
    lock.unlock();
    const Answer answer = answerTo(job, *shared);
    if (job.call) {
      shared->tell(answer);
    }
    lock.lock();
  }
  shared->clients.clear();
  shared->has_ended = true;
  shared->changed.notify_all();
}

/// Service client of a job. The map of clients belongs to the calling thread alone.
::ros::ServiceClient Caller::connectedTo(const Job& job, Shared& shared) {
  ::ros::ServiceClient& client = shared.clients[job.service];
  if (!client.isValid()) {  // it never was there, or its station is gone
    client = job.find();
  }
  return client;
}

Answer Caller::answerTo(const Job& job, Shared& shared) {
  try {
    Answer answer;
    for (int tries = job.insists ? 2 : 1; tries > 0; --tries) {
      const ::ros::ServiceClient client = connectedTo(job, shared);
      if (!job.call) {
        return {};
      }
      if (!client.isValid()) {
        return {false, job.what + (::ros::master::check()
                                       ? ": there is no " + job.service + ". Does the station run?"
                                       : ": the ROS master does not answer, so that the station "
                                         "cannot be found.")};
      }
      if (call(job, shared, client, answer)) {
        return {answer.ok, job.what + ": " + answer.text};
      }
      shared.clients.erase(job.service);  // roscpp may take it for valid, though it is lost
    }
    return {false, job.what + ": the station did not answer."};
  } catch (const std::exception& failure) {
    return {false, job.what + ": " + failure.what()};
  }
}

/// \return whether it was answered
bool Caller::call(const Job& job, Shared& shared, ::ros::ServiceClient client, Answer& answer) {
  const auto patience = std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * job.patience_s));
  {
    const std::lock_guard lock(shared.mutex);
    if (shared.quit || job.era != shared.era) {
      return false;
    }
    shared.asked = client;
    shared.give_up = Clock::now() + patience;
  }
  const bool answered = job.call(client, answer);
  const std::lock_guard lock(shared.mutex);
  shared.asked = {};
  shared.give_up = Clock::time_point::max();
  return answered;
}

}  // namespace ergotic::panel
