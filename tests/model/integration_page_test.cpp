// The timing diagrams of docs/reference/integration.md. The golden model of the whole card, which the lockstep compares
// with the RTL in every clock, makes their rows; the page must contain exactly these rows.
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/model/card_model.hpp"

namespace {

using namespace trammel;
using model::CardModel;
namespace reg = card_map::reg;
namespace field = card_map::field;

const std::string& page() {
  static const std::string text = [] {
    std::ifstream file(TRAMMEL_INTEGRATION_PAGE);
    std::stringstream all;
    all << file.rdbuf();
    return all.str();
  }();
  return text;
}

// Rows of ones and zeros, one column per clock.
class Diagram {
 public:
  using Value = std::function<bool()>;

  Diagram(CardModel& card, std::vector<std::pair<std::string, Value>> signals)
      : card_(card), signals_(std::move(signals)), rows_(signals_.size()) {}

  // Records the signals before the clock edge.
  void clock(const CardModel::Inputs& in) {
    for (std::size_t n = 0; n < signals_.size(); ++n) rows_[n] += signals_[n].second() ? "  1" : "  0";
    card_.clock(in);
  }
  void expect_on_page() const {
    for (std::size_t n = 0; n < signals_.size(); ++n) {
      const std::string& name = signals_[n].first;
      const std::string row = "    " + name + std::string(11 - name.size(), ' ') + rows_[n].substr(1);
      EXPECT_NE(page().find("\n" + row), std::string::npos) << row;
    }
  }

 private:
  CardModel& card_;
  std::vector<std::pair<std::string, Value>> signals_;
  std::vector<std::string> rows_;
};

class IntegrationPage : public ::testing::Test {
 protected:
  explicit IntegrationPage(std::uint32_t idle_level = 0) : card(config(idle_level)) {
    in.rst = true;
    card.clock(in);
    in.rst = false;
    for (int i = 0; i < 300; ++i) card.clock(in);
  }
  static CardModel::Config config(std::uint32_t idle_level) {
    CardModel::Config config;
    config.idle_level = idle_level;
    return config;
  }

  void ask_to_write(std::uint32_t address, std::uint32_t data) {
    in.awvalid = in.wvalid = true;
    in.awaddr = address;
    in.wdata = data;
    in.wstrb = 0xF;
  }
  // Clocks from the first one with awvalid to the first one with bvalid.
  unsigned write(std::uint32_t address, std::uint32_t data) {
    unsigned taken = 0;
    ask_to_write(address, data);
    for (; !card.bus().awready; ++taken) card.clock(in);
    card.clock(in);
    in = {};
    for (++taken; !card.bus().bvalid; ++taken) card.clock(in);
    in.bready = true;
    card.clock(in);
    in = {};
    return taken;
  }

  CardModel card;
  CardModel::Inputs in;
};

TEST_F(IntegrationPage, WriteOfASetting) {
  Diagram diagram(card, {{"awvalid", [&] { return in.awvalid; }},
                         {"awready", [&] { return card.bus().awready; }},
                         {"bvalid", [&] { return card.bus().bvalid; }}});
  ask_to_write(reg::kHoldLimit, 100);
  in.bready = true;
  for (int clock = 0; clock < 8; ++clock) {
    EXPECT_EQ(card.bus().awready, card.bus().wready);
    if (clock == 2) in.awvalid = in.wvalid = false;
    diagram.clock(in);
  }
  diagram.expect_on_page();
}

TEST_F(IntegrationPage, Read) {
  Diagram diagram(card, {{"arvalid", [&] { return in.arvalid; }},
                         {"arready", [&] { return card.bus().arready; }},
                         {"rvalid", [&] { return card.bus().rvalid; }}});
  in.arvalid = true;
  in.araddr = reg::kMagic;
  in.rready = true;
  for (int clock = 0; clock < 9; ++clock) {
    if (clock == 2) in.arvalid = false;
    diagram.clock(in);
  }
  diagram.expect_on_page();
}

TEST_F(IntegrationPage, WordOfTheStream) {
  const unsigned taken = write(reg::kStream, 0);
  EXPECT_NE(page().find("answered " + std::to_string(taken) + " clocks after `awvalid`"), std::string::npos) << taken;
}

TEST_F(IntegrationPage, FirstWriteAfterReset) {
  in = {};
  in.rst = true;
  card.clock(in);
  in = {};
  const unsigned taken = write(reg::kHoldLimit, 100);
  EXPECT_NE(page().find("answered " + std::to_string(taken) + " clocks after"), std::string::npos) << taken;
}

// Pins that idle high by the strap alone: no level changes from the clock on in which the reset takes effect.
class InvertedPins : public IntegrationPage {
 protected:
  InvertedPins() : IntegrationPage(kIdle) {}
  static constexpr std::uint32_t kIdle = 0b0011'0101;  // DIR of axes 0 and 1, STEP of axes 0 and 2
};

TEST_F(InvertedPins, ResetOfOneClock) {
  write(reg::mode(0), 0);
  write(reg::mode(1), 0);
  card.clock(in);
  card.clock(in);
  ASSERT_EQ(card.outputs().step, 0b0100U);
  in.rst = true;
  Diagram diagram(card, {{"rst", [&] { return in.rst; }},
                         {"STEP", [&] { return (card.outputs().step & 1) != 0; }},
                         {"DIR", [&] { return (card.outputs().dir & 1) != 0; }}});
  for (int clock = 0; clock < 6; ++clock) {
    diagram.clock(in);
    in.rst = false;
  }
  diagram.expect_on_page();
  for (int clock = 0; clock < 600; ++clock) {
    card.clock(in);
    EXPECT_EQ(card.outputs().step, kIdle & 0xF);
    EXPECT_EQ(card.outputs().dir, kIdle >> 4);
  }
  in.arvalid = in.rready = true;
  in.araddr = reg::mode(0);
  while (!card.bus().rvalid) card.clock(in);
  EXPECT_EQ(card.bus().rdata, field::kModeInvertFirst | field::kModeInvertSecond)
      << "MODE after a reset is the strap's";
}

}  // namespace
