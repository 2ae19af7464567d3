// A program runs into a limit switch of a served card. Tests the messages of run, recover, monitor and selftest, and
// that the way back is free.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "command.hpp"
#include "server.hpp"

namespace trammel::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class ServedSwitches : public ::testing::Test {
 protected:
  Outcome run(const std::string& text, const std::string& options = "") {
    return command_.run("run " + command_.write("p.ngc", text) + kInputs + options + " --card " + server_.moving());
  }
  std::string look(const std::string& subcommand) { return command_.run(subcommand + " --card " + server_.url()).out; }

  // REST_TICKS_LEFT_LO of the card, as `trammel dump` prints it.
  std::string ticks_left() {
    const std::string dump = look("dump");
    const std::size_t name = dump.find("REST_TICKS_LEFT_LO");
    const std::size_t end = dump.find('\n', name);
    return dump.substr(dump.rfind(' ', end) + 1, end - dump.rfind(' ', end) - 1);
  }

  const std::string kInputs = " --set inputs.x_limit_plus=3 --set inputs.feed_hold=5";
  Command command_;
  // The switch is pressed in the middle of a move of 10 s, and is not released.
  Server server_{command_, "--engine model --fast --input-at 3:3:1"};
};

TEST_F(ServedSwitches, AProgramStopsAtItsLimit) {
  const Outcome stopped = run("G1 X300 F1800\n");
  EXPECT_NE(stopped.status, 0);
  const std::string place = " in command 1 of the geometry queue, " + ticks_left() + " ticks before its end (exact)";
  const std::string cure =
      "X has stepped into its limit at the plus end: move it towards minus, for example with `trammel jog X-5 "
      "--clear-faults "
      "--trust-position` (5 mm); only steps further into it are barred";
  EXPECT_THAT(stopped.err, AllOf(HasSubstr("LIMIT (X plus)"), HasSubstr("note: the card stands at X 8"),
                                 HasSubstr(" Y 0.0000 Z 0.0000 E 0.0000 mm (pulses 7"), HasSubstr("," + place),
                                 HasSubstr("; " + cure)));
  EXPECT_THAT(look("recover"), AllOf(HasSubstr("stopped  by LIMIT (X plus)\nX      8"),
                                     HasSubstr("\npath    " + place + "\n"), HasSubstr("\nnext     " + cure + "\n")));
  EXPECT_THAT(look("monitor --looks 1"),
              AllOf(HasSubstr("FAULT: LIMIT"), HasSubstr("ACTIVE   input 3 (limit plus of axis 0)"),
                    HasSubstr("at rest  input 5 (feed hold)")));
  const Outcome back = run("G91\nG1 X-5 F1800\n", " --clear-faults --trust-position");
  EXPECT_EQ(back.status, 0) << back.err;
  EXPECT_THAT(look("recover"), AllOf(Not(HasSubstr("LIMIT")), Not(HasSubstr("path "))))
      << "it does not stand where the stop was";
  const Outcome again = run("G91\nG1 X5 F1800\n", " --trust-position");
  EXPECT_THAT(again.err, HasSubstr("LIMIT (X plus)"));
  const Outcome line =
      command_.run("line --to 400,0 --speed 2000 --no-ramp --clear-faults --trust-position --card " + server_.moving());
  EXPECT_THAT(line.err, HasSubstr("LIMIT (X plus)"));
}

// The command that the message suggests moves the axis away.
TEST_F(ServedSwitches, AfterARampThePlaceIsThere) {
  EXPECT_NE(run("G1 X300 F1800\n", " --set axis.x.overtravel=30").status, 0);
  EXPECT_THAT(look("recover"),
              AllOf(HasSubstr("valid, not homed\n"), HasSubstr("`trammel jog X-5 --clear-faults` (5")));
  const Outcome away = command_.run("jog X-5 --clear-faults" + kInputs + " --card " + server_.moving());
  EXPECT_EQ(away.status, 0) << away.err;
}

