// A reset of one clock in each clock of accesses over every port: no port answers a request from before the reset.
#include <gtest/gtest.h>

#include "card_behind_ports.hpp"
#include "trammel/frames/frame.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;

constexpr unsigned kFilled = 270;     // clocks after a reset, longer than the filling of the registers
constexpr unsigned kAccesses = 60;    // clocks, longer than the three accesses below together
constexpr double kClocksOfByte = 64;  // for its 8 bits

class Masters {
 public:
  explicit Masters(CardBehindPorts& card) : card_(card) {}

  // A write and a read over AXI4-Lite, a read over Wishbone. `take`: the AXI master accepts its answers.
  void ask(bool take) {
    model::Axi4LitePort::Inputs& axi = card_.in.axi;
    axi.awvalid = axi.wvalid = axi.arvalid = true;
    axi.awaddr = reg::kHoldLimit;
    axi.wdata = 7;
    axi.wstrb = model::Axi4LitePort::kAllStrobes;
    axi.araddr = reg::kAxes;
    axi.bready = axi.rready = take;
    model::WishbonePort::Inputs& bus = card_.in.wishbone;
    bus.cyc = bus.stb = true;
    bus.adr = reg::kAxes;
  }

  // A request lasts until it is taken, Wishbone's cycle until the answer.
  void clock() {
    const model::Axi4LitePort::Outputs axi = card_.hosts().axi();
    const model::WishbonePort::Outputs bus = card_.hosts().wishbone();
    card_.clock();
    if (axi.awready) card_.in.axi.awvalid = card_.in.axi.wvalid = false;
    if (axi.arready) card_.in.axi.arvalid = false;
    if (!bus.stall) card_.in.wishbone.stb = false;
    if (bus.ack || bus.err) card_.in.wishbone.cyc = false;
    written_ += axi.bvalid && card_.in.axi.bready ? 1U : 0U;
    read_ += axi.rvalid && card_.in.axi.rready ? 1U : 0U;
    acknowledged_ += bus.ack ? 1U : 0U;
  }
  void clocks(unsigned count) {
    for (unsigned i = 0; i < count; ++i) clock();
  }

  std::uint64_t written() const { return written_; }
  std::uint64_t read() const { return read_; }
  std::uint64_t acknowledged() const { return acknowledged_; }

 private:
  CardBehindPorts& card_;
  std::uint64_t written_ = 0;
  std::uint64_t read_ = 0;
  std::uint64_t acknowledged_ = 0;
};

void resets_in_accesses() {
  CardBehindPorts card;
  Masters masters(card);
  for (const bool take : {false, true}) {
    for (unsigned at = 0; at < kAccesses; ++at) {
      masters.clocks(kFilled);
      masters.ask(take);
      masters.clocks(at);
      card.reset();
      // Accesses made in the first clock after the reset are each answered once.
      masters.ask(true);
      masters.clocks(kFilled + kAccesses);
    }
  }
  // Some of the accesses before the resets were answered too.
  EXPECT_GT(masters.written(), 2 * kAccesses);
  EXPECT_GT(masters.read(), 2 * kAccesses);
  EXPECT_GT(masters.acknowledged(), 2 * kAccesses);
  EXPECT_EQ(card.check().comparisons(), card.expected());
}

// The card is silent at once, at any bit of its reply.
void resets_in_replies() {
  CardBehindPorts card;
  frames::Bytes ask;
  frames::append_request(ask, {});
  for (unsigned at = 0; at < 12; ++at) {
    card.uart.begin(kClocksOfByte, (1U << CardBehindPorts::kBreakBits) + 20);
    for (const std::uint8_t byte : ask) card.uart.line.send(byte);
    for (unsigned i = 0; i < 5000 && card.hosts().uart().tx; ++i) card.clock();
    EXPECT_FALSE(card.hosts().uart().tx);
    for (unsigned i = 0; i < 13 * at || card.hosts().uart().tx; ++i) card.clock();
    card.reset();
    for (unsigned i = 0; i < kFilled; ++i) card.clock();
  }
  EXPECT_EQ(card.check().comparisons(), card.expected());
}

TEST(Resets, OfOneClockInAccesses) { EXPECT_EQ(judge(resets_in_accesses), ""); }
TEST(Resets, OfOneClockInReplies) { EXPECT_EQ(judge(resets_in_replies), ""); }

}  // namespace
}  // namespace trammel::lockstep
