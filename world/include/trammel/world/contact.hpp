// A mechanical contact: when it is pressed or released it changes, and bounces for a while, in a way that a seed
// decides. Times are clocks of the card, counted by the caller. One object, one thread; allocates nothing.
#pragma once

#include <array>
#include <cstdint>

namespace trammel::world {

struct ContactParameters {
  static constexpr unsigned kMostBounces = 8;

  bool normally_closed = false;
  double bounce = 1e-3;  // s, from the first change to the last at most; 0 to 1: 0 does not bounce
  unsigned bounces = 3;  // times that it falls back; 0 to kMostBounces
};

class Contact {
 public:
  static constexpr std::uint64_t kNever = UINT64_MAX;

  // Throws std::invalid_argument for what is out of range.
  Contact(const ContactParameters& parameters, std::uint32_t clock_hz, std::uint64_t seed);

  // It is pressed already, and at rest.
  void begin_pressed() {
    pressed_ = true;
    closed_ = !normally_closed_;
  }
  // Pressed or released at `clock`: it changes at once, and some times after that. Nothing where it is so already.
  void set(bool pressed, std::uint64_t clock);
  // Makes what has come until then.
  void run_to(std::uint64_t clock);

  bool pressed() const { return pressed_; }
  bool closed() const { return closed_; }
  // Clock of the next change by itself; kNever: it is at rest.
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