// Both motors move X, so a step of either motor counts as a step into the switch.
TEST_F(ServedSwitches, WithABeltTheWayAwayNeedsAnOverride) {
  const std::string belt = " --set kinematics.name=\"'corexy'\" --trust-position";
  EXPECT_NE(run("G1 X300 F1800\n", belt).status, 0);
  EXPECT_THAT(
      command_.run("recover" + belt.substr(0, belt.rfind(" --")) + " --card " + server_.url()).out,
      HasSubstr(
          "for example with `trammel jog X-5 --clear-faults --trust-position --override-limits` (5 mm); without"));
  const auto jog = [&](const std::string& words) {
    return command_.run("jog " + words + " --clear-faults" + belt + kInputs + " --card " + server_.moving());
  };
  const Outcome barred = jog("X-5");
  EXPECT_EQ(barred.status, 1);
  EXPECT_THAT(barred.err, HasSubstr("LIMIT (X plus)"));
  const Outcome further = jog("X5 --override-limits");
  EXPECT_EQ(further.status, 2);
  EXPECT_THAT(further.err, HasSubstr("X5 goes further into the limit at the plus end"));
  const Outcome away = jog("X-5 --override-limits");
  EXPECT_EQ(away.status, 0) << away.err;
  EXPECT_THAT(away.err, HasSubstr("stop nothing until they are released"));
  EXPECT_THAT(jog("--override-limits").err, HasSubstr("name axes and distances that lead away"));
}

TEST_F(ServedSwitches, ADriveThatReportsAFaultIsNamed) {
  const std::string drive = " --set inputs.y_drive_fault=\"{input=3, normally='closed'}\"";
  const Outcome stopped =
      command_.run("run " + command_.write("p.ngc", "G1 X300 F1800\n") + drive + " --card " + server_.moving());
  EXPECT_THAT(stopped.err,
              AllOf(HasSubstr("DRIVE_FAULT (Y)"), HasSubstr("the drive of Y reports a fault: clear it at the drive")));
}

class ServedDrives : public ::testing::Test {
 protected:
  std::string drives() {
    const std::string out = command_.run("monitor --looks 1 --card " + server_.url()).out;
    const std::size_t line = out.find("drives ");
    return line == std::string::npos ? out : out.substr(line, out.find('\n', line) - line);
  }
  Command command_;
  Server server_{command_, "--engine model"};
};

// At 1 MHz, in real time. The drives take 2.6 s.
TEST_F(ServedDrives, AreShownAsTheyWaitAndAreEnabled) {
  EXPECT_EQ(drives(), "drives   disabled (of no axis; motion does not wait for drives)");
  Running client(command_,
                 "run " + command_.write("p.ngc", "G1 X1 F6000\n") +
                     " --set outputs.enable=2 --set outputs.enable_delay_ms=2600 --card " + server_.moving(),
                 "client.err");
  ASSERT_TRUE(eventually([&] { return drives() == "drives   enabled, motion waits for them"; })) << drives();
  ASSERT_TRUE(client.wait());
  EXPECT_EQ(drives(), "drives   enabled") << "also when the program has ended";
}

class ServedEmergencyStop : public ::testing::Test {
 protected:
  Outcome run(const std::string& options) {
    return command_.run("run " + command_.write("p.ngc", "G1 X300 F1800\n") + options + " --card " + server_.moving());
  }
  Command command_;
  // The button is pressed in the middle of a move of 10 s, and released later.
  Server server_{command_, "--engine model --fast --input-at 3:estop:1 --input-at 3.5:estop:0"};
};

TEST_F(ServedEmergencyStop, AProgramStopsAndSaysSo) {
  const Outcome stopped = run(" --set outputs.enable=0");
  EXPECT_NE(stopped.status, 0);
  EXPECT_THAT(stopped.err, HasSubstr("EMERGENCY_STOP"));
  EXPECT_THAT(command_.run("monitor --looks 1 --card " + server_.url()).out,
              HasSubstr("FAULT: EMERGENCY_STOP\ndrives   disabled\n"));
  EXPECT_THAT(command_.run("recover --card " + server_.url()).out, HasSubstr("stopped  by EMERGENCY_STOP"));
}

TEST_F(ServedSwitches, SelftestNamesWhatIsNotPressed) {
  EXPECT_EQ(run("G1 X1 F1800\n").status, 0);
  const Outcome test = command_.run("selftest --inputs --switch-time 0.1 --card " + server_.moving());
  EXPECT_NE(test.status, 0);
  EXPECT_THAT(test.out,
              AllOf(HasSubstr("press input 5 (feed hold)"), HasSubstr("FAIL  input 5 (feed hold): it was not")));
}

}  // namespace
}  // namespace trammel::test
