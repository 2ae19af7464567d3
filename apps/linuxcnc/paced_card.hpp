// A simulated card in this process and thread, at the pace of the wall clock: it catches up before each access and
// behind each sleep. A card in a thread of its own behind a socket, as LocalCard is, costs two changes of thread per
// access; a servo period of a millisecond has some ten of them.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "common/local_card.hpp"
#include "trammel/driver/bus.hpp"
#include "trammel/run/path_identity.hpp"
#include "trammel/sim/engine.hpp"
#include "trammel/world/world.hpp"

namespace trammel::app {

class PacedCard final : public driver::Bus {
 public:
  // `axes`: 1 to 8. `recorder`, which may be null and must outlive it, gets all steps. Throws UsageError for a world
  // that cannot be read.
  PacedCard(const LocalCardChoice& choice, unsigned axes, driver::StepSink* recorder);

  std::size_t transfer(driver::Access* accesses, std::size_t count) override;
  void sleep(std::chrono::nanoseconds time) override;
  bool reports_refusals() const override { return engine_->reports_refusals(); }

  // How many steps it has made on the path, and a number for their order.
  std::string path_text() const;

 private:
  class Steps final : public driver::StepSink {
   public:
    explicit Steps(driver::StepSink* also) : also_(also) {}
    void pin_step(const driver::PinStep& step) override;
    void path_step(const driver::PathStep& step) override;
    const run::PathIdentity& identity() const { return identity_; }

   private:
    driver::StepSink* also_;
    run::PathIdentity identity_;
  };

  void catch_up();

  Steps steps_;
  std::unique_ptr<world::World> world_;
  std::unique_ptr<sim::Engine> engine_;
  std::uint32_t clock_hz_;
  std::chrono::steady_clock::time_point begun_;
};

}  // namespace trammel::app
