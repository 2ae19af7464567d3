// Work on indices 0 .. count - 1 by several threads. Each result belongs to the slot of its index, so it does not
// depend on the order of the threads.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace trammel::measure {

// The threads call `work`. After all threads have ended, the first exception is thrown again here. The calling thread
// calls `progress` with the fraction done.
inline void for_each_index(std::uint64_t count, unsigned threads, const std::function<void(std::uint64_t)>& work,
                           const std::function<void(double)>& progress) {
  std::atomic<std::uint64_t> next{0};
  std::atomic<std::uint64_t> done{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto run = [&] {
    for (std::uint64_t index = next++; index < count; index = next++) {
      try {
        work(index);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!failure) failure = std::current_exception();
      }
      ++done;
    }
  };
  std::vector<std::thread> pool;
  for (unsigned i = 0; i < (threads < 1 ? 1 : threads); ++i) pool.emplace_back(run);
  while (progress && done < count) {
    progress(static_cast<double>(done) / static_cast<double>(count));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  for (std::thread& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace trammel::measure
