// The driver and the runner of programs, unchanged, over the UART pins of the HX8K board's top: the whole of it as it
// is synthesised, but for what stands for PLL and pins. What is judged are the steps at the pins.
#include <Vdut.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/sim/lockstep.hpp"
#include "trammel/transport/byte_stream.hpp"
#include "uart_link.hpp"

namespace trammel::lockstep {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr unsigned kAxes = 4;
constexpr std::uint64_t kClock = 60'000'000;
constexpr double kBreak = 1 << 20 | 1 << 10;  // clocks
constexpr double kFast = 2e6;                 // baud

// The board with a host's serial line at its pins and a motor at each pair of pins.
class Board {
 public:
  Board() {
    dut_->input_i = 0;
    dut_->rx_i = 1;
    // The PLL's lock and the reset after it.
    for (unsigned i = 0; i < 2000; ++i) clock();
  }
  void clock() {
    dut_->rx_i = uart.line.next();
    dut_.clock();
    ++cycles_;
    uart.take(dut_->tx_o);
    outputs_seen_ |= dut_->output_o;
    const std::uint32_t rises = dut_->step_o & ~step_;
    step_ = dut_->step_o;
    if (rises == 0) return;
    for (unsigned axis = 0; axis < kAxes; ++axis) {
      if ((rises >> axis & 1) == 0) continue;
      motor_.at(axis) += (dut_->dir_o >> axis & 1) != 0 ? -1 : 1;
    }
  }
  std::uint64_t cycles() const { return cycles_; }
  std::array<std::int64_t, kAxes> motors() const { return motor_; }
  std::uint32_t outputs_seen() const { return outputs_seen_; }  // those that were ever high

  UartEnd uart;

 private:
  Simulated<Vdut> dut_;
  std::uint64_t cycles_ = 0;
  std::uint32_t step_ = 0;
  std::uint32_t outputs_seen_ = 0;
  std::array<std::int64_t, kAxes> motor_{};
};

class BoardTest : public testing::Test {
 protected:
  driver::Card& connect(double baud) {
    const UartLink::Rate rate{kClock, baud, kBreak};
    link_ = std::make_unique<UartLink>(
        board_.uart, rate, [this] { board_.clock(); }, [this] { return board_.cycles(); });
    bus_ = std::make_unique<driver::FrameBus>(*link_);
    card_ = std::make_unique<driver::Card>(driver::Card::open(*bus_));
    return *card_;
  }
  Board board_;
  std::unique_ptr<UartLink> link_;
  std::unique_ptr<driver::FrameBus> bus_;
  std::unique_ptr<driver::Card> card_;
};

TEST_F(BoardTest, SaysWhoItIsAt115200Baud) {
  driver::Card& card = connect(115'200);
  EXPECT_EQ(card.identification().axes, kAxes);
  EXPECT_EQ(card.identification().clock_hz, kClock);
  const driver::Build build = card.build();
  EXPECT_EQ(build.id, 0x1234ABCDU);
  EXPECT_TRUE(build.dirty);
  EXPECT_EQ(build.board, 1U);
  EXPECT_EQ(bus_->counts().sent_again, 0U);
}

// The line as a TCP connection, whose bytes come and go at the pins.
class Bridge {
 public:
  explicit Bridge(Board& board) : board_(board), thread_([this] { serve(); }) {}
  ~Bridge() {
    over_ = true;
    thread_.join();
  }
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;

  std::string url() const { return listener_->url() + "?hello=no&timeout=20000"; }

 private:
  void serve() {
    while (!over_) {
      if (const auto stream = listener_->accept()) {
        serve(*stream);
      } else {
        std::this_thread::sleep_for(1ms);
      }
    }
  }
  // The card's time goes on while somebody is there.
  void serve(transport::ByteStream& stream) {
    board_.uart.begin(8 * kClock / kFast, kBreak);
    std::array<std::uint8_t, 256> bytes{};
    try {
      while (!over_) {
        for (std::size_t i = 0, count = stream.read(bytes.data(), bytes.size(), 0ns); i < count; ++i) {
          board_.uart.line.send(bytes.at(i));
        }
        for (unsigned i = 0; i < 2000; ++i) board_.clock();
        const std::vector<std::uint8_t> back(board_.uart.received.begin(), board_.uart.received.end());
        board_.uart.received.clear();
        if (!back.empty()) stream.write(back.data(), back.size());
      }
    } catch (const driver::LinkError&) {
      // It has gone.
    }
  }

  Board& board_;
  std::unique_ptr<transport::Listener> listener_ = transport::listen_tcp("127.0.0.1", 0);
  std::atomic<bool> over_{false};
  std::thread thread_;
};

// What the trammel command says; it must end well.
std::string trammel(const std::string& arguments) {
  std::string out;
  FILE* const pipe = ::popen((TRAMMEL_COMMAND " " + arguments + " 2>&1").c_str(), "r");
  std::array<char, 256> part{};
  while (std::fgets(part.data(), static_cast<int>(part.size()), pipe) != nullptr) out += part.data();
  EXPECT_EQ(::pclose(pipe), 0) << out;
  return out;
}

TEST_F(BoardTest, CommandsMoveItAt2Megabaud) {
  const Bridge bridge(board_);
  const std::string card = " --card '" + bridge.url() + "'";
  EXPECT_THAT(trammel("info" + card), AllOf(HasSubstr("clock          60000000 Hz\n"),
                                            HasSubstr("build          1234abcd, dirty\nboard          1\n")));
  trammel("line --to 200,-100,50,7 --duration 0.005" + card);
  EXPECT_EQ(board_.motors(), (std::array<std::int64_t, kAxes>{200, -100, 50, 7}));

  // Lines, an arc, an output.
  const std::string program = testing::TempDir() + "board_test.ngc";
  std::ofstream(program)
      << "G21 G90 G17\nM3\nG1 X1 Y0.5 F12000\nG1 X1.5 Y0.25\nG2 X2.5 Y0.25 I0.5\nG1 X3 Y-0.5 Z0.25\nM2\n";
  std::string quick = " --set outputs.m3=2";
  for (const std::string axis : {"x", "y", "z"}) {
    quick += " --set axis." + axis + ".max_velocity=200 --set axis." + axis + ".max_acceleration=20000";
  }
  const std::string said = trammel("run " + program + quick + card);
  EXPECT_THAT(said, HasSubstr(" 0 sent again"));
  EXPECT_EQ(board_.motors(), (std::array<std::int64_t, kAxes>{440, -140, 70, 7})) << said;
  EXPECT_EQ(board_.outputs_seen(), 1U << 2);
}

}  // namespace
}  // namespace trammel::lockstep
