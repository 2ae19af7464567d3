// Reading, planning and encoding a program must take memory that does not grow with its length. Compares the peak
// memory of two processes, with programs of two lengths.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

constexpr long kTolerance = 300;  // kB; the loader and the allocator vary by some pages

struct Process {
  bool good = false;
  long peak = 0;  // kB
  double seconds = 0;
};

Process run(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const auto begin = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) {
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  if (child < 0 || wait4(child, &status, 0, &usage) != child) return {};
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  return {WIFEXITED(status) && WEXITSTATUS(status) == 0, usage.ru_maxrss, time.count()};
}

// Compares the memory for a short and a long program; the long one is longer if TRAMMEL_LONG is set.
class Memory : public testing::Test {
 protected:
  void SetUp() override {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizer keeps what is freed";
#endif
  }
  // Growth of the peak from `few` to `many` lines, kB.
  static long growth(std::vector<std::string> command, long few, long many) {
    command.emplace_back(fmt::format("generated:{}", few));
    // The peak includes pages of the executable only if they are in the system's page cache. A first run loads them.
    run(command);
    Process runs[2];
    for (const bool more : {false, true}) {
      const long lines = more ? many : few;
      command.back() = fmt::format("generated:{}", lines);
      Process& result = runs[more ? 1 : 0];
      result = run(command);
      fmt::print("{} lines: {} kB, {:.2f} s\n", lines, result.peak, result.seconds);
      EXPECT_TRUE(result.good);
      EXPECT_GT(result.peak, 500);
    }
    return runs[1].peak - runs[0].peak;
  }
  static bool is_long() { return std::getenv("TRAMMEL_LONG") != nullptr; }
};

TEST_F(Memory, OfThePipelineDoesNotGrowWithTheProgram) {
  EXPECT_LT(growth({TRAMMEL_COMMAND_STREAM, "--one"}, 100'000, is_long() ? 10'000'000 : 1'000'000), kTolerance);
}

// The whole run, on the model engine. With --plot the path is thinned from 20,000 points on, so only long programs have
// the full size in both runs.
TEST_F(Memory, OfARunDoesNotGrowWithTheProgram) {
  if (is_long()) {
    EXPECT_LT(growth({TRAMMEL_RUN, "--plot"}, 100'000, 1'000'000), kTolerance);
  } else {
    EXPECT_LT(growth({TRAMMEL_RUN}, 3'000, 30'000), kTolerance);
  }
}

TEST_F(Memory, OfAnObserverThatKeepsIsSeenToGrow) {
  EXPECT_GT(growth({TRAMMEL_RUN, "--keep"}, 3'000, 15'000), kTolerance);
}

// The test detects a leak of one byte per command.
TEST_F(Memory, OfASinkThatKeepsIsSeenToGrow) {
  EXPECT_GT(growth({TRAMMEL_COMMAND_STREAM, "--one", "--keep"}, 100'000, 300'000), kTolerance);
}

}  // namespace
