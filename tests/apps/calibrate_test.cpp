// The command `trammel calibrate`: the file that it writes, and the card's place afterwards.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "command.hpp"
#include "server.hpp"

namespace trammel::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class CalibrateCommand : public ::testing::Test {
 protected:
  CalibrateCommand() : before_(contents(TRAMMEL_EXAMPLES_DIR "/first-machine.toml")) {
    file_ = command_.write("router.toml", before_);
  }
  Outcome calibrate(const std::string& arguments) const {
    return command_.run("calibrate " + arguments + " --machine " + file_);
  }

  Command command_;
  std::string before_;
  std::string file_;
};

TEST_F(CalibrateCommand, SaysTheLineAndWritesNothing) {
  const Outcome outcome = calibrate("X 100 99.2");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("X: steps_per_mm 80 -> 80.64516 (+0.806 %)\n"));
  EXPECT_THAT(outcome.out, HasSubstr("router.toml:11: steps_per_mm = 80.64516\n"));
  EXPECT_THAT(outcome.err, HasSubstr("note: nothing was written. Give --write"));
  EXPECT_THAT(outcome.err, HasSubstr("`trammel zero` with all axes where they stand, then home again"));
  EXPECT_THAT(outcome.err, HasSubstr("min and max and [homing] distances of axis X"));
  EXPECT_EQ(contents(file_), before_);
  // The built-in machine file cannot be written.
  EXPECT_THAT(command_.run("calibrate X 100 99.2 --machine built-in").out, HasSubstr("80 -> 80.64516"));
  EXPECT_EQ(command_.run("calibrate X 100 99.2 --machine built-in --write").status, 2);
}

TEST_F(CalibrateCommand, WritesTheNumberAlone) {
  ASSERT_EQ(::chmod(file_.c_str(), 0640), 0);
  const Outcome outcome = calibrate("y -100 -99.2 --write");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("written to " + file_));
  std::string expected = before_;
  const std::size_t at = expected.find("80", expected.find("[axis.y]"));
  EXPECT_EQ(contents(file_), expected.replace(at, 2, "80.64516"));
  struct stat status {};
  ASSERT_EQ(::stat(file_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777U, 0640U);
  // A temporary file would be a second name in the directory.
  EXPECT_EQ(command_.names(), std::vector<std::string>{"router.toml"});
}

TEST_F(CalibrateCommand, LeavesTheFileWhereItRefuses) {
  for (const char* const arguments : {"X 100 0", "X 0 99", "X 100 -99", "X 100 10", "W 100 99", "X 100", "X 100 x",
                                      "X 100 nan", "X 100 1e-5 --force"}) {
    const Outcome outcome = calibrate(arguments + std::string(" --write"));
    EXPECT_EQ(outcome.status, 2) << arguments << outcome.out;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_EQ(contents(file_), before_) << arguments;
  }
  EXPECT_THAT(calibrate("X 100 10").err, HasSubstr("--force"));
  const Outcome same = calibrate("X 100 100 --write");
  EXPECT_EQ(same.status, 0) << same.err;
  EXPECT_THAT(same.out, HasSubstr("right as it is"));
  EXPECT_EQ(contents(file_), before_);
}

TEST_F(CalibrateCommand, AFileThatCannotBeReplacedStays) {
  const std::string broken = command_.write("broken.toml", "[axis.x]\nsteps_per_mm = 80\n");
  EXPECT_THAT(command_.run("calibrate X 100 99 --write --machine " + broken).err, HasSubstr("broken.toml:"));
  const std::string pipe = command_.path("pipe.toml");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(command_.run("calibrate X 100 99 --write --machine " + pipe).err, HasSubstr("is not a regular file"));
}

// The card keeps a hash of the scales, so after the change its place is not valid.
TEST_F(CalibrateCommand, TheCardsPlaceIsVoidAfterwards) {
  Server server(command_, "--engine model --fast --world default");
  const auto on_card = [&](const std::string& arguments) {
    return command_.run(arguments + " --machine " + file_ + " --card " + server.moving());
  };
  EXPECT_EQ(on_card("home").status, 0);
  EXPECT_THAT(on_card("position").out, HasSubstr("valid, homed"));
  EXPECT_EQ(calibrate("X 100 99.2 --write").status, 0);
  EXPECT_THAT(on_card("position").out, HasSubstr("counted in other scales"));
  const Outcome jog = on_card("jog X1");
  EXPECT_EQ(jog.status, 2) << jog.out;
  EXPECT_THAT(jog.err, HasSubstr("other scales"));
  // The command refuses before anything moves.
  const Outcome refused = on_card("home");
  EXPECT_EQ(refused.status, 2) << refused.out;
  EXPECT_THAT(refused.err, HasSubstr("`trammel zero` with all axes where they stand, then home"));
  EXPECT_THAT(refused.err, Not(HasSubstr("searches its switch")));
  EXPECT_EQ(on_card("zero X Y Z").status, 0);
  EXPECT_EQ(on_card("home").status, 0);
  EXPECT_THAT(on_card("position").out, Not(HasSubstr("not homed")));
}

}  // namespace
}  // namespace trammel::test
