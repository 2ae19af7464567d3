#include "trammel/run/attentive_bus.hpp"

#include <algorithm>

namespace trammel::run {

void AttentiveBus::sleep(std::chrono::nanoseconds time) {
  do {
    const std::chrono::nanoseconds part = std::min(time, longest_);
    bus_.sleep(part);
    time -= part;
    if (!meanwhile_ || inside_) continue;
    inside_ = true;
    try {
      meanwhile_();
    } catch (...) {
      inside_ = false;
      throw;
    }
    inside_ = false;
  } while (time.count() > 0);
}

}  // namespace trammel::run
