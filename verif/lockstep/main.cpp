// Runs the tests of a lockstep executable. With --seeded-bug it passes only if they report a mismatch, see judge().
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string_view>

#include "trammel/sim/lockstep.hpp"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const bool seeded_bug = argc == 2 && std::string_view(argv[1]) == "--seeded-bug";
  if (argc != 1 && !seeded_bug) {
    fmt::print(stderr, "usage: {} [--seeded-bug] [GoogleTest's options]\n", argv[0]);
    return 2;
  }
  if (seeded_bug) trammel::lockstep::expect_seeded_bug();
  const int failed = RUN_ALL_TESTS();
  if (!seeded_bug) fmt::print("{} clocks compared in lockstep\n", trammel::lockstep::compared());
  if (!seeded_bug || failed != 0) return failed;
  const std::string& report = trammel::lockstep::caught();
  fmt::print("{}", report.empty() ? "the seeded bug was not caught\n" : "caught: " + report);
  return report.empty() ? 1 : 0;
}
