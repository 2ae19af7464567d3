// A thread that runs jobs in the order in which they are given. One thread calls give() and the destructor; any thread
// may take a job's result or exception from its future.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <future>
#include <mutex>
#include <thread>

namespace trammel::sim {

class Worker {
 public:
  using Job = std::packaged_task<std::size_t()>;

  Worker();
  // Runs all given jobs first.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void give(Job job);

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable given_;
  std::deque<Job> jobs_;
  bool end_ = false;
  std::thread thread_;  // last member: it uses the others
};

}  // namespace trammel::sim
