// The card as SystemC modules at two levels, the checkers of its ports, and the machine behind it.
#pragma once

#include <functional>
#include <memory>
#include <systemc>

#include "bundles.hpp"
#include "motors.hpp"
#include "pin_models.hpp"
#include "tlm_bus.hpp"
#include "trammel/driver/steps.hpp"
#include "trammel/model/core_model.hpp"

namespace trammel::platform {

// Receives each leading edge at a STEP pin, with the time, s, and the card's clocks since reset.
using PulseSink = std::function<void(double time, const driver::PinStep& step)>;

// The ends of all signals at the card's pins.
template <template <class> class MasterEnd, template <class> class CardEnd>
struct PinPorts {
  sc_core::sc_in<bool> clk{"clk"};
  sc_core::sc_in<bool> rst{"rst"};
  MasterEnd<AxiMaster> axi_master{"axi_master"};
  CardEnd<AxiCard> axi_card{"axi_card"};
  MasterEnd<WishboneMaster> wishbone_master{"wishbone_master"};
  CardEnd<WishboneCard> wishbone_card{"wishbone_card"};
  MasterEnd<SpiMaster> spi_master{"spi_master"};
  CardEnd<SpiCard> spi_card{"spi_card"};
  MasterEnd<bool> rx{"rx"};
  CardEnd<bool> tx{"tx"};

  CardInputs inputs() const {
    return {rst.read(), axi_master.read(), wishbone_master.read(), rx.read(), spi_master.read(), 0};
  }
};

// Pin-accurate: the Verilated card. It writes signals only when they change.
class PinCardModule final : public sc_core::sc_module, public PinPorts<sc_core::sc_in, sc_core::sc_out> {
 public:
  sc_core::sc_in<std::uint32_t> switches{"switches"};
  sc_core::sc_out<std::uint32_t> step{"step"};
  sc_core::sc_out<std::uint32_t> dir{"dir"};
  sc_core::sc_out<std::uint32_t> outputs{"outputs"};
  sc_core::sc_out<bool> irq{"irq"};

  PinCardModule(const sc_core::sc_module_name& name, std::uint32_t clock_hz);
  // Selects the card with the classic Wishbone port. To be called before the simulation begins.
  void set_classic() { classic_ = true; }
  std::uint64_t cycles() const { return cycles_; }

 private:
  void start_of_simulation() override { card_ = make_pin_card(clock_hz_, classic_); }
  void edge();

  std::uint32_t clock_hz_;
  bool classic_ = false;
  std::unique_ptr<PinCard> card_;
  CardOutputs shown_;
  std::uint64_t cycles_ = 0;
};

// The checkers on the same signals.
class CheckerModule final : public sc_core::sc_module, public PinPorts<sc_core::sc_in, sc_core::sc_in> {
 public:
  // `serial_period`: clocks of the card per 8 bits of the serial line.
  CheckerModule(const sc_core::sc_module_name& name, std::uint32_t serial_period);
  PortCheckers& checkers() { return *checkers_; }

 private:
  void edge();

  std::unique_ptr<PortCheckers> checkers_;
};

// The machine on a pin-accurate card: takes pulses from STEP and DIR, drives the inputs with its switches.
class MachineModule final : public sc_core::sc_module {
 public:
  sc_core::sc_in<std::uint32_t> step{"step"};
  sc_core::sc_in<std::uint32_t> dir{"dir"};
  sc_core::sc_out<std::uint32_t> switches{"switches"};

  // `machine` must outlive it.
  MachineModule(const sc_core::sc_module_name& name, Motors& machine);
  void set_sink(PulseSink sink) { sink_ = std::move(sink); }

 private:
  void pulses();
  void time_passes();

  Motors& machine_;
  PulseSink sink_;
  std::uint32_t step_before_ = 0;
};

// Loosely timed: the golden model behind the socket, with the machine on its pins. It runs when it is accessed, and
// once per global quantum, so switches and interrupt may be seen one quantum late. A quantum shorter than a clock
// counts as one clock, one longer than 1 s as 1 s, and none as 100 microseconds.
class LooseCard final : public RegisterTarget, private model::CardSteps {
 public:
  sc_core::sc_out<bool> irq{"irq"};

  // `machine` must outlive it. Throws std::invalid_argument for a clock of 0 Hz.
  LooseCard(const sc_core::sc_module_name& name, std::uint32_t clock_hz, Motors& machine);
  void set_sink(PulseSink sink) { sink_ = std::move(sink); }
  std::uint64_t cycles() const { return card_.cycles(); }

 private:
  std::size_t transfer(driver::Access* accesses, std::size_t count, sc_core::sc_time& delay) override;
  std::size_t peek(driver::Access* reads, std::size_t count) override;
  void run_on();
  void run_to(const sc_core::sc_time& time);
  sc_core::sc_time period() const;
  std::uint64_t cycle_at(const sc_core::sc_time& time) const;
  double time_of(std::uint64_t cycle) const { return static_cast<double>(cycle) / clock_hz_; }
  void pin_step(std::uint64_t cycle, unsigned axis, int direction) override;
  void path_step(std::uint64_t, std::uint64_t, std::uint64_t, unsigned, int) override {}

  std::uint32_t clock_hz_;
  model::CoreModel card_;
  Motors& machine_;
  PulseSink sink_;
  sc_core::sc_event irq_changes_;
};

}  // namespace trammel::platform
