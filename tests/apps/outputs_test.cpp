// Output files are complete or absent, for every kind of file and every end of the command.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <chrono>
#include <thread>

#include "command.hpp"

namespace trammel::test {
namespace {

using Names = std::vector<std::string>;

// A short program and one that takes long, as files in the command's directory.
class OutputFiles : public testing::Test {
 protected:
  std::string at(const std::string& name) const { return command_.path(name); }
  Outcome run(const std::string& arguments) const { return command_.run("run " + short_ + " " + arguments); }
  // The list of steps that an undisturbed run writes.
  std::string steps() const {
    EXPECT_EQ(run("--steps " + at("plain")).status, 0);
    std::string text = contents(at("plain"));
    std::filesystem::remove(at("plain"));
    EXPECT_EQ(count_lines(text), 81U) << "a header and the pulses of 1 mm";
    return text;
  }
  void expect_refused(const std::string& arguments, const std::string& message) const {
    const Names before = command_.names();
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << arguments << '\n' << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(command_.names(), before) << arguments;
    EXPECT_EQ(contents(short_), kShort) << arguments;
  }

  static constexpr const char* kShort = "G1 X1 F600\n";
  Command command_;
  std::string short_ = command_.write("short.ngc", kShort);
  std::string long_ = command_.write("long.ngc", "G1 X1000 F60\n");  // 1000 s of card time
};

TEST_F(OutputFiles, RegularFileIsReplacedWithItsRights) {
  const std::string expected = steps();
  command_.write("steps.csv", "old");
  std::filesystem::permissions(at("steps.csv"), std::filesystem::perms(0640));
  ASSERT_EQ(run("--steps " + at("steps.csv")).status, 0);
  EXPECT_EQ(contents(at("steps.csv")), expected);
  EXPECT_EQ(std::filesystem::status(at("steps.csv")).permissions(), std::filesystem::perms(0640));
  EXPECT_EQ(command_.names(), (Names{"long.ngc", "short.ngc", "steps.csv"})) << "nothing is left beside it";
}

TEST_F(OutputFiles, SymbolicLinkIsFollowed) {
  const std::string expected = steps();
  std::filesystem::create_directory(at("folder"));
  std::filesystem::create_symlink("folder/there.csv", at("existing"));
  command_.write("folder/there.csv", "old");
  std::filesystem::create_symlink("folder/new.csv", at("dangling"));
  for (const std::string name : {"existing", "dangling"}) {
    ASSERT_EQ(run("--steps " + at(name)).status, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(at(name))) << name;
    EXPECT_EQ(contents(at(name)), expected) << name;
  }
  EXPECT_EQ(contents(at("folder/there.csv")), expected);
  EXPECT_EQ(contents(at("folder/new.csv")), expected);
}

TEST_F(OutputFiles, FifoAndProcessSubstitutionAreWrittenAsTheyAre) {
  const std::string expected = steps();
  ASSERT_EQ(::mkfifo(at("fifo").c_str(), 0600), 0);
  const Outcome fifo = command_.run_in(".", "cat '" + at("fifo") + "' >'" + at("read") + "' &",
                                       "run " + short_ + " --steps " + at("fifo") + "; status=$?; wait; exit $status");
  ASSERT_EQ(fifo.status, 0) << fifo.err;
  EXPECT_TRUE(std::filesystem::is_fifo(at("fifo")));
  EXPECT_EQ(contents(at("read")), expected);
  std::filesystem::remove(at("read"));
  const Outcome substituted = run("--steps >(cat >'" + at("half") + "'; mv '" + at("half") + "' '" + at("read") + "')");
  ASSERT_EQ(substituted.status, 0) << substituted.err;
  EXPECT_TRUE(eventually([&] { return contents(at("read")) == expected; }));
}

TEST_F(OutputFiles, WaveformGoesWhereTheOthersGo) {
  ASSERT_EQ(run("--trace " + at("x.fst")).status, 0);
  const std::size_t size = contents(at("x.fst")).size();
  EXPECT_GT(size, 1000U);
  ASSERT_EQ(run("--trace - >'" + at("y.fst") + "'").status, 0);
  EXPECT_EQ(contents(at("y.fst")).size(), size);
  EXPECT_EQ(command_.names(), (Names{"long.ngc", "short.ngc", "x.fst", "y.fst"}));
}

TEST_F(OutputFiles, DashIsStandardOutputAndTheSummaryMoves) {
  const std::string expected = steps();
  for (const std::string name : {"-", "/dev/stdout"}) {
    const Outcome outcome = run("--steps " + name);
    ASSERT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.out, expected) << name;
    EXPECT_NE(outcome.err.find("pulses made"), std::string::npos) << name;
  }
  EXPECT_NE(run("--json -").out.find("\"final_position\""), std::string::npos);
  EXPECT_NE(run("--plot -").out.find("</svg>"), std::string::npos);
  EXPECT_NE(run("--path-steps -").out.find("command,tick,axis,direction"), std::string::npos);
  EXPECT_EQ(run("").err, "") << "else the summary is on standard output";
  const Outcome line = command_.run("line --to 3,4 --json -");
  EXPECT_TRUE(nlohmann::json::accept(line.out)) << line.out;
  EXPECT_NE(line.err.find("line of 3, 4 pulses"), std::string::npos);
  const Outcome compare = command_.run("compare --random 20 --json -");
  EXPECT_TRUE(nlohmann::json::accept(compare.out));
  EXPECT_NE(compare.err.find("one-shot"), std::string::npos);
}

TEST_F(OutputFiles, SameFileTwiceIsRefused) {
  command_.write("a.csv", "old");
  std::filesystem::create_hard_link(at("a.csv"), at("hard"));
  std::filesystem::create_symlink("a.csv", at("soft"));
  std::filesystem::create_symlink("not_yet", at("dangling"));
  const std::string twice = "both would be written to";
  expect_refused("--json - --steps -", twice);
  expect_refused("--json - --steps /dev/stdout", twice);
  expect_refused("--json " + at("new") + " --plot " + at("new"), twice);
  expect_refused("--json " + at("new") + " --plot " + at("./new"), twice);
  expect_refused("--json " + at("dangling") + " --plot " + at("not_yet"), twice);
  expect_refused("--json " + at("a.csv") + " --steps " + at("hard"), twice);
  expect_refused("--path-steps " + at("soft") + " --steps " + at("a.csv"), twice);
  EXPECT_EQ(contents(at("a.csv")), "old");
  EXPECT_EQ(run("--json /dev/null --steps /dev/null").status, 0) << "any number may write there";
  const Outcome other = command_.run("steps --method steer --circle 5 --csv " + at("b") + " --json " + at("b"));
  EXPECT_EQ(other.status, 2);
}

TEST_F(OutputFiles, ProgramAndMachineFileAreNotOverwritten) {
  std::filesystem::create_hard_link(short_, at("hard"));
  std::filesystem::create_symlink(short_, at("soft"));
  const std::string machine = command_.write("machine.toml", contents(TRAMMEL_EXAMPLES_DIR "/machine.toml"));
  expect_refused("--steps " + short_, "is the program");
  expect_refused("--json " + at("hard"), "is the program");
  expect_refused("--plot " + at("soft"), "is the program");
  expect_refused("--trace " + at("./short.ngc"), "is the program");
  expect_refused("--machine " + machine + " --path-steps " + machine, "is the machine file");
  EXPECT_EQ(contents(machine), contents(TRAMMEL_EXAMPLES_DIR "/machine.toml"));
  const Outcome outcome = command_.run("run - --steps " + short_ + " <" + short_);
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(contents(short_), kShort);
}

TEST_F(OutputFiles, FullDiskIsAnErrorAndLeavesNothing) {
  command_.write("old.json", "old");
  const Names before = command_.names();
  for (const std::string option : {"--steps", "--path-steps", "--json", "--plot", "--trace"}) {
    const std::string others = option == "--json" ? " --plot " + at("new.svg") : " --json " + at("old.json");
    const Outcome outcome = run(option + " /dev/full" + others);
    EXPECT_EQ(outcome.status, 1) << option;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_EQ(outcome.out, "") << "no summary of a run that failed";
    EXPECT_EQ(command_.names(), before) << option;
    EXPECT_EQ(contents(at("old.json")), "old") << option;
  }
  // The file's size is limited, as on a full disk.
  for (const std::string option : {"--plot", "--trace"}) {
    const Outcome limited = command_.run_in(".", "ulimit -f 1;", "run " + short_ + " " + option + " " + at("old.json"));
    EXPECT_EQ(limited.status, 1) << limited.err;
    EXPECT_EQ(count_lines(limited.err), 1U) << limited.err;
    EXPECT_EQ(command_.names(), before) << option;
    EXPECT_EQ(contents(at("old.json")), "old") << option;
  }
}

// The signal comes during the run, when the temporary files exist.
TEST_F(OutputFiles, SignalLeavesWhatWasThere) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    command_.write("steps.csv", "old");
    const Names before = command_.names();
    Running running(command_,
                    "run " + long_ + " --steps " + at("steps.csv") + " --json " + at("new.json") + " --plot " +
                        at("new.svg") + " --trace-window 0:0.01 --trace " + at("new.fst"),
                    "stderr");
    ASSERT_TRUE(eventually([&] { return command_.names().size() >= before.size() + 5; })) << "or nothing is proved";
    running.signal(number);
    const auto status = running.wait();
    ASSERT_TRUE(status) << "still runs after signal " << number;
    EXPECT_TRUE(WIFSIGNALED(*status) && WTERMSIG(*status) == number) << *status;
    EXPECT_EQ(command_.names(), before) << number;
    EXPECT_EQ(contents(at("steps.csv")), "old") << number;
  }
}

