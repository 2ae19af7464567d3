// Lockstep of a card's host ports side by side, with a host at each: random accesses on the buses, good and damaged
// requests on the lines. Compares every pin of every port in every cycle, and the accesses at the inner port.
#include "trammel/model/host_ports.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "byte_ports.hpp"
#include "host_pins.hpp"
#include "spi_master.hpp"
#include "trammel/sim/lockstep.hpp"
#include "uart_line.hpp"

namespace trammel::lockstep {
namespace {

using model::HostPorts;

constexpr HostPorts::Config kConfig{TRAMMEL_AXI != 0,  TRAMMEL_WISHBONE != 0, TRAMMEL_WISHBONE == 2,
                                    TRAMMEL_UART != 0, TRAMMEL_SPI != 0,      10};
constexpr std::uint64_t kComparedSignals = 6;

class Bench {
 public:
  explicit Bench(std::uint64_t seed)
      : check_("host_ports", seed), dice_(seed), model_(kConfig), uart_source_(dice_), spi_source_(dice_) {
    reset();
  }

  void random_clock() {
    if (dice_.chance(50'000)) return reset();
    axi_host();
    wishbone_host();
    uart_host();
    spi_host();
    const model::PortArbiter::Inner inner = model_.inner();
    if (inner.access.request) {
      ++asked_[inner.port];
      inner_.ask(4 + dice_.below(6), dice_.chance(30), dice_.draw());
    }
    const InnerPort::Answer now = inner_.now();
    const HostPorts::Answer answer{now.ack, now.ack ? now.error : dice_.chance(2), now.ack ? now.data : dice_.draw()};
    drive(answer);
    dut_.clock();
    model_.clock(in_, answer);
    check_.next_cycle();
    compare();
  }

  Checker& check() { return check_; }
  std::uint64_t asked(std::size_t port) const { return asked_[port]; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + more_; }

 private:
  // One clock of reset, with random other inputs.
  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    drive({});
    dut_.clock();
    dut_->rst_i = 0;
    model_.reset();
    in_ = {};
    inner_.clear();
    line_.clear();
    line_.set_period(64);
    line_.break_line(1034);
  }

  // Follows the rules for masters: valid stays high until ready.
  void axi_host() {
    model::Axi4LitePort::Inputs& axi = in_.axi;
    const model::Axi4LitePort::Outputs& out = model_.axi();
    if (taken_write_) axi.awvalid = axi.wvalid = false;
    if (taken_read_) axi.arvalid = false;
    if (!axi.awvalid && dice_.chance(40)) {
      axi.awvalid = axi.wvalid = true;
      axi.awaddr = dice_.below(4096);
      axi.wdata = dice_.draw();
      axi.wstrb = static_cast<std::uint8_t>(dice_.chance(3) ? dice_.below(16) : 15);
    }
    if (!axi.arvalid && dice_.chance(40)) {
      axi.arvalid = true;
      axi.araddr = dice_.below(4096);
    }
    axi.bready = axi.rready = dice_.chance(2);
    taken_write_ = axi.awvalid && out.awready;
    taken_read_ = axi.arvalid && out.arready;
  }
  void wishbone_host() {
    model::WishbonePort::Inputs& bus = in_.wishbone;
    const model::WishbonePort::Outputs& out = model_.wishbone();
    const bool over = kConfig.pipelined ? !out.stall : out.ack || out.err;
    if (bus.stb && over) bus.stb = false;
    if (dice_.chance(300)) bus.cyc = bus.stb = false;
    if (dice_.chance(100)) bus.cyc = !bus.cyc;
    if (bus.stb || !dice_.chance(30)) return;
    bus.cyc = !dice_.chance(6);
    bus.stb = true;
    bus.we = dice_.chance(2);
    bus.adr = dice_.below(4096);
    bus.sel = static_cast<std::uint8_t>(dice_.chance(3) ? dice_.below(16) : 15);
    bus.dat = dice_.draw();
  }
  void uart_host() {
    const frames::Session& session = model_.uart_engine().session();
    if (dice_.chance(60'000)) line_.break_line(1034);
    if (!line_.busy() && model_.uart_engine().listening()) {
      line_.send(uart_source_.next(session.last(), session.epoch()));
    }
    in_.rx = line_.next();
  }
  void spi_host() {
    const frames::Session& session = model_.spi_engine().session();
    if (!spi_.busy()) {
      frames::Bytes bytes(1 + dice_.below(8), frames::kEnd);
      if (model_.spi_engine().listening()) {
        for (std::uint8_t& byte : bytes) byte = spi_source_.next(session.last(), session.epoch());
      }
      spi_.set(dice_.chance(2) ? 0 : 3, 4 + dice_.below(4));
      spi_.exchange(bytes);
    }
    in_.spi = spi_.next(model_.spi().miso);
  }

  void drive(const HostPorts::Answer& answer) {
    drive_hosts(*dut_, in_);
    using namespace bus::register_answer;
    dut_->answer_i = in_place(kAck, answer.ack) | in_place(kError, answer.error) | in_place(kData, answer.data);
  }

  void compare() {
    const model::Axi4LitePort::Outputs& axi = model_.axi();
    check_.compare("AXI4-Lite handshakes and responses", axi_shown(*dut_), axi_shown(axi));
    check_.compare("Wishbone ack, err, stall", wishbone_shown(dut_->wishbone_o), wishbone_shown(model_.wishbone()));
    check_.compare("tx_o", dut_->tx_o, model_.uart().tx);
    // A port that is not built drives 0.
    const bool miso = kConfig.spi && model_.spi().miso;
    check_.compare("miso_o and miso_enable_o", unsigned{dut_->miso_enable_o} << 1 | dut_->miso_o,
                   unsigned{model_.spi().miso_enable} << 1 | unsigned{miso});
    const model::PortArbiter::Inner inner = model_.inner();
    using namespace bus::register_access;
    const auto access = [this](const bus::Field& field) { return get(dut_->access_o, field); };
    check_.compare("request", access(kRequest), inner.access.request);
    check_.compare("port", access(kPort), access(kRequest) != 0 ? inner.port : access(kPort));
    if (axi.rvalid) differs("rdata_o", dut_->rdata_o, axi.rdata);
    const model::WishbonePort::Outputs& w = model_.wishbone();
    if (w.ack || w.err) differs("Wishbone data", get(dut_->wishbone_o, bus::wishbone_answer::kDat), w.dat);
    if (!inner.access.request) return;
    const model::PortArbiter::Access& a = inner.access;
    differs("access, write and address", access(kWrite) << 12 | access(kAddress),
            std::uint64_t{a.write} << 12 | a.address);
    differs("access, session", access(kOfSession) << 1 | access(kNewSession),
            unsigned{a.of_session} << 1 | unsigned{a.new_session});
    if (a.write)
      differs("access, partial and data", access(kPartial) << 32 | access(kData),
              std::uint64_t{a.partial} << 32 | a.data);
  }
  void differs(const char* signal, std::uint64_t rtl, std::uint64_t model) {
    check_.compare(signal, rtl, model);
    ++more_;
  }

  Simulated<Vdut> dut_;
  Checker check_;
  Dice dice_;
  HostPorts model_;
  HostPorts::Inputs in_;
  InnerPort inner_;
  FrameSource uart_source_;
  FrameSource spi_source_;
  UartLine line_;
  SpiMaster spi_;
  bool taken_write_ = false;
  bool taken_read_ = false;
  std::uint64_t asked_[4] = {};
  std::uint64_t more_ = 0;
};

void all_hosts() {
  const std::uint64_t seed = seed_from_environment(20261122);
  Bench bench(seed);
  const std::uint64_t length = scaled(600'000);
  for (std::uint64_t i = 0; i < length; ++i) bench.random_clock();
  EXPECT_GT(bench.check().cycles(), length * 99 / 100);
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  for (std::size_t port = 0; port < kConfig.ports(); ++port) EXPECT_GT(bench.asked(port), length / 2500) << port;
}

TEST(HostPorts, AllHostsAtOnce) { EXPECT_EQ(judge(all_hosts), ""); }

}  // namespace
}  // namespace trammel::lockstep
