// A simulated card of this process that follows the host's time in the caller's thread: before each access, and in each
// sleep, its clocks run up to the present time. This is cheaper than a served card, where every transfer is a round
// trip between threads, for which there is no time at one kilohertz. If the process was stopped for at most 2 s, the
// card then has the state of a real one at the present time.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "common/local_card.hpp"
#include "trammel/driver/bus.hpp"
#include "trammel/driver/steps.hpp"
#include "trammel/run/path_identity.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::app {

class PacedCard final : public driver::Bus, private driver::StepSink {
 public:
  // `also`, if given, receives all steps, and must outlive this object. Throws UsageError for a world that cannot be
  // read.
  PacedCard(const LocalCardChoice& choice, unsigned axes, driver::StepSink* also);
  ~PacedCard() override;

  std::size_t transfer(driver::Access* accesses, std::size_t count) override;
  void sleep(std::chrono::nanoseconds time) override;
  bool reports_refusals() const override { return engine_->reports_refusals(); }

  // The number of path steps, and a hash of their order.
  std::string text() const;

 private:
  void catch_up();
  void pin_step(const driver::PinStep& step) override;
  void path_step(const driver::PathStep& step) override;
  void outputs_changed(const driver::OutputChange& change) override;

  std::unique_ptr<world::World> world_;
  std::unique_ptr<sim::Engine> engine_;
  run::PathIdentity path_;
  driver::StepSink* also_;
  std::uint32_t clock_hz_;
  bool fast_;
  std::chrono::steady_clock::time_point begun_;
  std::uint64_t skipped_ = 0;  // clocks that the host had no time to simulate
};

}  // namespace trammel::app
