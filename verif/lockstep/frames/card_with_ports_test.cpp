// The driver, unchanged, moves the Verilated card over the pins of its serial and of its SPI port, beside the model:
// pins of ports and axes in every cycle.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <deque>
#include <iterator>

#include "spi_master.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/model/core_model.hpp"
#include "trammel/model/host_ports.hpp"
#include "trammel/sim/lockstep.hpp"
#include "uart_link.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

using std::chrono::nanoseconds;
using namespace std::chrono_literals;

constexpr unsigned kAxes = 4;
constexpr unsigned kBreakBits = 10;
constexpr std::uint64_t kComparedSignals = 6;
constexpr nanoseconds kClock = 1us;  // the card runs at 1 MHz

class CardUnderTest {
 public:
  CardUnderTest() : check_("card_with_ports", 0), core_(core_config()), hosts_(host_config()) {
    dut_->clock_hz_i = 1'000'000;
    dut_->rst_i = 1;
    drive();
    model::CoreModel::Inputs in;
    in.rst = true;
    dut_.clock();
    core_.clock(in);
    dut_->rst_i = 0;
    dut_.clock();
    core_.clock({});
    hosts_.reset();
  }

  void clock() {
    in_.rx = uart.line.next();
    in_.spi = spi.next(hosts_.spi().miso);
    uart.take(hosts_.uart().tx);
    drive();
    const model::CoreModel::Answer answer = core_.answer();
    const model::PortArbiter::Inner inner = hosts_.inner();
    model::CoreModel::Inputs in;
    in.request = inner.access.request;
    in.write = inner.access.write;
    in.partial = inner.access.partial;
    in.port = inner.port;
    in.address = inner.access.address;
    in.data = inner.access.data;
    dut_.clock();
    core_.clock(in);
    hosts_.clock(in_, {answer.ack, answer.error, answer.data});
    check_.next_cycle();
    compare();
  }

  // A write of some of a register's bytes over Wishbone: whether the card took it.
  bool write_in_part(std::uint32_t address) {
    in_.wishbone = {};
    in_.wishbone.cyc = in_.wishbone.stb = in_.wishbone.we = true;
    in_.wishbone.adr = address;
    in_.wishbone.sel = 0x7;
    clock();
    in_.wishbone.stb = false;
    while (!hosts_.wishbone().ack && !hosts_.wishbone().err) clock();
    in_.wishbone = {};
    return hosts_.wishbone().ack;
  }

  std::uint32_t position(unsigned axis) const { return core_.position(axis); }
  const Checker& check() const { return check_; }
  std::uint64_t rises() const { return rises_; }

  UartEnd uart;
  SpiMaster spi;

 private:
  static model::CardConfig core_config() {
    model::CardConfig config;
    config.axes = kAxes;
    config.ports = 4;
    config.inputs = 8;
    config.engines = model::RegisterFile::kMostEngines;
    return config;
  }
  static model::HostPorts::Config host_config() { return {true, true, true, true, true, kBreakBits}; }

  void drive() {
    dut_->rx_i = in_.rx;
    dut_->sck_i = in_.spi.sck;
    dut_->cs_n_i = in_.spi.cs_n;
    dut_->mosi_i = in_.spi.mosi;
    const model::WishbonePort::Inputs& w = in_.wishbone;
    dut_->wishbone_i = wishbone_wire(w);
  }
  void compare() {
    const model::CoreModel::Outputs& out = core_.outputs();
    check_.compare("tx_o", dut_->tx_o, hosts_.uart().tx);
    check_.compare("miso_o and miso_enable_o", unsigned{dut_->miso_enable_o} << 1 | dut_->miso_o,
                   unsigned{hosts_.spi().miso_enable} << 1 | unsigned{hosts_.spi().miso});
    const model::WishbonePort::Outputs& w = hosts_.wishbone();
    check_.compare("Wishbone ack, err, stall", dut_->wishbone_o & ~in_place(bus::wishbone_answer::kDat, ~0U),
                   in_place(bus::wishbone_answer::kAck, w.ack) | in_place(bus::wishbone_answer::kErr, w.err) |
                       in_place(bus::wishbone_answer::kStall, w.stall));
    check_.compare("step_o", dut_->step_o, out.step);
    check_.compare("dir_o", dut_->dir_o, out.dir);
    check_.compare("irq_o", dut_->irq_o, out.irq);
    rises_ += (out.step & ~step_before_ & 1) != 0 ? 1U : 0U;
    step_before_ = out.step;
  }

  Simulated<Vdut> dut_;
  Checker check_;
  model::CoreModel core_;
  model::HostPorts hosts_;
  model::HostPorts::Inputs in_;
  std::uint32_t step_before_ = 0;
  std::uint64_t rises_ = 0;
};

class SpiLink final : public driver::ByteLink {
 public:
  explicit SpiLink(CardUnderTest& card) : card_(card) {}

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
  // Ends that only fill are left out, so that silence is nothing.
  void exchange(const frames::Bytes& bytes) {
    card_.spi.set(3, 4);
    card_.spi.exchange(bytes);
    while (card_.spi.busy()) card_.clock();
    for (const std::uint8_t byte : card_.spi.received()) {
      if (byte != frames::kEnd || last_ != frames::kEnd) came_.push_back(byte);
      last_ = byte;
    }
  }

  CardUnderTest& card_;
  std::deque<std::uint8_t> came_;
  std::uint8_t last_ = frames::kEnd;
};

void a_line_over(CardUnderTest& card, driver::ByteLink& link, std::int32_t pulses) {
  driver::FrameBus bus(link);
  driver::Card host = driver::Card::open(bus);
  const std::uint32_t before = card.position(0);
  driver::run_line(host, driver::plan_line(host.timing(), {pulses, -100}, 20ms));
  EXPECT_EQ(card.position(0) - before, static_cast<std::uint32_t>(pulses));
  EXPECT_EQ(bus.counts().sent_again, 0U);
  // The card refuses the second one, and the third is not made.
  driver::Access accesses[] = {driver::read_of(card_map::reg::kAxes), driver::write_of(card_map::reg::kAxes, 1),
                               driver::read_of(card_map::reg::kAxes)};
  EXPECT_EQ(bus.transfer(accesses, std::size(accesses)), 1U);
  EXPECT_EQ(accesses[0].data, kAxes);
}

void lines_over_both() {
  CardUnderTest card;
  UartLink::Rate rate;
  rate.break_clocks = 1 << kBreakBits | 20;
  UartLink serial(
      card.uart, rate, [&card] { card.clock(); }, [&card] { return card.check().cycles(); });
  a_line_over(card, serial, 200);
  SpiLink spi(card);
  a_line_over(card, spi, 300);
  EXPECT_EQ(card.rises(), 500U);
  EXPECT_FALSE(card.write_in_part(card_map::reg::kHold));
  EXPECT_EQ(card.check().comparisons(), kComparedSignals * card.check().cycles());
}

TEST(CardWithPorts, TheDriverMovesItOverSerialLineAndSpi) { EXPECT_EQ(judge(lines_over_both), ""); }

}  // namespace
}  // namespace trammel::lockstep
