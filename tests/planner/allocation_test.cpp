// Reader, blocks, planner and encoding must not allocate memory while they run. The global operator new counts.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "counted_allocations.hpp"
#include "trammel/planner/planner.hpp"

namespace trammel::planner {
namespace {

// Repeats lines, arcs on the accumulator and as chords, and dwells.
class EndlessLines final : public gcode::LineSource {
 public:
  bool next(std::string_view& line) override {
    static constexpr std::array<std::string_view, 8> kLines = {"G90 G17 G1 X10 Y5 F1200",
                                                               "G2 X20 I5",
                                                               "G18 G3 X10 K5 I-5",
                                                               "G17 G4 P0.5",
                                                               "G0 X0 Y0",
                                                               "G1 X0.01",
                                                               "E3",
                                                               "Z-1 X1"};
    line = kLines[at_++ % kLines.size()];
    return true;
  }
  const std::string& name() const override { return name_; }

 private:
  std::size_t at_ = 0;
  std::string name_ = "endless";
};

class Encoder final : public driver::CommandSink {
 public:
  void put(const driver::Command& command) override {
    words += driver::encode(command, static_cast<std::uint8_t>(commands++), words_.data());
  }
  std::uint64_t commands = 0;
  std::uint64_t words = 0;

 private:
  std::array<std::uint32_t, driver::kMaxCommandWords> words_{};
};

TEST(Pipeline, AllocatesNothingABlock) {
  machine::Machine machine = machine::default_machine();
  machine::apply_override(machine, "axis.z.steps_per_mm=400");
  const CardLimits card = {100'000'000, 4, true};
  EndlessLines lines;
  gcode::Reader reader(lines, machine);
  BlockBuilder blocks(reader, machine, card);
  Planner planner(blocks, machine, card);
  Encoder sink;
  PlannedBlock planned;
  for (int i = 0; i < 16; ++i) ASSERT_TRUE(planner.next(sink, planned));
  const std::size_t before = test::allocations();
  std::size_t chords = 0;
  for (int i = 0; i < 800; ++i) {
    if (!planner.next(sink, planned)) break;
    chords += planned.block.geometry == Geometry::kChords;
  }
  EXPECT_EQ(test::allocations(), before);
  EXPECT_FALSE(blocks.error());
  EXPECT_GT(chords, 90U);
  EXPECT_GT(sink.words, 10'000U);
}

}  // namespace
}  // namespace trammel::planner
