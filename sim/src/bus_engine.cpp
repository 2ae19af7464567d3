#include "bus_engine.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "build_numbers.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/interrupt.hpp"

namespace trammel::sim {

namespace {

using model::CardModel;

// An access takes some ten clocks, a START some hundred. An access that takes longer than this has hung.
constexpr int kMaxAnswerClocks = 100'000;

// A step's direction in the form of the step lists.
std::int8_t sign(int direction) { return static_cast<std::int8_t>(direction < 0 ? -1 : 1); }

[[noreturn]] void throw_unanswered(const driver::Access& access) {
  throw driver::LinkError("simulated bus: no answer to the " + std::string(access.write ? "write" : "read") + " of " +
                          std::to_string(access.address));
}

}  // namespace

std::uint32_t Engine::read(std::uint32_t address) {
  driver::Access access = driver::read_of(address);
  if (transfer(&access, 1) != 1) throw driver::RefusedError(0, 0, address, "simulated bus");
  return access.data;
}

void Engine::write(std::uint32_t address, std::uint32_t value) {
  driver::Access access = driver::write_of(address, value);
  if (transfer(&access, 1) != 1) throw driver::RefusedError(0, 0, address, "simulated bus");
}

bool Engine::wait_or_interrupt(std::uint64_t clocks) {
  constexpr std::uint64_t kPiece = 100'000;  // clocks; they take the Verilated card a tenth of a second
  for (std::uint64_t left = clocks; left != 0; left -= std::min(left, kPiece)) {
    wait(std::min(left, kPiece));
    if (driver::interrupted()) return false;
  }
  return true;
}

std::size_t BusEngine::transfer(driver::Access* accesses, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    note(accesses[i]);
    if (!make(accesses[i])) return i;
  }
  return count;
}

void BusEngine::sleep(std::chrono::nanoseconds time) { wait_or_interrupt(driver::clocks_of(time, clock_hz_, "sleep")); }

// Runs clock by clock, because the line may be raised in any clock.
bool BusEngine::wait_for_interrupt(std::chrono::nanoseconds longest) {
  if (!interrupt_) return Bus::wait_for_interrupt(longest);
  for (std::uint64_t left = driver::clocks_of(longest, clock_hz_, "wait"); left != 0 && !card().outputs().irq; --left) {
    wait(1);
  }
  return card().outputs().irq;
}

bool BusEngine::make(driver::Access& access) {
  if (!access.write) return read_register(access);
  const bool taken = write_register(access);
  if (taken && access.address == card_map::reg::kInputPolarity) pins_ = (pins_ & wired_) | (access.data & ~wired_);
  return taken;
}

bool BusEngine::read_register(driver::Access& access) {
  CardModel::Inputs in;
  in.arvalid = true;
  in.araddr = access.address;
  handshake(
      in, [this] { return card().bus().arready; }, access);
  in = CardModel::Inputs{};
  in.rready = true;
  wait_for([this] { return card().bus().rvalid; }, access);
  const model::Axi4LitePort::Outputs answer = card().bus();
  clock(in);
  if (answer.rresp != model::Axi4LitePort::kOkay) return false;
  access.data = answer.rdata;
  return true;
}

bool BusEngine::write_register(const driver::Access& access) {
  CardModel::Inputs in;
  in.awvalid = true;
  in.wvalid = true;
  in.awaddr = access.address;
  in.wdata = access.data;
  in.wstrb = model::Axi4LitePort::kAllStrobes;
  handshake(
      in, [this] { return card().bus().awready; }, access);
  in = CardModel::Inputs{};
  in.bready = true;
  wait_for([this] { return card().bus().bvalid; }, access);
  const bool taken = card().bus().bresp == model::Axi4LitePort::kOkay;
  clock(in);
  return taken;
}

void BusEngine::reset() {
  CardModel::Inputs in;
  in.rst = true;
  clock(in);
  // The reset is registered, so it lasts one clock longer.
  clock({});
}

void BusEngine::set_sink(driver::StepSink* sink) {
  sink_ = sink;
  card().set_steps(sink != nullptr ? this : nullptr);
}

std::vector<std::int64_t> BusEngine::positions() const {
  std::vector<std::int64_t> result;
  for (unsigned n = 0; n < card().axes(); ++n) result.push_back(static_cast<std::int32_t>(card().position(n)));
  return result;
}

template <class Ready>
void BusEngine::handshake(const CardModel::Inputs& in, Ready ready, const driver::Access& access) {
  for (int i = 0; !ready(); ++i) {
    if (i == kMaxAnswerClocks) throw_unanswered(access);
    clock(in);
  }
  // The edge at which valid and ready meet.
  clock(in);
}

template <class Valid>
void BusEngine::wait_for(Valid valid, const driver::Access& access) {
  for (int i = 0; !valid(); ++i) {
    if (i == kMaxAnswerClocks) throw_unanswered(access);
    clock(CardModel::Inputs{});
  }
}

void BusEngine::pin_step(std::uint64_t cycle, unsigned axis, int direction) {
  sink_->pin_step({cycle, static_cast<std::uint8_t>(axis), sign(direction)});
}

void BusEngine::path_step(std::uint64_t cycle, std::uint64_t command, std::uint64_t tick, unsigned axis,
                          int direction) {
  sink_->path_step({command, tick, static_cast<std::uint8_t>(axis), sign(direction), cycle});
}

void BusEngine::outputs(std::uint64_t cycle, std::uint16_t before, std::uint16_t levels) {
  sink_->outputs_changed({cycle, static_cast<std::uint16_t>(before ^ levels), levels});
}

CardModel::Config config_of(const EngineOptions& options) {
  if (options.axes < 1 || options.axes > card_map::kMaxAxes) throw std::invalid_argument("a card has 1 to 8 axes");
  CardModel::Config config;
  config.axes = options.axes;
  config.clock_hz = options.clock_hz;
  config.engines = model::RegisterFile::kMaxEngines;
  config.inputs = kInputs;
  set_build_numbers(config);
  return config;
}

}  // namespace trammel::sim
