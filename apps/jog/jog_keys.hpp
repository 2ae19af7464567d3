// The meaning of a terminal's keys, and the time for which a key counts as held.
#pragma once

#include <chrono>
#include <cstddef>
#include <string_view>
#include <vector>

namespace trammel::app {

// One key. `axis` and `sign` belong to kMove, `number` to kStep and kSpeed.
struct JogKey {
  enum class Kind { kMove, kStep, kFaster, kSlower, kStop, kEnd, kOther };
  Kind kind = Kind::kOther;
  std::size_t axis = 0;  // axis of the machine, by its position in the machine file
  int sign = 0;
  unsigned number = 0;  // value of the digit

  bool operator==(const JogKey& other) const {
    return kind == other.kind && axis == other.axis && sign == other.sign && number == other.number;
  }
};

// Converts a terminal's bytes to keys: arrows (axes 0 and 1), page up and down (axis 2), [ and ] (axis 3), digits, +
// and -, the space bar, q. An incomplete escape sequence is interpreted as it is; an unknown one is kOther.
std::vector<JogKey> jog_keys(std::string_view bytes);

// A terminal reports that a key is pressed and repeats it, but not that it is released. Therefore a key counts as held
// until its first repeat is due, and then for a shorter time after each repeat. The caller supplies the times.
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
