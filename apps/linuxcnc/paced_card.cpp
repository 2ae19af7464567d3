#include "paced_card.hpp"

#include <fmt/format.h>

#include <thread>

namespace trammel::app {

void PacedCard::Steps::pin_step(const driver::PinStep& step) {
  if (also_ != nullptr) also_->pin_step(step);
}

void PacedCard::Steps::path_step(const driver::PathStep& step) {
  identity_.path_step(step);
  if (also_ != nullptr) also_->path_step(step);
}

PacedCard::PacedCard(const LocalCardChoice& choice, unsigned axes, driver::StepSink* recorder)
    : steps_(recorder),
      world_(choice.world.make(choice.clock_hz, {})),
      engine_(in_world(world_.get(), sim::make_engine(local_engine(choice, axes)))),
      clock_hz_(choice.clock_hz),
      begun_(std::chrono::steady_clock::now()) {
  engine_->set_sink(&steps_);
}

std::size_t PacedCard::transfer(driver::Access* accesses, std::size_t count) {
  catch_up();
  return engine_->transfer(accesses, count);
}

void PacedCard::sleep(std::chrono::nanoseconds time) {
  std::this_thread::sleep_for(time);
  catch_up();
}

// An access takes clocks of its own: the card may be ahead for a moment.
void PacedCard::catch_up() {
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begun_;
  const auto due = static_cast<std::uint64_t>(passed.count() * clock_hz_);
  if (engine_->cycles() < due) engine_->wait(due - engine_->cycles());
}

std::string PacedCard::path_text() const {
  const run::PathIdentity& path = steps_.identity();
  std::string lockstep;
  if (const auto cycles = engine_->lockstep_cycles()) {
    lockstep = fmt::format("; lockstep: {} cycles, 0 mismatches", *cycles);
  }
  return fmt::format("path: {} steps, of axes and directions {}{}", path.count(), path.order_text(), lockstep);
}

}  // namespace trammel::app
