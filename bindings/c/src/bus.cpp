#include <thread>
#include <vector>

#include "handle.hpp"

namespace trammel::c {
namespace {

class CallbackBus final : public driver::Bus {
 public:
  explicit CallbackBus(const trammel_bus& bus) : bus_(bus) {}

  std::size_t transfer(driver::Access* accesses, std::size_t count) override {
    made_.resize(count);
    for (std::size_t i = 0; i < count; ++i) made_[i] = {accesses[i].address, accesses[i].data, accesses[i].write};
    const std::size_t made = bus_.transfer(bus_.context, made_.data(), count);
    if (made == TRAMMEL_BUS_FAILED) throw driver::LinkError(reason());
    if (made > count) throw driver::LinkError("the bus says that it made more accesses than there were");
    for (std::size_t i = 0; i < made; ++i) accesses[i].data = made_[i].data;
    return made;
  }
  void sleep(std::chrono::nanoseconds time) override {
    if (bus_.sleep != nullptr) {
      bus_.sleep(bus_.context, time.count());
    } else {
      std::this_thread::sleep_for(time);
    }
  }
  bool reports_refusals() const override { return bus_.reports_refusals; }

 private:
  std::string reason() const {
    const char* text = bus_.failure != nullptr ? bus_.failure(bus_.context) : nullptr;
    return text != nullptr ? text : "the bus failed";
  }

  trammel_bus bus_;
  std::vector<trammel_access> made_;
};

}  // namespace

std::unique_ptr<driver::Bus> make_callback_bus(const trammel_bus& bus) {
  required(bus.transfer, "bus->transfer");
  return std::make_unique<CallbackBus>(bus);
}

}  // namespace trammel::c
