// Lockstep of the SPI port: exchanges in modes 0 and 3 up to a quarter of the card's clock, some cut within a byte,
// SCK for other devices while it is not selected, noise on all pins, resets at any clock.
#include "trammel/model/spi_port.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "spi_master.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

using model::SpiPort;

constexpr std::uint64_t kComparedSignals = 4;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("spi_port", seed), dice_(seed) { reset(); }

  // An exchange of random bytes; the bytes received must be those given, one byte late. `cut`: it ends within its
  // last byte.
  void exchange(bool cut) {
    frames::Bytes bytes(1 + dice_.below(12));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(dice_.below(256));
    taken_.clear();
    given_.clear();
    master_.set(dice_.chance(2) ? 0 : 3, 4 + (dice_.chance(2) ? 0 : dice_.below(100) / 10.0));
    const std::uint8_t first = loaded_;
    master_.exchange(bytes, cut ? 1 + dice_.below(7) : 8);
    while (master_.busy()) clock(master_.next(model_.outputs().miso));
    if (cut) bytes.pop_back();
    EXPECT_EQ(taken_, bytes);
    if (aligned_) {
      given_.insert(given_.begin(), first);
      given_.resize(bytes.size());
      EXPECT_EQ(master_.received(), given_);
    }
    aligned_ = !cut;
  }

  // A reset at a random clock of an exchange.
  void exchange_until_reset() {
    master_.set(dice_.chance(2) ? 0 : 3, 4);
    master_.exchange(frames::Bytes(4, static_cast<std::uint8_t>(dice_.below(256))));
    for (unsigned clocks = dice_.below(140); clocks != 0; --clocks) clock(master_.next(model_.outputs().miso));
    reset();
    while (master_.busy()) clock(master_.next(model_.outputs().miso));
    aligned_ = false;
  }

  void noise(unsigned clocks, bool selected) {
    for (unsigned i = 0; i < clocks; ++i) clock({dice_.chance(2), !selected || dice_.chance(10), dice_.chance(2)});
    for (unsigned i = 0; i < 8; ++i) clock({true, true, false});
    if (selected) aligned_ = false;
  }

  // One clock of reset, with random other inputs.
  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    dut_->sck_i = dice_.chance(2);
    dut_->cs_n_i = dice_.chance(2);
    dut_->mosi_i = dice_.chance(2);
    dut_->valid_i = dice_.chance(2);
    dut_.clock();
    dut_->rst_i = 0;
    model_.reset();
    check_.next_cycle();
    compare();
    loaded_ = frames::kEnd;
    aligned_ = true;
  }

  Checker& check() { return check_; }
  Dice& dice() { return dice_; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + bytes_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  void clock(const SpiPort::Pins& pins) {
    SpiPort::Inputs in;
    in.pins = pins;
    in.valid = dice_.chance(2);
    in.byte = static_cast<std::uint8_t>(dice_.below(256));
    dut_->sck_i = pins.sck;
    dut_->cs_n_i = pins.cs_n;
    dut_->mosi_i = pins.mosi;
    dut_->valid_i = in.valid;
    dut_->byte_i = in.byte;
    if (model_.outputs().ready) {
      loaded_ = in.valid ? in.byte : frames::kEnd;
      given_.push_back(loaded_);
    }
    dut_.clock();
    model_.clock(in);
    check_.next_cycle();
    compare();
  }

  void compare() {
    const SpiPort::Outputs& out = model_.outputs();
    check_.compare("miso_o", dut_->miso_o, out.miso);
    check_.compare("miso_enable_o", dut_->miso_enable_o, out.miso_enable);
    check_.compare("ready_o", dut_->ready_o, out.ready);
    check_.compare("received_o", dut_->received_o, out.byte_valid);
    if (!out.byte_valid) return;
    ++bytes_;
    taken_.push_back(out.byte);
    check_.compare("byte_o", dut_->byte_o, out.byte);
  }

  Simulated<Vdut> dut_;
  Checker check_;
  Dice dice_;
  SpiPort model_;
  SpiMaster master_;
  frames::Bytes taken_;
  frames::Bytes given_;
  std::uint8_t loaded_ = frames::kEnd;  // the first byte of the next exchange
  bool aligned_ = true;                 // false after a cut exchange, when `loaded_` does not come first
  std::uint64_t bytes_ = 0;
};

void exchanges() {
  const std::uint64_t seed = seed_from_environment(20261122);
  Bench bench(seed);
  const std::uint64_t length = scaled(2000);
  for (std::uint64_t i = 0; i < length; ++i) {
    bench.exchange(bench.dice().chance(8));
    if (bench.dice().chance(6)) bench.noise(40, false);
    if (bench.dice().chance(20)) bench.noise(60, true);
    if (bench.dice().chance(20)) bench.reset();
    if (bench.dice().chance(4)) bench.exchange_until_reset();
  }
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  EXPECT_GT(bench.bytes(), length * 5);
}

TEST(SpiPort, Exchanges) { EXPECT_EQ(judge(exchanges), ""); }

}  // namespace
}  // namespace trammel::lockstep
