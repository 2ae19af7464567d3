// Programs that can be read only once are copied before they run. Tests the limit of the copy's size, and that no copy
// remains.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <filesystem>

#include "command.hpp"

namespace trammel::test {
namespace {

// A copy without end fails at 64 MiB instead of filling the disk.
Outcome run_program(const Command& command, const std::string& arguments) {
  return command.run_in(".", "ulimit -f 65536; timeout 60", "run " + arguments);
}

void expect_program_refused(const Outcome& outcome, const std::string& message) {
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
}

TEST(ProgramCopy, EndlessProgramIsRefused) {
  const Command command;
  for (const std::string source : {"- < <(yes 'G1 X1')", "<(yes '')"}) {
    const Outcome outcome = run_program(command, "--pipe-limit 1 " + source);
    expect_program_refused(outcome, "longer than 1 MiB");
    EXPECT_NE(outcome.err.find("--pipe-limit"), std::string::npos) << outcome.err;
  }
  expect_program_refused(run_program(command, "--pipe-limit 1 --stream -"), "--pipe-limit");
}

TEST(ProgramCopy, LimitIsOfPipesAloneAndCanBeRaised) {
  const Command command;
  std::string comments;
  while (comments.size() < (1U << 20U)) comments += "(" + std::string(60000, ' ') + ")\n";
  const std::string file = command.write("long.ngc", comments + "G1 X1 F600\n");
  expect_program_refused(run_program(command, "--check --pipe-limit 1 - < <(cat " + file + ")"), "longer than 1 MiB");
  EXPECT_EQ(run_program(command, "--check --pipe-limit 2 - < <(cat " + file + ")").status, 0);
  EXPECT_EQ(run_program(command, "--check - < <(cat " + file + ")").status, 0) << "without the option";
  EXPECT_EQ(run_program(command, "--check --pipe-limit 1 - <" + file).status, 0) << "a regular file";
  EXPECT_EQ(run_program(command, "--check --pipe-limit 1 " + file).status, 0);
}

// The reader's limit for the length of a line also holds during the copy.
TEST(ProgramCopy, LineWithoutEndIsRefused) {
  const Command command;
  expect_program_refused(run_program(command, "/dev/zero"), "/dev/zero:1: a line of more than 65535 bytes");
  expect_program_refused(run_program(command, "- </dev/zero"), "standard input:1: a line of more than 65535 bytes");
  expect_program_refused(run_program(command, "- < <(echo G1 X1 F600; cat /dev/zero)"), "standard input:2: a line of");
  expect_program_refused(run_program(command, command.write("ok.ngc", "G1 X1 F600\n") + " --parameters /dev/zero"),
                         "/dev/zero:1: must be the number of a parameter");
}

// The command is killed during the copy. By then it has read more from the FIFO than a pipe holds.
TEST(ProgramCopy, KillLeavesNothing) {
  const Command command;
  std::filesystem::create_directory(command.path("temporary"));
  ASSERT_EQ(::mkfifo(command.path("fifo").c_str(), 0600), 0);
  const std::string fifo = "'" + command.path("fifo") + "'";
  const Outcome outcome =
      command.run_in(".", "TMPDIR='" + command.path("temporary") + "'",
                     "run " + fifo + " & process=$!; exec 3>" + fifo +
                         "; yes 'G1 X1' | head -c 1000000 >&3; kill -KILL $process; wait $process 2>/dev/null");
  EXPECT_EQ(outcome.status, 128 + SIGKILL);
  EXPECT_TRUE(std::filesystem::is_empty(command.path("temporary")));
}

}  // namespace
}  // namespace trammel::test
