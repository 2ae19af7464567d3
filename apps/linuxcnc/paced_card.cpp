#include "paced_card.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "trammel/driver/card_timing.hpp"
#include "trammel/sim/engines.hpp"

namespace trammel::app {
namespace {

// Seconds: after a longer stop of the process, the card simulates only this time.
constexpr std::uint64_t kLongestCatchUp = 2;

sim::SimulationOptions paced_engine(const LocalCardChoice& choice, unsigned axes) {
  sim::SimulationOptions options;
  options.kind = choice.engine == "model" ? sim::EngineKind::kModel : sim::EngineKind::kRtl;
  options.axes = axes;
  options.clock_hz = choice.clock_hz;
  return options;
}

}  // namespace

PacedCard::PacedCard(const LocalCardChoice& choice, unsigned axes, driver::StepSink* also)
    : world_(choice.world.make(choice.clock_hz, {})),
      engine_(in_world(world_.get(), sim::make_engine(paced_engine(choice, axes)))),
      also_(also),
      clock_hz_(choice.clock_hz),
      fast_(choice.fast),
      begun_(std::chrono::steady_clock::now()) {
  engine_->set_sink(this);
}

PacedCard::~PacedCard() { engine_->set_sink(nullptr); }

void PacedCard::catch_up() {
  if (fast_) return;
  const std::chrono::nanoseconds passed = std::chrono::steady_clock::now() - begun_;
  const std::uint64_t due = driver::clocks_of(passed, clock_hz_, "time of the simulated card") - skipped_;
  if (due <= engine_->cycles()) return;
  const std::uint64_t late = due - engine_->cycles();
  const std::uint64_t made = std::min(late, clock_hz_ * kLongestCatchUp);
  skipped_ += late - made;
  engine_->wait(made);
}

std::size_t PacedCard::transfer(driver::Access* accesses, std::size_t count) {
  catch_up();
  return engine_->transfer(accesses, count);
}

void PacedCard::sleep(std::chrono::nanoseconds time) {
  if (fast_) return engine_->sleep(time);
  std::this_thread::sleep_for(time);
  catch_up();
}

std::string PacedCard::text() const {
  std::string lockstep;
  if (const auto cycles = engine_->lockstep_cycles()) {
    lockstep = fmt::format("; lockstep: {} cycles, 0 mismatches", *cycles);
  }
  return fmt::format("path: {} steps, of axes and directions {}{}", path_.count(), path_.order_text(), lockstep);
}

void PacedCard::pin_step(const driver::PinStep& step) {
  if (also_ != nullptr) also_->pin_step(step);
}

void PacedCard::path_step(const driver::PathStep& step) {
  path_.path_step(step);
  if (also_ != nullptr) also_->path_step(step);
}

void PacedCard::outputs_changed(const driver::OutputChange& change) {
  if (also_ != nullptr) also_->outputs_changed(change);
}

}  // namespace trammel::app
