// SPI port and frame engine behind a bad link, at the pins: SCK at a quarter of the clock and slower, modes 0 and 3,
// exchanges cut within a byte. Every access is checked against the host's requests.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "spi_master.hpp"
#include "storm_bench.hpp"

namespace trammel::lockstep {
namespace {

using test::FrameStorm;

class Bench {
 public:
  explicit Bench(std::uint64_t seed)
      : dice_(seed),
        storm_(
            seed, [this](const frames::Bytes& bytes) { return bring(bytes); }, {}, 20) {
    dut_->rst_i = 1;
    dut_->cs_n_i = 1;
    dut_.clock();
    dut_->rst_i = 0;
  }

  FrameStorm& storm() { return storm_; }

 private:
  // The request in one exchange or in two, the reply in the following ones, until only ends come.
  frames::Bytes bring(const frames::Bytes& bytes) {
    const unsigned mode = dice_.chance(2) ? 0 : 3;
    master_.set(mode, 4 + (dice_.chance(2) ? 0 : dice_.below(60) / 10.0));
    if (dice_.chance(10)) exchange({static_cast<std::uint8_t>(dice_.below(256))}, 1 + dice_.below(7));
    const std::size_t first = dice_.chance(4) ? dice_.below(static_cast<std::uint32_t>(bytes.size() + 1)) : 0;
    const auto middle = bytes.begin() + static_cast<std::ptrdiff_t>(first);
    if (first != 0) exchange(frames::Bytes(bytes.begin(), middle));
    if (first != bytes.size()) exchange(frames::Bytes(middle, bytes.end()));
    frames::Bytes reply;
    unsigned exchanges = 0;
    for (unsigned silent = 0; silent < 2;) {
      if (++exchanges == 100) throw std::logic_error("a card that never falls silent");
      const frames::Bytes& came = exchange(frames::Bytes(24 + dice_.below(20), frames::kEnd));
      const bool ends = std::count(came.begin(), came.end(), frames::kEnd) == static_cast<std::ptrdiff_t>(came.size());
      silent = ends && !at_work_ ? silent + 1 : 0;
      // An end that follows another end only fills.
      for (const std::uint8_t byte : came) {
        if (byte != frames::kEnd || (!reply.empty() && reply.back() != frames::kEnd)) reply.push_back(byte);
      }
      at_work_ = false;
    }
    return reply;
  }
  const frames::Bytes& exchange(const frames::Bytes& bytes, unsigned bits = 8) {
    master_.exchange(bytes, bits);
    while (master_.busy()) clock();
    return master_.received();
  }

  void clock() {
    const model::SpiPort::Pins pins = master_.next(dut_->miso_o != 0);
    dut_->sck_i = pins.sck;
    dut_->cs_n_i = pins.cs_n;
    dut_->mosi_i = pins.mosi;
    if (serve_access(*dut_, inner_, storm_, [this] { return 1 + dice_.below(8); })) at_work_ = true;
    dut_.clock();
  }

  Simulated<Vdut> dut_;
  Dice dice_;
  SpiMaster master_;
  InnerPort inner_;
  bool at_work_ = false;
  FrameStorm storm_;
};

TEST(SpiStorm, NothingRunsWronglyOrTwiceAndTheLinkRecovers) {
  EXPECT_EQ(judge([] { storm_at_pins<Bench>(8, 20'000); }), "");
}

}  // namespace
}  // namespace trammel::lockstep
