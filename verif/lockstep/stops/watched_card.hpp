// A card whose pins are seen in every clock, for a checker that has no other information. It is RTL and golden model
// in lockstep, or the RTL alone, so that the checker can be judged without the model.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "lockstep_card.hpp"

namespace trammel::test {

// The STEP pins and the outputs after a rising edge.
struct StepPins {
  std::uint32_t first = 0;   // step_o, bit n: axis n
  std::uint32_t second = 0;  // dir_o
  std::uint32_t outputs = 0;
};

class WatchedCard {
 public:
  using Inputs = model::CardModel::Inputs;
  using Bus = model::Axi4LitePort::Outputs;
  using Watch = std::function<void(const StepPins&)>;

  virtual ~WatchedCard() = default;

  void run(const Inputs& in, std::uint64_t clocks) {
    for (; clocks != 0; --clocks) {
      clock(in);
      if (watch_) watch_(pins());
    }
  }
  void set_watch(Watch watch) { watch_ = std::move(watch); }
  virtual Bus bus() const = 0;
  virtual StepPins pins() const = 0;
  // Compares the clocks that are still to be compared; throws lockstep::Mismatch.
  virtual void settle() = 0;
  // Clocks in which RTL and model were compared.
  virtual std::uint64_t compared() const = 0;

 protected:
  virtual void clock(const Inputs& in) = 0;

 private:
  Watch watch_;
};

class CardInLockstep : public WatchedCard {
 public:
  CardInLockstep(const sim::CardStraps& straps, const model::CardModel::Config& config, std::uint64_t seed)
      : card_(sim::make_verilated_card(config.axes, straps, std::nullopt), config, seed) {}

  Bus bus() const override { return card_.bus(); }
  StepPins pins() const override {
    const auto& out = card_.model().outputs();
    return {out.step, out.dir, out.output};
  }
  void settle() override { card_.settle(); }
  std::uint64_t compared() const override { return card_.cycles(); }

 protected:
  void clock(const Inputs& in) override { card_.run(in, 1); }

 private:
  sim::LockstepCard card_;
};

class RtlAlone : public WatchedCard {
 public:
  RtlAlone(const sim::CardStraps& straps, unsigned axes) : card_(sim::make_verilated_card(axes, straps, std::nullopt)) {
    Inputs reset;
    reset.rst = true;
    for (unsigned clocks = 0; clocks < 4; ++clocks) clock(reset);
    clock({});
  }

  Bus bus() const override {
    Bus bus;
    bus.awready = record_.awready_o != 0;
    bus.wready = record_.wready_o != 0;
    bus.bvalid = record_.bvalid_o != 0;
    bus.bresp = static_cast<std::uint8_t>(record_.bresp_o);
    bus.arready = record_.arready_o != 0;
    bus.rvalid = record_.rvalid_o != 0;
    bus.rdata = record_.rdata_o;
    bus.rresp = static_cast<std::uint8_t>(record_.rresp_o);
    return bus;
  }
  StepPins pins() const override { return {record_.step_o, record_.dir_o, record_.output_o}; }
  void settle() override {}
  std::uint64_t compared() const override { return 0; }

 protected:
  void clock(const Inputs& in) override { card_->run(in, 1, &record_); }

 private:
  std::unique_ptr<sim::VerilatedCard> card_;
  sim::CardRecord record_;
};

}  // namespace trammel::test
