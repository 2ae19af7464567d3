// The reader must not allocate memory while it runs. The global operator new counts.
#include <gtest/gtest.h>

#include <string>

#include "counted_allocations.hpp"
#include "trammel/gcode/reader.hpp"

namespace trammel::gcode {
namespace {

// Repeats lines of every kind.
class EndlessLines final : public LineSource {
 public:
  bool next(std::string_view& line) override {
    static constexpr std::string_view kLines[] = {"G21 G90 G17 F600 (note)",
                                                  "N10 G1 X1.5 Y-2.25 F1200",
                                                  "X0.1234567890123456789",
                                                  "G2 X1 Y1 R5 ; arc",
                                                  "G3 I2 J0",
                                                  "M3 S1000 T1",
                                                  "G4 P0.5",
                                                  "G28 X0",
                                                  "G92 X0 Y0",
                                                  "",
                                                  "/G0 X5",
                                                  "M0",
                                                  "G91 G0 E1",
                                                  "G92.1 G90"};
    line = kLines[at_++ % std::size(kLines)];
    return true;
  }
  const std::string& name() const override { return name_; }

 private:
  std::size_t at_ = 0;
  std::string name_ = "endless";
};

TEST(Allocation, NoneABlock) {
  const machine::Machine machine = machine::default_machine();
  EndlessLines lines;
  Reader reader(lines, machine);
  Motion motion;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(reader.next(motion)) << describe(*reader.error());
  }
  const std::size_t before = test::allocations();
  for (int i = 0; i < 100000; ++i) {
    reader.next(motion);
  }
  EXPECT_EQ(test::allocations(), before);
  EXPECT_FALSE(reader.error());
  EXPECT_GT(reader.accepted().at("M3"), 1000U);
}

TEST(Allocation, NoneALine) {
  std::string text;
  for (int i = 0; i < 20000; ++i) {
    text += "G1 X1 Y2 F600 ; a line\r\n";
  }
  TextLines lines(text, "text");
  const std::size_t before = test::allocations();
  std::size_t count = 0;
  for (std::string_view line; lines.next(line);) {
    ++count;
  }
  EXPECT_EQ(count, 20000U);
  EXPECT_EQ(test::allocations(), before);
}

TEST(Allocation, IsCounted) {
  const std::size_t before = test::allocations();
  const std::string text(100, 'x');
  EXPECT_GT(test::allocations(), before) << text;
}

}  // namespace
}  // namespace trammel::gcode
