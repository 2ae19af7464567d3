// What a terminal's keys ask for, and how long a key counts as held.
#pragma once

#include <chrono>
#include <cstddef>
#include <string_view>
#include <vector>

namespace trammel::app {

// One key. `axis` and `sign` are of kMove, `number` of kStep and kSpeed.
struct JogKey {
  enum class Kind { kMove, kStep, kFaster, kSlower, kStop, kEnd, kOther };
  Kind kind = Kind::kOther;
  std::size_t axis = 0;  // of the machine, by its place in the machine file
  int sign = 0;
  unsigned number = 0;  // of a digit

  bool operator==(const JogKey& other) const {
    return kind == other.kind && axis == other.axis && sign == other.sign && number == other.number;
  }
};

// The keys of a terminal's bytes: arrows (axes 0 and 1), page up and down (axis 2), [ and ] (axis 3), digits, + and -,
// the space bar, q. A sequence of escape that is cut is taken for what it is so far; what is unknown is kOther.
std::vector<JogKey> jog_keys(std::string_view bytes);

// A terminal tells that a key is pressed and repeats it, never that it is released. So a key counts as held until its
// first repeat is due, and from then on for a shorter time after each repeat. Times are the caller's.
class DeadMan {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::milliseconds kToFirstRepeat{700};
  static constexpr std::chrono::milliseconds kToNextRepeat{200};

  void press(Time now) { until_ = now + kToFirstRepeat; }
  void repeat(Time now) { until_ = now + kToNextRepeat; }
  bool released(Time now) const { return now >= until_; }

 private:
  Time until_{};
};

}  // namespace trammel::app
