// A bus with posted writes in front of another bus. It hides refusals of the card, like a bridge that acknowledges
// writes itself.
#pragma once

#include "trammel/driver/bus.hpp"

namespace trammel::test {

class PostedBus : public driver::Bus {
 public:
  explicit PostedBus(driver::Bus& bus) : bus_(bus) {}

  std::size_t transfer(driver::Access* accesses, std::size_t count) override {
    for (std::size_t i = 0; i < count; ++i) {
      if (bus_.transfer(&accesses[i], 1) == 0 && !accesses[i].write) accesses[i].data = 0xFFFFFFFF;
    }
    return count;
  }
  void sleep(std::chrono::nanoseconds time) override { bus_.sleep(time); }
  bool reports_refusals() const override { return false; }

 private:
  driver::Bus& bus_;
};

}  // namespace trammel::test
