// Finds the program line that the card is executing: stores the lines of the commands sent to the geometry queue, as
// many as the queue can hold. Internal to the runner.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace trammel::run {

class LineRing {
 public:
  // `most`: the largest number of commands sent and not yet begun, at least 1.
  explicit LineRing(std::size_t most) : lines_(most) {}

  // Stores the line of the next command for the geometry queue.
  void put(std::size_t line) { lines_[slot(put_++)] = line; }

  // Takes the card's count of begun commands, which wraps at 2^32; it grows by less than that between two calls.
  void begun(std::uint32_t count) { begun_ += count - static_cast<std::uint32_t>(begun_); }

  // Line of the command that has begun last. Before the first has begun, line of the first command; 0 if none was
  // stored. For a command that the ring has already overwritten, the oldest stored line.
  std::size_t current() const {
    if (put_ == 0) return 0;
    const std::uint64_t oldest = put_ > lines_.size() ? put_ - lines_.size() : 0;
    const std::uint64_t number = std::clamp(std::max<std::uint64_t>(begun_, 1) - 1, oldest, put_ - 1);
    return lines_[slot(number)];
  }

 private:
  std::size_t slot(std::uint64_t number) const { return static_cast<std::size_t>(number % lines_.size()); }

  std::vector<std::size_t> lines_;
  std::uint64_t put_ = 0;
  std::uint64_t begun_ = 0;
};

}  // namespace trammel::run
