#include "trammel/world/contact.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trammel::world {

namespace {

// SplitMix64 (Steele, Lea, Flood 2014): good random numbers from any seed.
std::uint64_t random_number(std::uint64_t& state) {
  state += 0x9E3779B97F4A7C15U;
  std::uint64_t x = state;
  x = (x ^ x >> 30U) * 0xBF58476D1CE4E5B9U;
  x = (x ^ x >> 27U) * 0x94D049BB133111EBU;
  return x ^ x >> 31U;
}

}  // namespace

Contact::Contact(const ContactParameters& parameters, std::uint32_t clock_hz, std::uint64_t seed)
    : normally_closed_(parameters.normally_closed),
      closed_(parameters.normally_closed),
      longest_(0),
      bounces_(parameters.bounces),
      random_(seed) {
  if (!(parameters.bounce >= 0) || parameters.bounce > 1 || bounces_ > ContactParameters::kMostBounces) {
    throw std::invalid_argument("a contact bounces for 0 to 1 s, and falls back 0 to 8 times");
  }
  longest_ = static_cast<std::uint64_t>(std::llround(parameters.bounce * clock_hz));
}

void Contact::set(bool pressed, std::uint64_t clock) {
  if (pressed == pressed_) return;
  run_to(clock);
  pressed_ = pressed;
  closed_ = normally_closed_ != pressed_;
  plan_bounces(clock);
}

// Plans an even number of further changes, so that the last one restores the level of the first.
void Contact::plan_bounces(std::uint64_t clock) {
  next_ = 0;
  count_ = longest_ == 0 ? 0 : 2 * bounces_;
  for (unsigned n = 0; n < count_; ++n) changes_[n] = clock + 1 + random_number(random_) % longest_;
  std::sort(changes_.begin(), changes_.begin() + count_);
}

void Contact::run_to(std::uint64_t clock) {
  for (; next_ < count_ && changes_[next_] <= clock; ++next_) closed_ = !closed_;
}

}  // namespace trammel::world
