// Which line of the program the card is at: the lines of the commands that went to its geometry queue, as many as the
// queue can hold. Internal to the runner.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace trammel::run {

class LineRing {
 public:
  // `most`: commands that can be on their way without having begun, at least 1.
  explicit LineRing(std::size_t most) : lines_(most) {}

  // The line of the next command for the geometry queue.
  void put(std::size_t line) { lines_[slot(put_++)] = line; }

  // The card's count of commands begun, which wraps at 2^32; it grows by less than that from call to call.
  void begun(std::uint32_t count) { begun_ += count - static_cast<std::uint32_t>(begun_); }

  // Line of the command that has begun last; of the first one before that, 0 before anything was put. Of commands so
  // far back that the ring has lost them: the oldest line that it has.
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
