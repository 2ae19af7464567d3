#include "trammel/sim/engine.hpp"

#include <stdexcept>

#include "lockstep_card.hpp"
#include "rtl_engine.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::sim {

namespace {

using model::CardModel;

// A step's direction as the lists have it.
std::int8_t sign(int direction) { return static_cast<std::int8_t>(direction < 0 ? -1 : 1); }

// Bus accesses as an AXI4-Lite master makes them; the cards behind it differ in clock() and idle only. Both answer in
// the same clocks, so an access takes the same time on both.
class BusEngine : public Engine, private model::CardSteps {
 public:
  std::uint32_t read(std::uint32_t address) override {
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

  void write(std::uint32_t address, std::uint32_t value) override {
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

  void write_block(std::uint32_t address, const std::uint32_t* words, std::size_t count,
                   driver::Addressing addressing) override {
    for (std::size_t i = 0; i < count; ++i) {
      const auto offset = static_cast<std::uint32_t>(addressing == driver::Addressing::kIncrementing ? 4 * i : 0);
      write(address + offset, words[i]);
    }
  }

  void set_sink(StepSink* sink) override {
    sink_ = sink;
    card().set_steps(sink != nullptr ? this : nullptr);
  }
  std::uint64_t cycles() const override { return card().cycles(); }
  std::vector<std::int64_t> positions() const override {
    std::vector<std::int64_t> result;
    for (unsigned n = 0; n < card().axes(); ++n) result.push_back(static_cast<std::int32_t>(card().position(n)));
    return result;
  }

 protected:
  virtual void clock(const CardModel::Inputs& in) = 0;
  virtual CardModel& card() = 0;
  virtual const CardModel& card() const = 0;

 private:
  // An access takes some ten clocks, a START some hundred; one that takes more has hung.
  static constexpr int kPatience = 100'000;

  template <class Ready>
  void handshake(const CardModel::Inputs& in, Ready ready, std::uint32_t address, driver::Direction direction) {
    for (int i = 0; !ready(); ++i) {
      if (i == kPatience) throw driver::BusError(address, direction);
      clock(in);
    }
    // The edge at which valid and ready meet.
    clock(in);
  }
  template <class Valid>
  void wait_for(Valid valid, std::uint32_t address, driver::Direction direction) {
    for (int i = 0; !valid(); ++i) {
      if (i == kPatience) throw driver::BusError(address, direction);
      clock(CardModel::Inputs{});
    }
  }

  void pin_step(std::uint64_t cycle, unsigned axis, int direction) override {
    sink_->pin_step({cycle, static_cast<std::uint8_t>(axis), sign(direction)});
  }
  void path_step(std::uint64_t command, std::uint64_t tick, unsigned axis, int direction) override {
    sink_->path_step({command, tick, static_cast<std::uint8_t>(axis), sign(direction)});
  }

  StepSink* sink_ = nullptr;
};

CardModel::Config config_of(const EngineOptions& options) {
  CardModel::Config config;
  config.axes = options.axes;
  config.clock_hz = options.clock_hz;
  return config;
}

class ModelEngine : public BusEngine {
 public:
  explicit ModelEngine(const EngineOptions& options) : card_(config_of(options)) {}

  void wait(std::uint64_t card_clocks) override { card_.run(card_clocks); }
  std::optional<std::uint64_t> lockstep_cycles() const override { return std::nullopt; }
  std::uint64_t comparisons() const override { return 0; }

 private:
  void clock(const CardModel::Inputs& in) override { card_.clock(in); }
  CardModel& card() override { return card_; }
  const CardModel& card() const override { return card_; }

  CardModel card_;
};

class RtlEngine : public BusEngine {
 public:
  RtlEngine(std::unique_ptr<VerilatedCard> card, const EngineOptions& options)
      : card_(std::move(card), config_of(options), options.seed, options.trace ? 1 : LockstepCard::kBatch,
              options.rtl_thread && !options.trace ? RtlThread::kOwn : RtlThread::kCallers) {}

  std::uint32_t read(std::uint32_t address) override {
    card_.event("read", address);
    return BusEngine::read(address);
  }
  void write(std::uint32_t address, std::uint32_t value) override {
    card_.event("write to", address);
    card_.event("written", value);
    BusEngine::write(address, value);
  }
  void wait(std::uint64_t card_clocks) override { card_.run(CardModel::Inputs{}, card_clocks); }
  std::optional<std::uint64_t> lockstep_cycles() const override {
    card_.settle();
    return card_.cycles();
  }
  std::uint64_t comparisons() const override {
    card_.settle();
    return card_.comparisons();
  }

 private:
  void clock(const CardModel::Inputs& in) override { card_.run(in, 1); }
  CardModel& card() override { return card_.model(); }
  const CardModel& card() const override { return card_.model(); }

  mutable LockstepCard card_;  // who asks what was compared makes the RTL catch up
};

}  // namespace

std::unique_ptr<Engine> make_engine(const EngineOptions& options) {
  if (options.axes < 1 || options.axes > CardModel::kMaxAxes) throw std::invalid_argument("a card has 1 to 8 axes");
  if (options.kind == EngineKind::kModel) {
    if (options.trace) throw std::invalid_argument("a trace needs the RTL engine");
    return std::make_unique<ModelEngine>(options);
  }
  return make_rtl_engine(make_verilated_card(options.axes, {options.clock_hz, 0}, options.trace), options);
}

std::unique_ptr<Engine> make_rtl_engine(std::unique_ptr<VerilatedCard> card, const EngineOptions& options) {
  return std::make_unique<RtlEngine>(std::move(card), options);
}

}  // namespace trammel::sim
