#include "trammel/world/engine_in_world.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "trammel/driver/card_timing.hpp"

namespace trammel::world {

EngineInWorld::EngineInWorld(std::unique_ptr<sim::Engine> engine, World& world)
    : engine_(std::move(engine)), world_(world), clock_hz_(world.clock_hz()) {
  if (sim::kInputs < kMostInputs && world.wired() >> sim::kInputs != 0) {
    throw std::invalid_argument("the world wires inputs that the simulated card does not have: it has 0 to " +
                                std::to_string(sim::kInputs - 1));
  }
  engine_->set_sink(this);
  levels_ = ~world_.levels() & world_.wired();
  set_pins();
}

std::size_t EngineInWorld::transfer(driver::Access* accesses, std::size_t count) {
  catch_up();
  for (std::size_t n = 0; n < count; ++n) {
    const bool made = engine_->transfer(accesses + n, 1) == 1;
    catch_up();
    if (!made) return n;
  }
  return count;
}

void EngineInWorld::sleep(std::chrono::nanoseconds time) {
  wait_or_interrupt(driver::clocks_of(time, clock_hz_, "sleep"));
}

void EngineInWorld::wait(std::uint64_t clocks) {
  catch_up();
  while (clocks != 0) {
    const std::uint64_t quiet = std::min(clocks, world_.quiet_until() - world_.now());
    engine_->wait(quiet);
    clocks -= quiet;
    catch_up();
  }
}

bool EngineInWorld::wait_for_interrupt(std::chrono::nanoseconds longest) {
  if (!has_interrupt()) return Bus::wait_for_interrupt(longest);
  catch_up();
  std::uint64_t left = driver::clocks_of(longest, clock_hz_, "wait");
  for (;;) {
    const std::uint64_t quiet = std::min(left, world_.quiet_until() - world_.now());
    const bool interrupt = engine_->wait_for_interrupt(driver::time_of(quiet, clock_hz_));
    catch_up();
    left -= quiet;
    if (interrupt || left == 0) return interrupt;
  }
}

void EngineInWorld::set_inputs(std::uint32_t levels) {
  engine_->set_inputs((levels & ~world_.wired()) | (levels_ & world_.wired()));
}

void EngineInWorld::set_input(unsigned input, bool level) {
  if (input < kMostInputs && (world_.wired() >> input & 1U) != 0) return;
  engine_->set_input(input, level);
}

void EngineInWorld::set_emergency_stop(bool pressed) {
  if (!world_.has_emergency_stop()) engine_->set_emergency_stop(pressed);
}

void EngineInWorld::reset() {
  catch_up();
  const std::uint64_t before = time();
  engine_->reset();
  constexpr std::uint64_t kReset = 2;  // clocks that a reset takes
  before_reset_ = before + kReset - std::min(before + kReset, engine_->cycles());
  catch_up();
}

void EngineInWorld::pin_step(const driver::PinStep& step) {
  world_.pulse(step.cycle + before_reset_, step.axis, step.direction);
  if (sink_ != nullptr) sink_->pin_step(step);
}

void EngineInWorld::path_step(const driver::PathStep& step) {
  if (sink_ != nullptr) sink_->path_step(step);
}

void EngineInWorld::outputs_changed(const driver::OutputChange& change) {
  if (sink_ != nullptr) sink_->outputs_changed(change);
}

void EngineInWorld::catch_up() {
  world_.run_to(time());
  set_pins();
}

void EngineInWorld::set_pins() {
  const std::uint32_t changed = (levels_ ^ world_.levels()) & world_.wired();
  levels_ = world_.levels();
  for (unsigned input = 0; changed >> input != 0; ++input) {
    if ((changed >> input & 1U) != 0) engine_->set_input(input, (levels_ >> input & 1U) != 0);
  }
  if (!world_.has_emergency_stop() || world_.emergency_stop() == emergency_stop_) return;
  emergency_stop_ = world_.emergency_stop();
  engine_->set_emergency_stop(emergency_stop_);
}

}  // namespace trammel::world
