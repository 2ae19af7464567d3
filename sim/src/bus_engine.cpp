#include "bus_engine.hpp"

#include <stdexcept>

namespace trammel::sim {

namespace {

using model::CardModel;

// An access takes some ten clocks, a START some hundred; one that takes more has hung.
constexpr int kPatience = 100'000;

// A step's direction as the lists have it.
std::int8_t sign(int direction) { return static_cast<std::int8_t>(direction < 0 ? -1 : 1); }

}  // namespace

std::uint32_t BusEngine::read(std::uint32_t address) {
  CardModel::Inputs in;
  in.arvalid = true;
  in.araddr = address;
  handshake(
      in, [this] { return card().bus().arready; }, address, driver::Direction::kRead);
  in = CardModel::Inputs{};
  in.rready = true;
  wait_for([this] { return card().bus().rvalid; }, address, driver::Direction::kRead);
  const model::Axi4LitePort::Outputs answer = card().bus();
  clock(in);
  if (answer.rresp != model::Axi4LitePort::kOkay) throw driver::BusError(address, driver::Direction::kRead);
  return answer.rdata;
}

void BusEngine::write(std::uint32_t address, std::uint32_t value) {
  CardModel::Inputs in;
  in.awvalid = true;
  in.wvalid = true;
  in.awaddr = address;
  in.wdata = value;
  in.wstrb = model::Axi4LitePort::kAllStrobes;
  handshake(
      in, [this] { return card().bus().awready; }, address, driver::Direction::kWrite);
  in = CardModel::Inputs{};
  in.bready = true;
  wait_for([this] { return card().bus().bvalid; }, address, driver::Direction::kWrite);
  const bool refused = card().bus().bresp != model::Axi4LitePort::kOkay;
  clock(in);
  if (refused) throw driver::BusError(address, driver::Direction::kWrite);
}

void BusEngine::write_block(std::uint32_t address, const std::uint32_t* words, std::size_t count,
                            driver::Addressing addressing) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto offset = static_cast<std::uint32_t>(addressing == driver::Addressing::kIncrementing ? 4 * i : 0);
    write(address + offset, words[i]);
  }
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
void BusEngine::handshake(const CardModel::Inputs& in, Ready ready, std::uint32_t address,
                          driver::Direction direction) {
  for (int i = 0; !ready(); ++i) {
    if (i == kPatience) throw driver::BusError(address, direction);
    clock(in);
  }
  // The edge at which valid and ready meet.
  clock(in);
}

template <class Valid>
void BusEngine::wait_for(Valid valid, std::uint32_t address, driver::Direction direction) {
  for (int i = 0; !valid(); ++i) {
    if (i == kPatience) throw driver::BusError(address, direction);
    clock(CardModel::Inputs{});
  }
}

void BusEngine::pin_step(std::uint64_t cycle, unsigned axis, int direction) {
  sink_->pin_step({cycle, static_cast<std::uint8_t>(axis), sign(direction)});
}

void BusEngine::path_step(std::uint64_t command, std::uint64_t tick, unsigned axis, int direction) {
  sink_->path_step({command, tick, static_cast<std::uint8_t>(axis), sign(direction)});
}

CardModel::Config config_of(const EngineOptions& options) {
  if (options.axes < 1 || options.axes > card_map::kMaxAxes) throw std::invalid_argument("a card has 1 to 8 axes");
  CardModel::Config config;
  config.axes = options.axes;
  config.clock_hz = options.clock_hz;
  return config;
}

}  // namespace trammel::sim
