#include "worker.hpp"

#include <utility>

namespace trammel::sim {

Worker::Worker() : thread_([this] { work(); }) {}

Worker::~Worker() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    end_ = true;
  }
  given_.notify_one();
  thread_.join();
}

void Worker::give(Job job) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  given_.notify_one();
}

void Worker::work() {
  while (true) {
    std::unique_lock<std::mutex> lock(mutex_);
    given_.wait(lock, [this] { return end_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    job();
  }
}

}  // namespace trammel::sim
