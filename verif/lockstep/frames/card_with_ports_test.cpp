// The unmodified driver moves the Verilated card over the pins of its serial and of its SPI port, beside the model:
// pins of ports and axes are compared in every cycle.
#include <gtest/gtest.h>

#include <deque>
#include <iterator>
#include <optional>
#include <vector>

#include "../card/commands.hpp"
#include "card_behind_ports.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/driver/one_shot.hpp"

namespace trammel::lockstep {
namespace {

using std::chrono::nanoseconds;
using namespace std::chrono_literals;

constexpr nanoseconds kClock = 1us;  // the card runs at 1 MHz

// Writes only some of a register's bytes over Wishbone. Returns whether the card accepted it.
bool write_in_part(CardBehindPorts& card, std::uint32_t address) {
  model::WishbonePort::Inputs& bus = card.in.wishbone;
  bus.cyc = bus.stb = bus.we = true;
  bus.adr = address;
  bus.sel = 0x7;
  card.clock();
  bus.stb = false;
  const model::WishbonePort::Outputs& out = card.hosts().wishbone();
  while (!out.ack && !out.err) card.clock();
  bus = {};
  return out.ack;
}

class SpiLink final : public driver::ByteLink {
 public:
  explicit SpiLink(CardBehindPorts& card) : card_(card) {}

  void send(const std::uint8_t* bytes, std::size_t count) override { exchange(frames::Bytes(bytes, bytes + count)); }
  std::size_t receive(std::uint8_t* bytes, std::size_t room, nanoseconds longest) override {
    for (const nanoseconds until = now() + longest; came_.empty() && now() < until;) {
      exchange(frames::Bytes(8, frames::kEnd));
    }
    std::size_t count = 0;
    for (; count < room && !came_.empty(); ++count) {
      bytes[count] = came_.front();
      came_.pop_front();
    }
    return count;
  }
  void restart() override { came_.clear(); }
  nanoseconds time_of(std::size_t bytes) const override { return 40us * static_cast<std::int64_t>(bytes); }
  nanoseconds now() const override { return kClock * static_cast<std::int64_t>(card_.check().cycles()); }
  void sleep(nanoseconds time) override {
    for (const nanoseconds until = now() + time; now() < until;) card_.clock();
  }

 private:
  // Leaves out ends that only fill, so that silence is empty.
  void exchange(const frames::Bytes& bytes) {
    card_.spi.set(3, 4);
    card_.spi.exchange(bytes);
    while (card_.spi.busy()) card_.clock();
    for (const std::uint8_t byte : card_.spi.received()) {
      if (byte != frames::kEnd || last_ != frames::kEnd) came_.push_back(byte);
      last_ = byte;
    }
  }

  CardBehindPorts& card_;
  std::deque<std::uint8_t> came_;
  std::uint8_t last_ = frames::kEnd;
};

void a_line_over(CardBehindPorts& card, driver::ByteLink& link, std::int32_t pulses) {
  driver::FrameBus bus(link);
  driver::Card host = driver::Card::open(bus);
  const std::uint32_t before = card.position(0);
  driver::run_line(host, driver::plan_line(host.timing(), {pulses, -100}, 20ms));
  EXPECT_EQ(card.position(0) - before, static_cast<std::uint32_t>(pulses));
  EXPECT_EQ(bus.counts().sent_again, 0U);
  // The card refuses the second access, so the third is not made.
  driver::Access accesses[] = {driver::read_of(card_map::reg::kAxes), driver::write_of(card_map::reg::kAxes, 1),
                               driver::read_of(card_map::reg::kAxes)};
  EXPECT_EQ(bus.transfer(accesses, std::size(accesses)), 1U);
  EXPECT_EQ(accesses[0].data, CardBehindPorts::kAxes);
}

void lines_over_both() {
  CardBehindPorts card;
  UartLink::Rate rate;
  rate.break_clocks = 1 << CardBehindPorts::kBreakBits | 20;
  UartLink serial(
      card.uart, rate, [&card] { card.clock(); }, [&card] { return card.check().cycles(); });
  a_line_over(card, serial, 200);
  SpiLink spi(card);
  a_line_over(card, spi, 300);
  EXPECT_EQ(card.rises(), 500U);
  EXPECT_FALSE(write_in_part(card, card_map::reg::kHold));
  EXPECT_EQ(card.check().comparisons(), card.expected());
}

void write_over(driver::FrameBus& bus, std::uint32_t address, std::uint32_t data) {
  driver::Access access = driver::write_of(address, data);
  EXPECT_EQ(bus.transfer(&access, 1), 1U);
}

// A piece waits for more words of its session, until a lower ratio makes the queued ticks enough. It begins unless the
// session has been replaced by then.
void piece_that_waits(bool replaced) {
  CardBehindPorts card;
  UartLink serial(
      card.uart, {1'000'000, 115'200, 1 << CardBehindPorts::kBreakBits | 20}, [&card] { card.clock(); },
      [&card] { return card.check().cycles(); });
  driver::FrameBus writer(serial);
  driver::FeedCommand piece = test::feed(1000, 2);
  piece.stop_distance = 20'000;  // far more than are queued
  std::vector<std::uint32_t> words;
  driver::encode(piece, 0, words);
  driver::encode(test::line(1000, {100}), 1, words);
  for (const std::uint32_t word : words) write_over(writer, card_map::reg::kStream, word);
  EXPECT_EQ(card.position(0), 0U);
  write_over(writer, card_map::reg::kSlew, 0x0FFF'FFFF);
  std::optional<driver::FrameBus> successor;
  if (replaced) successor.emplace(serial);
  write_over(replaced ? *successor : writer, card_map::reg::kRatioFeed, 0x800);
  for (unsigned i = 0; i < 5000; ++i) card.clock();
  EXPECT_EQ(card.position(0) != 0, !replaced);
  EXPECT_EQ(card.check().comparisons(), card.expected());
}

TEST(CardWithPorts, TheDriverMovesItOverSerialLineAndSpi) { EXPECT_EQ(judge(lines_over_both), ""); }
TEST(CardWithPorts, ASessionThatIsGoneBeginsNothing) {
  for (const bool replaced : {false, true}) EXPECT_EQ(judge([&] { piece_that_waits(replaced); }), "");
}

}  // namespace
}  // namespace trammel::lockstep
