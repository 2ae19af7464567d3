#include "modules.hpp"

#include <algorithm>
#include <stdexcept>

#include "trammel/driver/errors.hpp"
#include "trammel/skip/card.hpp"

namespace trammel::platform {

namespace {

using sc_core::sc_time;
using sc_core::sc_time_stamp;

constexpr double kDefaultPeriod = 100e-6;  // s

// The configuration of the Verilated card of verif/lockstep/frames.
model::CardConfig card_config(std::uint32_t clock_hz) {
  model::CardConfig config;
  config.axes = kAxes;
  config.clock_hz = clock_hz;
  config.engines = model::RegisterFile::kMaxEngines;
  config.ports = 4;
  config.inputs = 2 * kAxes;
  return config;
}

template <class T>
void show(sc_core::sc_out<T>& port, T& shown, const T& now) {
  if (shown == now) return;
  shown = now;
  port.write(now);
}

// Makes the access, for which the card runs some clocks. Returns whether the card accepted it.
bool access_card(model::CoreModel& card, std::uint16_t switches, driver::Access& access) {
  model::CoreModel::Inputs in;
  in.request = true;
  in.write = access.write;
  in.address = access.address;
  in.data = access.data;
  in.pins = switches;
  card.clock(in);
  in.request = false;
  for (int i = 0; !card.answer().ack; ++i) {
    if (i == kLongestAnswer) throw driver::LinkError("loosely timed card: no answer");
    card.clock(in);
  }
  const model::CoreModel::Answer answer = card.answer();
  card.clock(in);  // the next request must come after the answer's clock
  if (!answer.error && !access.write) access.data = answer.data;
  return !answer.error;
}

}  // namespace

PinCardModule::PinCardModule(const sc_core::sc_module_name& name, std::uint32_t clock_hz)
    : sc_module(name), clock_hz_(clock_hz) {
  SC_HAS_PROCESS(PinCardModule);
  SC_METHOD(edge);
  sensitive << clk.pos();
  dont_initialize();
}

void PinCardModule::edge() {
  ++cycles_;
  CardInputs in = inputs();
  in.inputs = static_cast<std::uint16_t>(switches.read());
  CardOutputs out;
  card_->clock(in, out);
  show(axi_card, shown_.axi, out.axi);
  show(wishbone_card, shown_.wishbone, out.wishbone);
  show(spi_card, shown_.spi, out.spi);
  show(tx, shown_.tx, out.tx);
  show(irq, shown_.irq, out.irq);
  if (out.step != shown_.step) step.write(shown_.step = out.step);
  if (out.dir != shown_.dir) dir.write(shown_.dir = out.dir);
  if (out.outputs != shown_.outputs) outputs.write(shown_.outputs = out.outputs);
}

CheckerModule::CheckerModule(const sc_core::sc_module_name& name, std::uint32_t serial_period)
    : sc_module(name), checkers_(make_port_checkers()) {
  SC_HAS_PROCESS(CheckerModule);
  SC_METHOD(edge);
  sensitive << clk.pos();
  dont_initialize();
  checkers_->set_serial_period(serial_period);
}

void CheckerModule::edge() {
  CardOutputs out;
  out.axi = axi_card.read();
  out.wishbone = wishbone_card.read();
  out.spi = spi_card.read();
  out.tx = tx.read();
  checkers_->clock(inputs(), out);
}

MachineModule::MachineModule(const sc_core::sc_module_name& name, Motors& machine)
    : sc_module(name), machine_(machine) {
  SC_HAS_PROCESS(MachineModule);
  SC_METHOD(pulses);
  sensitive << step;
  dont_initialize();
  SC_METHOD(time_passes);
}

// A high DIR is the negative direction.
void MachineModule::pulses() {
  const std::uint32_t rises = step.read() & ~step_before_;
  step_before_ = step.read();
  const double now = sc_time_stamp().to_seconds();
  for (unsigned axis = 0; axis < kAxes; ++axis) {
    if ((rises >> axis & 1) == 0) continue;
    const int direction = (dir.read() >> axis & 1) != 0 ? -1 : 1;
    machine_.pulse(now, axis, direction);
    if (sink_) sink_(now, {0, static_cast<std::uint8_t>(axis), static_cast<std::int8_t>(direction)});
  }
}

void MachineModule::time_passes() {
  machine_.run_to(sc_time_stamp().to_seconds());
  switches.write(machine_.switches());
  next_trigger(Motors::kStep, sc_core::SC_SEC);
}

LooseCard::LooseCard(const sc_core::sc_module_name& name, std::uint32_t clock_hz, Motors& machine)
    : RegisterTarget(name), clock_hz_(clock_hz), card_(card_config(clock_hz)), machine_(machine) {
  if (clock_hz == 0) throw std::invalid_argument("a card with a clock of 0 Hz never runs");
  SC_HAS_PROCESS(LooseCard);
  SC_METHOD(run_on);
  card_.set_steps(this);
}

void LooseCard::pin_step(std::uint64_t cycle, unsigned axis, int direction) {
  const double time = time_of(cycle);
  machine_.pulse(time, axis, direction);
  if (sink_) sink_(time, {cycle, static_cast<std::uint8_t>(axis), static_cast<std::int8_t>(direction)});
}

void LooseCard::run_on() {
  run_to(sc_time_stamp());
  irq.write(card_.outputs().irq);
  next_trigger(period(), irq_changes_);
}

// A period of 0 would be called for ever without time advancing; one beyond the end of SystemC's time would never be
// called again.
sc_time LooseCard::period() const {
  const sc_time quantum = tlm_utils::tlm_quantumkeeper::get_global_quantum();
  if (quantum == sc_core::SC_ZERO_TIME) return sc_time(kDefaultPeriod, sc_core::SC_SEC);
  return std::clamp(quantum, sc_time(time_of(1), sc_core::SC_SEC), sc_time(1, sc_core::SC_SEC));
}

std::uint64_t LooseCard::cycle_at(const sc_time& time) const {
  return static_cast<std::uint64_t>(time.to_seconds() * clock_hz_ + 0.5);
}

// Runs in steps of a period, with the switches of the start of each step.
void LooseCard::run_to(const sc_time& time) {
  const std::uint64_t end = cycle_at(time);
  const std::uint64_t most = std::max<std::uint64_t>(1, cycle_at(period()));
  while (card_.cycles() < end) {
    skip::run(card_, std::min(most, end - card_.cycles()), machine_.switches());
    machine_.run_to(time_of(card_.cycles()));
  }
}

std::size_t LooseCard::transfer(driver::Access* accesses, std::size_t count, sc_time& delay) {
  run_to(sc_time_stamp() + delay);
  const std::uint64_t before = card_.cycles();
  std::size_t made = 0;
  while (made < count && access_card(card_, machine_.switches(), accesses[made])) ++made;
  delay += sc_time(time_of(card_.cycles() - before), sc_core::SC_SEC);
  if (card_.outputs().irq != irq.read()) irq_changes_.notify(sc_core::SC_ZERO_TIME);
  return made;
}

// The reads are made on a copy of the card.
std::size_t LooseCard::peek(driver::Access* reads, std::size_t count) {
  model::CoreModel now = card_;
  now.set_steps(nullptr);
  const std::uint64_t end = cycle_at(sc_time_stamp());
  if (now.cycles() < end) skip::run(now, end - now.cycles(), machine_.switches());
  for (std::size_t i = 0; i < count; ++i) {
    model::CoreModel asked = now;
    if (!access_card(asked, machine_.switches(), reads[i])) return i;
  }
  return count;
}

}  // namespace trammel::platform
