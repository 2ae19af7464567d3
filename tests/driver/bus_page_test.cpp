// The example transport of docs/reference/bus.md, with a file in place of a card's window.
#include <gmock/gmock.h>

#include <fstream>

#include "bus_page_example.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/one_shot.hpp"

namespace trammel::driver {
namespace {

namespace reg = card_map::reg;

class BusPage : public ::testing::Test {
 protected:
  BusPage() : path_(::testing::TempDir() + "trammel_window_" + std::to_string(getpid())) {
    set(reg::kMagic, card_map::kMagicValue);
    set(reg::kMapVersion, card_map::kMapVersionValue);
    set(reg::kCommandsVersion, card_map::kCommandsVersionValue);
    set(reg::kAxes, 4);
    set(reg::kClockHz, 1'000'000);
    const card_map::CardShape shape{0x33, 4, 1, 0, 0, 0};
    card_map::put_descriptors(shape, [&](std::uint32_t address, std::uint32_t word) { set(address, word); });
    set(reg::kGeometryDepth, 4096);
    set(reg::kFeedDepth, 2560);
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(words_.data()), static_cast<std::streamsize>(sizeof words_));
  }
  ~BusPage() override { std::remove(path_.c_str()); }

  void set(std::uint32_t address, std::uint32_t value) { words_[address / 4] = value; }

  std::array<std::uint32_t, card_map::kWindowBytes / 4> words_{};
  std::string path_;
};

TEST_F(BusPage, OpensAndWrites) {
  MemoryBus bus(path_);
  Card card = Card::open(bus);
  EXPECT_EQ(card.identification().axes, 4U);
  card.set_ratio(0x8000);
  std::array<Access, 1> ratio{read_of(reg::kRatioFeed)};
  bus.transfer(ratio.data(), 1);
  EXPECT_EQ(ratio[0].data, 0x8000U);
  // The driver finds a refusal that the card has latched.
  std::array<Access, 1> refusal{write_of(reg::kRefusal, reg::kHold << 16 | 8U)};
  MemoryBus second(path_);
  start_line(card, {1}, std::chrono::seconds(1));
  second.transfer(refusal.data(), 1);
  EXPECT_EQ(card.refusal()->address, reg::kHold);
}

TEST_F(BusPage, AMissingWindowIsALinkErrorThatSaysWhy) {
  try {
    MemoryBus bus(path_ + ".not");
    FAIL();
  } catch (const LinkError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("No such file"));
  }
}

}  // namespace
}  // namespace trammel::driver
