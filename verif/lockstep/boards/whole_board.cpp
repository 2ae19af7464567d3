#include "whole_board.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/driver/arc_chord.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/driver/increment.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/sim/lockstep.hpp"
#include "trammel/transport/byte_stream.hpp"
#include "uart_link.hpp"

namespace trammel::lockstep {
namespace {

using namespace std::chrono_literals;

constexpr unsigned kMaxAxes = 4;
constexpr double kBreak = 1 << 20 | 1 << 10;  // clocks
constexpr double kFastestBit = 25;            // clocks: 2.4 Mbaud at 60 MHz, 3.2 at 80

using Motors = std::array<std::int64_t, kMaxAxes>;

std::string text(const Motors& motors) {
  return fmt::format("{} {} {} {}", motors[0], motors[1], motors[2], motors[3]);
}

class Board {
 public:
  Board(BoardTop& top, const BoardFacts& facts) : top_(top), facts_(facts) {
    // Waits for the PLL's lock and the reset after it.
    for (unsigned i = 0; i < 3000; ++i) clock();
  }

  void clock() {
    const BoardTop::Pins pins = top_.clock(uart.line.next());
    ++cycles_;
    uart.take(pins.tx);
    outputs_seen_ |= pins.output;
    const std::uint32_t rises = pins.step & ~step_;
    step_ = pins.step;
    if (rises == 0) return;
    for (unsigned axis = 0; axis < kMaxAxes; ++axis) {
      if ((rises >> axis & 1) != 0) motors_.at(axis) += (pins.dir >> axis & 1) != 0 ? -1 : 1;
    }
    stepped();
  }

  void require(bool holds, const std::string& what) const {
    if (!holds) throw Mismatch(fmt::format("{}: cycle {}: {}\n", facts_.name, cycles_, what));
  }
  void require_motors(const Motors& at, const std::string& when) const {
    require(motors_ == at, fmt::format("motors at {}, not {}; {}", text(motors_), text(at), when));
  }

  void press(bool pressed) {
    top_.press(pressed);
    for (unsigned i = 0; i < 10; ++i) clock();
  }

  const BoardFacts& facts() const { return facts_; }
  std::uint64_t cycles() const { return cycles_; }
  const Motors& motors() const { return motors_; }
  std::uint32_t outputs_seen() const { return outputs_seen_; }  // those that were ever high
  // outputs that were high at any time
  UartEnd uart;
  std::function<void()> stepped = [] {};  // after each step

 private:
  BoardTop& top_;
  const BoardFacts& facts_;
  std::uint64_t cycles_ = 0;
  std::uint32_t step_ = 0;
  std::uint32_t outputs_seen_ = 0;
  Motors motors_{};
};

void identify(const Board& board, driver::Card& card) {
  const driver::Identification& id = card.identification();
  board.require(id.axes == board.facts().axes && id.clock_hz == board.facts().clock_hz,
                fmt::format("it says {} axes, {} Hz", id.axes, id.clock_hz));
  const driver::Build build = card.read_build();
  board.require(build.id == 0x1234ABCD && build.dirty && build.board == board.facts().board_id,
                fmt::format("it says build {:x}{}, board {}", build.id, build.dirty ? ", dirty" : "", build.board));
  const unsigned inputs = card.inputs_present();
  const unsigned outputs = card.outputs_present();
  board.require(inputs == board.facts().inputs && outputs == board.facts().outputs,
                fmt::format("it says {} inputs, {} outputs", inputs, outputs));
  const std::uint32_t levels = card.read_raw_inputs();
  board.require(levels == (kInputLevels & ((1U << inputs) - 1)), fmt::format("inputs at {:b}", levels));
}

// X moves 80 pulses, 80 more as the upper half of a circle if the board makes arcs, and another 80.
constexpr std::int64_t kPart = 80;
constexpr std::uint64_t kTicks = 4096;   // ticks per part
constexpr double kClocksATick = 50;      // so each part takes 2.9 ms at 70 MHz
constexpr std::uint64_t kHeld = 50'000;  // clocks
constexpr std::int64_t kHoldAt = 3 * kPart / 2;
constexpr double kPi = 3.14159265358979323846;

std::vector<driver::Command> parts(bool arc) {
  driver::LineCommand line;
  line.ticks = kTicks;
  line.mask = 1;
  line.increment[0] = driver::rounded_increment(kPart, kTicks);
  driver::FeedCommand feed;
  feed.ticks = 3 * kTicks;
  feed.rate = static_cast<std::uint64_t>(std::ldexp(1 / kClocksATick, 64));
  if (!arc) return {feed, line, line, line, driver::EndCommand{}};
  driver::HelixGeometry half;
  half.arc.centre_x = 256 * kPart / 2;
  half.arc.end_x = kPart;
  half.arc.clockwise = true;
  half.arc.sweep = kPi;
  return {feed, line, driver::make_helix(half, kTicks), line, driver::EndCommand{}};
}

// Largest distance of a step from the circle, pulses. Steps with Y != 0 belong to the circle.
class Circle {
 public:
  void step(const Motors& at) {
    if (at[1] == 0) return;
    const double radius = std::hypot(static_cast<double>(at[0] - 3 * kPart / 2), static_cast<double>(at[1]));
    farthest_ = std::max(farthest_, std::abs(radius - kPart / 2.0));
    highest_ = std::max(highest_, at[1]);
  }
  double farthest() const { return farthest_; }
  std::int64_t highest() const { return highest_; }

