// SPDX-License-Identifier: BSD-3-Clause
// src/preload/priority_inheritance.cpp is linked into this program, as it is preloaded into a
// station.
#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "support/test.hpp"

namespace ergotic::rt {
namespace {

constexpr int kUrgent = 10;  ///< SCHED_FIFO

/// A mutex of pthreads with these attributes (null: the default ones), made as boost makes its own.
class Mutex {
 public:
  explicit Mutex(const pthread_mutexattr_t* attributes = nullptr) {
    EXPECT_EQ(::pthread_mutex_init(&mutex_, attributes), 0);
  }
  Mutex(const Mutex&) = delete;
  Mutex& operator=(const Mutex&) = delete;
  ~Mutex() { EXPECT_EQ(::pthread_mutex_destroy(&mutex_), 0); }

  int lock() { return ::pthread_mutex_lock(&mutex_); }
  int unlock() { return ::pthread_mutex_unlock(&mutex_); }
  pthread_mutex_t* get() { return &mutex_; }

 private:
  pthread_mutex_t mutex_{};
};

/// The priority at which the kernel runs a thread of this process: below zero for real-time ones.
int effectivePriority(pid_t thread) {
  std::ifstream stat("/proc/self/task/" + std::to_string(thread) + "/stat");
  std::string text((std::istreambuf_iterator<char>(stat)), std::istreambuf_iterator<char>());
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  std::string field;
  for (int i = 0; i < 16 && fields >> field;
       ++i) {  // proc(5): field 18, the third is the first here
  }
  return std::stoi(field);
}

/// An urgent thread that waits for `mutex`.
std::thread waitUrgently(Mutex& mutex) {
  std::thread waiter([&mutex] {
    mutex.lock();
    mutex.unlock();
  });
  sched_param parameters{};
  parameters.sched_priority = kUrgent;
  EXPECT_EQ(::pthread_setschedparam(waiter.native_handle(), SCHED_FIFO, &parameters), 0);
  return waiter;
}

/// Whether another thread could lock `mutex`.
bool isFree(Mutex& mutex) {
  bool is_free = false;
  std::thread([&] {
    is_free = ::pthread_mutex_trylock(mutex.get()) == 0;
    if (is_free) {
      mutex.unlock();
    }
  }).join();
  return is_free;
}

bool mayBeUrgent() {
  bool may = false;
  std::thread([&may] {
    sched_param parameters{};
    parameters.sched_priority = kUrgent;
    may = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters) == 0;
  }).join();
  return may;
}

/// The lowest number that the priority of this thread, who holds the mutex, reaches within two
/// seconds.
int priorityWhileAnUrgentOneWaits(Mutex& mutex) {
  const int own = effectivePriority(::gettid());
  mutex.lock();
  std::thread waiter = waitUrgently(mutex);
  int reached = own;
  for (int i = 0; i < 200 && reached == own; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    reached = effectivePriority(::gettid());
  }
  mutex.unlock();
  waiter.join();
  EXPECT_EQ(effectivePriority(::gettid()), own);
  return reached;
}

TEST(PriorityInheritanceTest, WhoHoldsALockRunsAtThePriorityOfWhoWaitsForIt) {
  if (!mayBeUrgent()) {
    GTEST_SKIP() << "no real-time priority for this user";
  }
  Mutex plain;
  EXPECT_EQ(priorityWhileAnUrgentOneWaits(plain), -1 - kUrgent);
  pthread_mutexattr_t recursive;
  ::pthread_mutexattr_init(&recursive);
  ::pthread_mutexattr_settype(&recursive, PTHREAD_MUTEX_RECURSIVE);
  Mutex nested(&recursive);
  EXPECT_EQ(priorityWhileAnUrgentOneWaits(nested), -1 - kUrgent);
}

TEST(PriorityInheritanceTest, AMutexThatProcessesShareStaysAsItsOwnerMadeIt) {
  if (!mayBeUrgent()) {
    GTEST_SKIP() << "no real-time priority for this user";
  }
  pthread_mutexattr_t shared;
  ::pthread_mutexattr_init(&shared);
  ::pthread_mutexattr_setpshared(&shared, PTHREAD_PROCESS_SHARED);
  Mutex mutex(&shared);
  EXPECT_EQ(priorityWhileAnUrgentOneWaits(mutex), effectivePriority(::gettid()));
}

TEST(PriorityInheritanceTest, KindsOfMutexesStayWhatTheyWere) {
  pthread_mutexattr_t attributes;
  ::pthread_mutexattr_init(&attributes);
  ::pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_RECURSIVE);
  Mutex recursive(&attributes);
  EXPECT_EQ(recursive.lock(), 0);
  EXPECT_EQ(recursive.lock(), 0);
  EXPECT_EQ(recursive.unlock(), 0);
  EXPECT_FALSE(isFree(recursive));  // unlocked as often as it was locked, and no sooner
  EXPECT_EQ(recursive.unlock(), 0);
  EXPECT_TRUE(isFree(recursive));

  ::pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_ERRORCHECK);
  Mutex checked(&attributes);
  EXPECT_EQ(checked.lock(), 0);
  EXPECT_EQ(checked.lock(), EDEADLK);
  EXPECT_EQ(checked.unlock(), 0);
}

TEST(PriorityInheritanceTest, AConditionIsHeardUnderSuchAMutex) {
  Mutex mutex;
  pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
  bool told = false;
  std::thread teller([&] {
    mutex.lock();
    told = true;
    ::pthread_cond_signal(&condition);
    mutex.unlock();
  });
  mutex.lock();
  while (!told) {
    EXPECT_EQ(::pthread_cond_wait(&condition, mutex.get()), 0);
  }
  EXPECT_EQ(mutex.unlock(), 0);
  teller.join();
}

}  // namespace
}  // namespace ergotic::rt
