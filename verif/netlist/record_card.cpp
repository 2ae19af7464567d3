// Records a program on the card: lines, arcs, dwells, holds, ratios, direct moves, faults, aborts, resets, refused
// accesses.
#include <cstdio>
#include <cstdlib>
#include <random>
#include <stdexcept>
#include <variant>
#include <vector>

#include "recorder.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/commands.hpp"

namespace {

using namespace trammel;
using netlist::Recorder;
namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint32_t kFractionBits = 40;  // fraction bits of an increment

class Program {
 public:
  Program(Recorder& card, std::uint32_t seed) : card_(card), random_(seed) {}

  void settings() {
    for (std::uint32_t n = 0; n < Recorder::kAxes; ++n) {
      card_.write(reg::step_length(n), below(6));
      card_.write(reg::step_space(n), below(6));
      card_.write(reg::dir_setup(n), below(9));
      card_.write(reg::dir_hold(n), below(9));
      card_.write(reg::mode(n), below(3) | below(4) << 2);
    }
    card_.write(reg::kHoldLimit, 2000);
    card_.write(reg::kIrqEnable, 0xE1);
    card_.write(reg::kSlew, 0x200000 + below(0x8000000));
  }

  // Lines, an arc and their feed pieces; then a dwell and the end, with bus traffic until all is done.
  void paths() {
    std::uint64_t total = 0;
    for (std::uint32_t lines = 1 + below(3); lines != 0; --lines) total += line();
    total += arc();
    const std::uint64_t first = 1 + below(static_cast<std::uint32_t>(total) - 1);
    piece(first);
    piece(total - first);
    send(driver::DwellCommand{50 + below(200)});
    send(driver::EndCommand{});
    for (int i = 0; i < 60 && (card_.read(reg::kStatus) & field::kStatusBusy) != 0; ++i) disturb();
    card_.write(reg::kRatioFeed, 0x10000);
    card_.write(reg::kSlew, 0xFFFFFFF);
    settle();
  }

  void direct_move() {
    for (std::uint32_t n = 0; n < Recorder::kAxes; ++n) {
      const std::uint32_t count = below(30);
      const std::uint64_t frequency = (std::uint64_t{count} << 40) / 1000;
      card_.write(reg::frequency_lo(n), static_cast<std::uint32_t>(frequency));
      card_.write(reg::frequency_hi(n), static_cast<std::uint32_t>(frequency >> 32));
      card_.write(reg::count(n), count);
      card_.write(reg::direction(n), below(2));
    }
    card_.write(reg::kLengthLo, 1000);
    card_.write(reg::kLengthHi, 0);
    card_.write(reg::kStart, 0xF);
    card_.write(reg::kStart, 0x1);  // refused: busy
    settle();
  }

  // Steps that the shapers cannot make in time cause a fault; then an abort and a clear in either order.
  void overrun() {
    card_.write(reg::kHoldLimit, 40);
    card_.write(reg::step_length(0), 200);
    driver::LineCommand fast;
    fast.ticks = 400;
    fast.mask = 1;
    fast.increment[0] = std::int64_t{1} << kFractionBits;
    send(fast);
    piece(fast.ticks);
    card_.wait(700);
    recover();
    card_.write(reg::step_length(0), 3);
  }

  // An abort at a random time of a line, a truncated command, accesses that are refused.
  void errors() {
    piece(line());
    card_.wait(below(300));
    abort();
    std::vector<std::uint32_t> words;
    driver::FeedCommand whole;
    whole.ticks = 1;
    driver::encode(whole, 0, words);
    card_.write(reg::kStream, words.front());
    card_.write(reg::kControl, field::kControlFlush);
    card_.write(reg::kStream, words.front());  // refused: the stream is closed
    abort();
    card_.write(0xFFC, 1);
    card_.read(0xFFC);
    card_.write(reg::kMagic, 1);
    card_.write(reg::kRatioFeed, 0x10001);
    card_.write(reg::kRatioFeed, 0x100, 0x3);
    card_.read(reg::kRefusal);
    card_.write(reg::kRefusal, 1);
  }

  // A reset of one clock at a random time of a line; afterwards the card has its reset settings.
  void reset() {
    piece(line());
    card_.wait(below(300));
    card_.reset(1);
    number_ = 0;
    card_.read(reg::kStatus);
  }

 private:
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }

  void send(const driver::Command& command) {
    std::vector<std::uint32_t> words;
    driver::encode(command, number_++, words);
    for (const std::uint32_t word : words) card_.write(reg::kStream, word);
  }

