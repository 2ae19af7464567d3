// A program from a sender makes the same steps as with `trammel run`, in the same order.
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "sender.hpp"
#include "server.hpp"

namespace trammel::test {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// Short lines and corners, arcs in both directions, a helix, a dwell, relative moves, inches, and offsets.
std::string mixed_program() {
  std::string text = "G21 G90 G17 G94\nG10 L2 P2 X1.25 Y-2.5\nG55\nG0 X0 Y0 Z1\nF6000\n";
  for (int n = 0; n < 60; ++n) {
    text += "G1 X" + std::to_string(n * 0.37) + " Y" + std::to_string(std::sin(n * 0.4) * 3) + "\n";
  }
  text += "G2 X30 Y0 R8\nG3 X20 Y5 Z2 R12\nG4 P0.02\nG91\n";
  for (int n = 0; n < 30; ++n) text += "G1 X-0.4 Y0.11\n";
  text += "G90 G20 G1 X0.5 Y0.25 F200\nG92 X0 Y0\nX0.1\nG92.1\nG21 G54\nG0 X0 Y0 Z0\n";
  return text;
}

std::string by_run(const std::string& text, const std::string& options) {
  const Command command;
  Server server(command, options + " --axes 4");
  const std::string program = command.write("program.ngc", text);
  const Outcome run = command.run("run " + program + " --card " + server.moving());
  EXPECT_EQ(run.status, 0) << run.err;
  return path_of(server.end());
}

std::string by_sender(const std::string& text, const std::string& options, std::size_t window,
                      std::chrono::milliseconds pause = 0ms) {
  const Command command;
  GrblServer server(command, options);
  Sender sender(server);
  EXPECT_TRUE(sender.stream(lines_of(text), window, pause).empty());
  EXPECT_TRUE(sender.await_state("Idle"));
  return path_of(server.end());
}

TEST(SameSteps, ASenderThatCountsBytes) {
  const std::string program = mixed_program();
  EXPECT_EQ(by_sender(program, "--engine model --fast", 126), by_run(program, "--engine model --fast"));
}

TEST(SameSteps, ASenderThatWaitsForEachAnswer) {
  const std::string program = mixed_program();
  EXPECT_EQ(by_sender(program, "--engine model --fast", 0), by_run(program, "--engine model --fast"));
}

// Each line is then its own motion, which ends at rest.
TEST(SameSteps, ASenderThatIsSlow) {
  const std::string program = mixed_program();
  EXPECT_EQ(by_sender(program, "--engine model --fast", 0, 30ms), by_run(program, "--engine model --fast"));
}

TEST(SameSteps, OnTheVerilatedCard) {
  const std::string program = mixed_program();
  EXPECT_EQ(by_sender(program, "--engine rtl --fast", 126), by_run(program, "--engine model --fast"));
}

// The card runs in real time at 100 MHz. If a line comes too late, it makes an under-run hold.
TEST(SameSteps, TwentyLinesASecondWithoutAnUnderRun) {
  const int count = std::getenv("TRAMMEL_LONG") != nullptr ? 10000 : 200;
  std::vector<std::string> lines{"G21 G91 G1 F600"};
  for (int n = 0; n < count; ++n) lines.push_back(n % 2 == 0 ? "X0.4 Y0.3" : "X0.3 Y-0.4");
  const Command command;
  GrblServer server(command, "--engine model --clock 100000000");
  Sender sender(server);
  EXPECT_TRUE(sender.stream(lines, 126, 50ms).empty());
  EXPECT_TRUE(sender.await_state("Idle"));
  EXPECT_NEAR(sender.axis(0), count * 0.35, 1e-6);
  EXPECT_NEAR(sender.axis(1), count * -0.05, 1e-6);
  const std::string said = server.end();
  EXPECT_NE(said.find("holds for want of commands since the card's reset: 0"), std::string::npos) << said;
}

}  // namespace
}  // namespace trammel::test