 private:
  double farthest_ = 0;
  std::int64_t highest_ = 0;
};

// Holds when the middle is reached, and continues when nothing has moved for a while.
class Hold {
 public:
  Hold(Board& board, driver::Card& card) : board_(board), card_(card) {}
  void step() {
    board_.require(!held_ || over_, "a step in the hold");
    if (asked_ || board_.motors()[0] < kHoldAt) return;
    card_.request_hold(true);
    asked_ = true;
  }
  void look(const driver::Status& status) {
    if (!status.held || over_) return;
    if (!held_) {
      board_.require((board_.motors()[1] != 0) == board_.facts().arc_generator, "the hold is not in the middle");
      began_ = board_.cycles();
      held_ = true;
    }
    if (board_.cycles() - began_ < kHeld) return;
    over_ = true;
    card_.request_hold(false);
  }
  bool over() const { return over_; }

 private:
  Board& board_;
  driver::Card& card_;
  bool asked_ = false;
  bool held_ = false;
  std::uint64_t began_ = 0;
  bool over_ = false;
};

void stream(Board& board, driver::Card& card) {
  card.set_slew_time(100us);
  Hold hold(board, card);
  Circle circle;
  board.stepped = [&] {
    board.require(board.motors()[2] == 0 && board.motors()[3] == 0, "a step of an axis that was not to move");
    hold.step();
    circle.step(board.motors());
  };
  driver::StreamOptions options;
  options.poll_clocks = 20'000;
  options.progress = [&hold](const driver::StreamProgress& progress) { hold.look(progress.status); };
  driver::Stream stream(card, options);
  stream.send(parts(board.facts().arc_generator));
  stream.finish();
  board.stepped = [] {};
  board.require_motors({3 * kPart, 0, 0, 0}, "after the stream");
  board.require(hold.over(), "there was no hold");
  board.require(circle.farthest() < 1, fmt::format("a step {:.2f} pulses off the circle", circle.farthest()));
  board.require(circle.highest() == (board.facts().arc_generator ? kPart / 2 : 0),
                fmt::format("Y was at {}", circle.highest()));
}

// While the emergency stop is pressed, it stops the card and cannot be cleared; after its release it can.
void stop_at_the_pin(Board& board, driver::Card& card) {
  constexpr std::uint32_t kStopped = card_map::field::kFaultEmergencyStop;
  board.require(card.read_faults() == 0, "a fault before the emergency stop: " + card.read_fault_text());
  board.press(true);
  board.require(card.read_faults() == kStopped, "pressed: " + card.read_fault_text());
  card.clear_faults();
  board.require(card.read_faults() == kStopped, "cleared while pressed: " + card.read_fault_text());
  board.press(false);
  card.clear_faults();
  board.require(card.read_faults() == 0, "released and cleared: " + card.read_fault_text());
}

// Makes the serial line available as a TCP connection, whose bytes come and go at the pins.
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
  // Waits until no client is connected: then the board, and its clock, belong to the caller again.
  void wait_for_the_end() const {
    while (served_) std::this_thread::sleep_for(1ms);
  }

