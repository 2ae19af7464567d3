// A mechanical contact. When it is pressed or released it changes, and then bounces in a pattern determined by a seed.
// Times are clocks of the card, counted by the caller. One thread per object; allocates nothing.
#pragma once

#include <array>
#include <cstdint>

namespace trammel::world {

struct ContactParameters {
  static constexpr unsigned kMostBounces = 8;

  bool normally_closed = false;
  double bounce = 1e-3;  // s, longest time from the first change to the last; 0 to 1; 0: no bouncing
  unsigned bounces = 3;  // number of bounces; 0 to kMostBounces
};

class Contact {
 public:
  static constexpr std::uint64_t kNever = UINT64_MAX;

  // Throws std::invalid_argument for parameters out of range.
  Contact(const ContactParameters& parameters, std::uint32_t clock_hz, std::uint64_t seed);

  // Makes the contact start pressed, and not bouncing.
  void begin_pressed() {
    pressed_ = true;
    closed_ = !normally_closed_;
  }
  // Presses or releases the contact at `clock`: it changes at once, and then bounces. No effect if it is in that state
  // already.
  void set(bool pressed, std::uint64_t clock);
  // Applies all changes up to `clock`.
  void run_to(std::uint64_t clock);

  bool pressed() const { return pressed_; }
  bool closed() const { return closed_; }
  // Clock of the next bounce; kNever if there is none.
  std::uint64_t next_change() const { return next_ < count_ ? changes_[next_] : kNever; }

 private:
  void plan_bounces(std::uint64_t clock);

  bool normally_closed_;
  bool pressed_ = false;
  bool closed_;
  std::uint64_t longest_;  // clocks
  unsigned bounces_;
  std::uint64_t random_;
  std::array<std::uint64_t, 2 * ContactParameters::kMostBounces> changes_{};  // clocks, in order
  unsigned next_ = 0;
  unsigned count_ = 0;
};

}  // namespace trammel::world