  // Both return the feed ticks of their path.
  std::uint64_t line() {
    driver::LineCommand line;
    line.ticks = 20 + below(60);
    line.mask = 0xF;
    for (std::size_t n = 0; n < Recorder::kAxes; ++n) {
      const auto pulses = static_cast<std::int64_t>(below(static_cast<std::uint32_t>(line.ticks)));
      const std::int64_t increment = (pulses << kFractionBits) / static_cast<std::int64_t>(line.ticks);
      line.increment[n] = below(2) == 0 ? increment : -increment;
    }
    send(line);
    return line.ticks;
  }
  std::uint64_t arc() {
    driver::ArcGeometry arc;
    const auto radius = static_cast<std::int32_t>(3 + below(15));
    arc.clockwise = below(2) == 0;
    arc.centre_x = -radius * driver::kCentreUnitsPerPulse;
    arc.end_x = -radius;
    arc.end_y = arc.clockwise ? -radius : radius;
    arc.sweep = 1.5707963267948966;
    arc.axis_x = static_cast<std::uint8_t>(below(Recorder::kAxes));
    arc.axis_y = static_cast<std::uint8_t>((arc.axis_x + 1) % Recorder::kAxes);
    const driver::ArcCommand command = driver::prepare(arc);
    const std::uint64_t ticks = command.path_ticks + below(50);
    send(driver::with_ticks(command, ticks));
    return ticks;
  }

  // About one tick per 24 clocks, with a little acceleration and jerk.
  void piece(std::uint64_t ticks) {
    driver::FeedCommand feed;
    feed.ticks = ticks;
    feed.rate = ~std::uint64_t{0} / (20 + below(8));
    feed.acceleration = static_cast<std::int64_t>(feed.rate / 4096) - static_cast<std::int64_t>(feed.rate / 8192);
    feed.jerk = -feed.acceleration / 64;
    feed.floor = static_cast<std::uint32_t>(feed.rate >> 34);
    send(feed);
  }

  void disturb() {
    switch (below(6)) {
      case 0:
        card_.write(reg::kHold, 1);
        card_.wait(below(200));
        card_.write(reg::kHold, 0);
        break;
      case 1:
        card_.write(reg::kRatioFeed, 0x4000 + below(0xC001));
        break;
      case 2:
        card_.write(reg::kControl, field::kControlSnapshot);
        break;
      case 3:
        card_.read(reg::kSnapTimeLo);
        card_.read(reg::kSnapStatus);
        break;
      case 4:
        card_.read(reg::snap_position(below(Recorder::kAxes)));
        break;
      default:
        card_.read(reg::kGeometryRoom);
        break;
    }
    card_.wait(below(250));
  }

  // Waits until nothing runs; aborts a program that does not end.
  void settle() {
    for (int i = 0; i < 200; ++i) {
      const std::uint32_t status = card_.read(reg::kStatus);
      if ((status & field::kStatusFaulted) != 0) break;
      if ((status & field::kStatusBusy) == 0) return;
      card_.wait(30);
    }
    recover();
  }
  void recover() {
    const bool abort_first = below(2) == 0;
    if (abort_first) abort();
    card_.write(reg::kFault, 0x3FF);
    if (!abort_first) abort();
    card_.wait(300);
    card_.write(reg::kFault, 0x3FF);
  }
  void abort() {
    card_.write(reg::kControl, field::kControlAbort);
    number_ = 0;
  }

  Recorder& card_;
  std::mt19937 random_;
  std::uint8_t number_ = 0;
};

void record(const char* path, std::uint64_t clocks, std::uint32_t seed) {
  Recorder card(path, seed * 0x35 & 0xFF, seed);  // each seed has other levels of the pins
  card.reset(8);
  Program program(card, seed);
  for (unsigned part = 0; card.seen().clocks < clocks; ++part) {
    switch (part % 5) {
      case 0:
        program.settings();
        program.paths();
        break;
      case 1:
        program.direct_move();
        break;
      case 2:
        program.overrun();
        break;
      case 3:
        program.errors();
        break;
      default:
        program.reset();
        break;
    }
  }
  const Recorder::Seen& seen = card.seen();
  std::printf(
      "%llu clocks: %llu steps, %llu path ticks, %llu in direct moves, %llu held, %llu faulted; %llu interrupts, "
      "%llu refusals\n",
      static_cast<unsigned long long>(seen.clocks), static_cast<unsigned long long>(seen.steps),
      static_cast<unsigned long long>(seen.path_ticks), static_cast<unsigned long long>(seen.direct),
      static_cast<unsigned long long>(seen.held), static_cast<unsigned long long>(seen.faulted),
      static_cast<unsigned long long>(seen.interrupts), static_cast<unsigned long long>(seen.refused));
  for (const std::uint64_t count :
       {seen.steps, seen.path_ticks, seen.direct, seen.held, seen.faulted, seen.interrupts, seen.refused}) {
    if (count == 0) throw std::runtime_error("the program did not do all that it is for");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: record_card FILE CLOCKS SEED\n");
    return 2;
  }
  try {
    record(argv[1], std::strtoull(argv[2], nullptr, 10),
           static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 10)));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