 private:
  void serve() {
    while (!over_) {
      if (const auto stream = listener_->accept()) {
        served_ = true;
        serve(*stream);
        served_ = false;
      } else {
        std::this_thread::sleep_for(1ms);
      }
    }
  }
  // The card's clock runs while a client is connected.
  void serve(transport::ByteStream& stream) {
    board_.uart.begin(8 * kFastestBit, kBreak);
    std::array<std::uint8_t, 256> bytes{};
    try {
      while (!over_) {
        for (std::size_t i = 0, count = stream.read(bytes.data(), bytes.size(), 0ns); i < count; ++i) {
          board_.uart.line.send(bytes.at(i));
        }
        for (unsigned i = 0; i < 1000; ++i) board_.clock();
        const std::vector<std::uint8_t> back(board_.uart.received.begin(), board_.uart.received.end());
        board_.uart.received.clear();
        if (!back.empty()) stream.write(back.data(), back.size());
      }
    } catch (const driver::LinkError&) {
      // The client has gone.
    }
  }

  Board& board_;
  std::unique_ptr<transport::Listener> listener_ = transport::listen_tcp("127.0.0.1", 0);
  std::atomic<bool> over_{false};
  std::atomic<bool> served_{false};
  std::thread thread_;
};

// The output of the trammel command, which must succeed.
std::string trammel(const Board& board, const Bridge& bridge, const std::string& arguments) {
  std::string out;
  const std::string line = TRAMMEL_COMMAND " " + arguments + " --card '" + bridge.url() + "' 2>&1";
  FILE* const pipe = ::popen(line.c_str(), "r");
  std::array<char, 256> part{};
  while (std::fgets(part.data(), static_cast<int>(part.size()), pipe) != nullptr) out += part.data();
  const int status = ::pclose(pipe);
  bridge.wait_for_the_end();
  board.require(status == 0, "trammel " + arguments + ": " + out);
  return out;
}

void require_said(const Board& board, const std::string& said, const std::string& part) {
  board.require(said.find(part) != std::string::npos, fmt::format("no \"{}\" in: {}", part, said));
}

}  // namespace

void streams_and_holds(BoardTop& top, const BoardFacts& facts) {
  Board board(top, facts);
  UartLink link(
      board.uart, {facts.clock_hz, facts.baud, kBreak}, [&board] { board.clock(); },
      [&board] { return board.cycles(); });
  // A board that does not answer is asked only once.
  driver::FrameBus::Options once;
  once.answer = 2ms;
  once.sends = 1;
  once.restarts = 0;
  try {
    driver::FrameBus bus(link, once);
    driver::Card card = driver::Card::open(bus);
    identify(board, card);
    stream(board, card);
    stop_at_the_pin(board, card);
  } catch (const driver::Error& error) {
    board.require(false, error.what());
  }
}

// The default machine without the axes that the board does not have.
std::string machine_file(const BoardFacts& facts) {
  std::string text = machine::default_machine_text();
  if (facts.axes < 4) {
    const std::size_t from = text.find("[axis.e]");
    text.erase(from, text.find("\n# How the card's axes", from) - from);
  }
  const std::string name = testing::TempDir() + facts.name + "_board_test.toml";
  std::ofstream(name) << text;
  return name;
}

void obeys_commands(BoardTop& top, const BoardFacts& facts) {
  Board board(top, facts);
  const Bridge bridge(board);
  const std::string info = trammel(board, bridge, "info");
  require_said(board, info, fmt::format("clock          {} Hz\n", facts.clock_hz));
  require_said(board, info, fmt::format("build          1234abcd, dirty\nboard          {}\n", facts.board_id));
  const std::int64_t fourth = facts.axes == 4 ? 7 : 0;
  trammel(board, bridge, fmt::format("line --to 200,-100,50{} --duration 0.002 --no-ramp", fourth != 0 ? ",7" : ""));
  board.require_motors({200, -100, 50, fourth}, "after the line");

  // Program: lines, an arc, an output.
  const std::string program = testing::TempDir() + facts.name + "_board_test.ngc";
  std::ofstream(program)
      << "G21 G90 G17\nM3\nG1 X1 Y0.5 F60000\nG1 X1.5 Y0.25\nG2 X2.5 Y0.25 I0.5\nG1 X3 Y-0.5 Z0.25\nM2\n";
  std::string quick = " --machine " + machine_file(facts) + " --set outputs.m3=2";
  for (const std::string axis : {"x", "y", "z"}) {
    quick += " --set axis." + axis + ".max_velocity=1000 --set axis." + axis + ".max_acceleration=1000000";
  }
  const std::string said = trammel(board, bridge, "run " + program + quick);
  require_said(board, said, " 0 sent again");
  board.require_motors({240, -40, 20, fourth}, "after " + said);  // absolute, wherever the previous line ended
  board.require(board.outputs_seen() == 1U << 2, fmt::format("outputs {:b} were on", board.outputs_seen()));
}

}  // namespace trammel::lockstep