// If the simulated card moves, it is stopped first, so that its position can be reported.
TEST_F(OutputFiles, SignalTellsWhereTheSimulatedCardStands) {
  const std::string fast = command_.write("fast.ngc", "G1 X1000 F6000\n");
  for (const std::string engine : {"rtl", "model"}) {
    const Names before = command_.names();
    // At 80,000 steps/s a list that is not empty tells that the card moves.
    Running running(command_,
                    "run " + fast + " --set axis.x.steps_per_mm=800 --card sim: --clock 1000000 --engine " + engine +
                        " --steps " + at("steps.csv"),
                    "stderr");
    const auto moves = [&] {
      for (const std::string& name : command_.names()) {
        if (name.rfind(".trammel-", 0) == 0 && std::filesystem::file_size(at(name)) > 0) return true;
      }
      return false;
    };
    ASSERT_TRUE(eventually(moves)) << contents(at("stderr"));
    running.signal(SIGINT);
    const auto status = running.wait();
    EXPECT_TRUE(status && WIFSIGNALED(*status) && WTERMSIG(*status) == SIGINT) << engine;
    const std::string said = contents(at("stderr"));
    EXPECT_NE(said.find("stopped by SIGINT: line 1, X at pulse "), std::string::npos) << said;
    EXPECT_EQ(command_.names(), before) << engine;
  }
}

