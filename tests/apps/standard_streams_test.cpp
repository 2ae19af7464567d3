// Standard input, output and error that are closed or full: no command fails silently, and none aborts.
#include <gtest/gtest.h>
#include <signal.h>

#include "command.hpp"

namespace trammel::test {
namespace {

// Two valid programs, of which the second causes a warning, as files in the command's directory.
class StandardStreams : public testing::Test {
 protected:
  // The timeout ends a command that does not notice the lost stream.
  Outcome run(const std::string& arguments) const { return command_.run_in(".", "timeout 20", arguments); }
  std::string json() const { return command_.path("new.json"); }
  void expect_no_file(const std::string& arguments) const {
    EXPECT_EQ(command_.names(), (std::vector<std::string>{"good.ngc", "warned.ngc"})) << arguments;
  }

  Command command_;
  std::string good_ = command_.write("good.ngc", "G1 X1 F600\n");
  std::string warned_ = command_.write("warned.ngc", "G1 X1 F60000\n");
};

TEST_F(StandardStreams, ClosedOrFullOutputIsAnErrorOfEveryCommand) {
  for (const std::string& arguments :
       {"run " + good_, "run " + good_ + " --engine model --json -",
        "run " + good_ + " --engine model --json /dev/stdout", "run " + good_ + " --check",
        std::string("line --to 3,4"), std::string("info"), std::string("dump"), std::string("monitor --interval 0.01"),
        std::string("selftest"), std::string("serve --fast --engine model"), std::string("methods"),
        std::string("steps --method steer --circle 5"), std::string("compare --random 20"),
        "reproduce --out " + command_.path("pages"), std::string("completion bash"), std::string("man"),
        std::string("help run"), std::string("--help"), std::string("--version")}) {
    for (const char* where : {" >/dev/full", " >&-"}) {
      const Outcome outcome = run(arguments + where);
      EXPECT_EQ(outcome.status, 1) << arguments << where;
      EXPECT_NE(outcome.err.find("could not be written to its end: "), std::string::npos) << outcome.err;
      expect_no_file(arguments);
    }
  }
  EXPECT_EQ(run("run " + good_ + " --engine model --json " + json() + " >/dev/full").status, 1);
  expect_no_file("a run that counts as failed");
}

// Without standard error, the exit status is the only report.
TEST_F(StandardStreams, LostMessageOfAnErrorLeavesItsStatus) {
  for (const std::string& arguments :
       {"run " + command_.path("none.ngc"), "run " + good_ + " --bogus", std::string("line"),
        std::string("info --axes 9"), std::string("monitor --looks x"), std::string("dump --card tcp:"),
        std::string("selftest --card tcp:"), std::string("serve --port x"), std::string("steps --method none"),
        std::string("compare"), "reproduce --out " + good_, std::string("completion none"), std::string("help none"),
        std::string("none"), std::string()}) {
    for (const char* where : {" 2>&-", " 2>/dev/full", " <&- >&- 2>&-"}) {
      EXPECT_EQ(run(arguments + where).status, 2) << arguments << where;
      expect_no_file(arguments);
    }
  }
}

TEST_F(StandardStreams, LostWarningOrSummaryIsAnError) {
  const std::string run_warned = "run " + warned_ + " --engine model --json " + json();
  for (const char* where : {" 2>&-", " 2>/dev/full"}) {
    EXPECT_EQ(run(run_warned + where).status, 1) << where;
    EXPECT_EQ(run(run_warned + " --check" + where).status, 1) << where;
    EXPECT_EQ(run(run_warned + where).out, "") << "no summary of a run that failed";
    EXPECT_EQ(run("run " + good_ + " --engine model --json -" + where).status, 1)
        << "the summary goes to standard error";
    expect_no_file(where);
    EXPECT_EQ(run("run " + good_ + " --engine model" + where).status, 0) << "nothing was to be told";
  }
  EXPECT_EQ(run(run_warned).status, 0) << "or nothing above proves anything";
}

TEST_F(StandardStreams, ClosedInputIsNoProgram) {
  for (const std::string program : {"-", "/dev/stdin"}) {
    for (const char* option : {"", " --check", " --stream"}) {
      const Outcome outcome = run("run " + program + option + " --json " + json() + " <&-");
      EXPECT_EQ(outcome.status, 2) << program << option;
      EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
      expect_no_file(program + option);
    }
  }
  EXPECT_NE(run("run - <&-").err.find("standard input: is closed"), std::string::npos);
  EXPECT_EQ(run("run " + good_ + " --engine model <&-").status, 0) << "where nothing is read from it";
}

// Otherwise an output file would get the descriptor of a closed stream, and the printed text with it.
TEST_F(StandardStreams, ClosedStreamsLeaveTheFilesAlone) {
  const std::string with = "run " + good_ + " --engine model --steps ";
  ASSERT_EQ(run(with + command_.path("expected")).status, 0);
  ASSERT_EQ(run(with + command_.path("steps") + " <&- 2>&-").status, 0);
  EXPECT_EQ(contents(command_.path("steps")), contents(command_.path("expected")));
}

TEST_F(StandardStreams, ReaderThatGoesAwayEndsTheCommand) {
  const Outcome outcome = run("steps --method steer --circle 5000 > >(head -n 1 >'" + command_.path("first") + "')");
  EXPECT_EQ(outcome.status, 128 + SIGPIPE);
  EXPECT_EQ(outcome.err, "");
}

}  // namespace
}  // namespace trammel::test
