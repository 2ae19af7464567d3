// Clients of the server that die at any byte: the card stops on the path, and the next client learns its position.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "memory_streams.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/serve/card_server.hpp"
#include "trammel/sim/engine.hpp"
#include "trammel/transport/links.hpp"

namespace trammel::serve {
namespace {

namespace reg = card_map::reg;
constexpr std::uint32_t kClock = 100'000;  // a slow clock is quick to simulate; only bytes and the path matter here
constexpr const char* kToken = "secret";

// Lines, an arc, a helix, a dwell and corners that stop.
std::string program() {
  std::string text = "F6000\n";
  for (int i = 1; i <= 20; ++i) text += fmt::format("G1 X{:.4f} Y{:.4f}\n", 0.1 * i, 0.8 * std::sin(0.3 * i));
  return text + "G1 X2 Y0\nG2 X4 Y0 I1\nG3 X4 Y0 Z0.5 J-1\nG4 P0.02\nG1 X1 Y2.3 Z1.2\nG0 X0 Y0 Z0\n";
}

run::ProgramLines lines(const std::string& text) {
  return [text]() -> std::unique_ptr<gcode::LineSource> { return std::make_unique<gcode::TextLines>(text, "p.ngc"); };
}

class Steps final : public driver::StepSink {
 public:
  void pin_step(const driver::PinStep& step) override {
    ++pins;
    position[step.axis] += step.direction;
    last_pin = step.cycle;
  }
  void path_step(const driver::PathStep& step) override { path.push_back(step); }

  std::uint64_t pins = 0;
  std::array<std::int64_t, 8> position{};
  std::uint64_t last_pin = 0;
  std::vector<driver::PathStep> path;
};

// A card, its server, and clients one after another.
class Bench {
 public:
  explicit Bench(std::uint32_t baud = 0) : server(*engine, listener, settings(baud)) { engine->set_sink(&steps); }

  // Runs the program as a client that is killed after `life` bytes.
  run::Outcome run(const std::string& text, std::optional<std::uint64_t> life = std::nullopt,
                   const run::RunSettings& there = {}) {
    transport::StreamLink link([&] { return std::make_unique<test::ClientEnd>(server, listener, life); },
                               transport::StreamLink::Hello{kToken});
    driver::FrameBus bus(link);
    driver::Card card = driver::Card::open(bus);
    card.take_over();
    run::Runner runner(lines(text), machine, planner::limits_of(card.identification()), there);
    runner.plan();
    return runner.run(card);
  }
  // The next client stops the card and returns the position that it reads.
  driver::Snapshot stop() {
    transport::StreamLink link([&] { return std::make_unique<test::ClientEnd>(server, listener); },
                               transport::StreamLink::Hello{kToken});
    driver::FrameBus bus(link);
    driver::Card card = driver::Card::open(bus);
    return card.stop();
  }

  bool moves() {
    const std::uint32_t status = engine->read(reg::kStatus);
    return (status & card_map::field::kStatusBusy) != 0 && (status & card_map::field::kStatusHeld) == 0;
  }

  machine::Machine machine = machine::default_machine();
  std::unique_ptr<sim::Engine> engine = sim::make_model_engine(sim::EngineOptions{4, kClock, false});
  test::MemoryListener listener;
  Steps steps;
  CardServer server;

 private:
  static Settings settings(std::uint32_t baud) {
    Settings settings;
    settings.token = kToken;
    settings.clock_hz = kClock;
    settings.real_time = false;
    settings.baud = baud;
    return settings;
  }
};

bool same(const driver::PathStep& a, const driver::PathStep& b) {
  return a.command == b.command && a.tick == b.tick && a.axis == b.axis && a.direction == b.direction;
}

// Bytes that a whole run sends and receives, and its path.
struct Whole {
  explicit Whole(std::uint32_t baud) {
    Bench bench(baud);
    bench.run(program());
    path = bench.steps.path;
    for (std::uint64_t step = 1 << 20; step != 0; step /= 2) {
      Bench other(baud);
      try {
        other.run(program(), bytes + step);
      } catch (const test::Killed&) {
        bytes += step;
      }
    }
  }
  std::vector<driver::PathStep> path;
  std::uint64_t bytes = 0;
};

// Kills a client after `life` bytes. Counts in `moving` if the card moved on after that.
void kill_one(const Whole& whole, std::uint32_t baud, std::uint64_t life, bool go_home, unsigned& moving) {
  Bench bench(baud);
  EXPECT_THROW(bench.run(program(), life), test::Killed);
  const std::uint64_t died = bench.engine->cycles();
  const std::size_t at_death = bench.steps.path.size();
  bench.server.turn();
  EXPECT_FALSE(bench.server.has_client());
  EXPECT_LE(bench.engine->cycles() - died, 5'200U) << "one turn";
  EXPECT_EQ(bench.engine->read(reg::kHold), bench.server.counts().holds) << "by a client that could move";
  // Without a client the ramp ends, and then nothing moves.
  for (int turns = 0; turns < 400 && bench.moves(); ++turns) bench.server.turn();
  const std::size_t at_rest = bench.steps.path.size();
  bench.engine->wait(kClock / 10);
  ASSERT_EQ(bench.steps.path.size(), at_rest);
  moving += at_rest != at_death ? 1 : 0;
  const driver::Snapshot end = bench.stop();
  const std::size_t made = bench.steps.path.size();
  ASSERT_EQ(made, at_rest) << "the stop of the next client adds nothing";
  ASSERT_LE(made, whole.path.size());
  for (std::size_t i = 0; i < made; ++i) ASSERT_TRUE(same(bench.steps.path[i], whole.path[i])) << i;
  EXPECT_EQ(bench.steps.pins, made) << "every step of the path has come out, and no other";
  for (std::size_t a = 0; a < 4; ++a) EXPECT_EQ(end.position[a], bench.steps.position[a]);
  EXPECT_EQ(end.faults, 0U);
  if (!go_home) return;
  run::RunSettings there;
  for (std::size_t a = 0; a < 4; ++a) there.start[a] = static_cast<double>(end.position[a]) / 80;
  bench.run("G0 X0 Y0 Z0\n", std::nullopt, there);
  for (std::size_t a = 0; a < 4; ++a) EXPECT_EQ(bench.steps.position[a], 0);
}

void kill(std::uint32_t baud, unsigned times, unsigned seed) {
  const Whole whole(baud);
  ASSERT_GT(whole.path.size(), 1000U);
  std::mt19937_64 random(seed);
  unsigned moving = 0;
  for (unsigned i = 0; i < times; ++i) {
    const std::uint64_t life = random() % whole.bytes;
    SCOPED_TRACE(fmt::format("killed after {} of {} bytes at {} baud", life, whole.bytes, baud));
    ASSERT_NO_FATAL_FAILURE(kill_one(whole, baud, life, i % 20 == 0, moving));
  }
  testing::Test::RecordProperty("kills", static_cast<int>(times));
  testing::Test::RecordProperty("while_moving", static_cast<int>(moving));
  EXPECT_GT(moving, times / 20) << "or nothing was stopped";
}

// With TRAMMEL_LONG all kills, a thousand in total; otherwise a quarter of them.
unsigned times(unsigned all) { return std::getenv("TRAMMEL_LONG") != nullptr ? all : all / 4; }

TEST(KilledClient, TheCardStopsOnThePathAndThePositionIsKnown) { kill(0, times(700), 1); }

// The line is slower than the motion, so the client often dies while a frame is on its way.
TEST(KilledClient, OnASlowLine) { kill(115'200, times(300), 2); }

}  // namespace
}  // namespace trammel::serve