TEST_F(OutputFiles, ReaderThatGoesAwayLeavesNothing) {
  const Names before = command_.names();
  const Outcome outcome = command_.run("run " + long_ + " --engine model --clock 1000000 --json " + at("new.json") +
                                       " --steps - > >(head -n 1 >/dev/null)");
  EXPECT_EQ(outcome.status, 128 + SIGPIPE);
  EXPECT_EQ(command_.names(), before);
}

// One of the files cannot be put in place: then the old a.json must not be replaced either.
TEST_F(OutputFiles, NoOldFileBesideANewOne) {
  command_.write("a.json", "old");
  ASSERT_EQ(::mkfifo(at("fifo").c_str(), 0600), 0);
  Running running(command_,
                  "run " + short_ + " --json " + at("a.json") + " --path-steps " + at("b.csv") + " --plot " +
                      at("c.svg") + " --steps " + at("fifo"),
                  "stderr");
  // The command has checked the names and now waits for a reader of the FIFO.
  ASSERT_TRUE(eventually([&] { return command_.names().size() >= 5; }));
  std::filesystem::create_directory(at("c.svg"));
  const Outcome reader = command_.run_in(".", "cat '" + at("fifo") + "' >'" + at("read") + "'; true", "--version");
  EXPECT_EQ(reader.status, 0);
  const auto status = running.wait();
  ASSERT_TRUE(status);
  EXPECT_TRUE(WIFEXITED(*status) && WEXITSTATUS(*status) == 1) << *status;
  EXPECT_EQ(contents(at("a.json")), "old");
  EXPECT_EQ(command_.names(), (Names{"a.json", "c.svg", "fifo", "long.ngc", "read", "short.ngc"}));
}

TEST_F(OutputFiles, ReproduceLeavesItsFolderAlone) {
  EXPECT_EQ(command_.run("reproduce --out " + short_).status, 2);
  EXPECT_EQ(command_.run("reproduce --out " + at("short.ngc/below")).status, 2);
  Running running(command_, "reproduce --out " + at("pages"), "stderr");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  running.signal(SIGTERM);
  ASSERT_TRUE(running.wait());
  EXPECT_FALSE(std::filesystem::exists(at("pages")));
}

}  // namespace
}  // namespace trammel::test
