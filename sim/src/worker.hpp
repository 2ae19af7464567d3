// A thread that does jobs in the order in which they are given.
// give() and the destructor belong to one thread; what a job's future has, or throws, may be taken in any.
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
  // The jobs that were given are done first.
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
  std::thread thread_;  // last: it uses the others
};

}  // namespace trammel::sim
