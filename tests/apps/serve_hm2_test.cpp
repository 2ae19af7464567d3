// The command line of `trammel serve --hm2`. LinuxCNC itself is tested in tests/linuxcnc_hm2.
#include <gtest/gtest.h>

#include "command.hpp"

namespace trammel::test {
namespace {

TEST(ServeHm2, WhatCannotBeIsOneLineAndStatus2) {
  const Command command;
  const std::pair<const char*, const char*> refusals[] = {
      {"--hm2 192.0.2.1", "no such address of this machine"},
      {"--hm2 127.0.0.1:port", "must be HOST or HOST:PORT"},
      {"--hm2 127.0.0.1:65536", "must be HOST or HOST:PORT"},
      {"--hm2 --pty", "excludes --hm2"},
      {"--hm2 --fast", "excludes --hm2"},
      {"--hm2-lose 1", "requires --hm2"},
      {"--hm2 --hm2-lose 101", "--hm2-lose"},
  };
  for (const auto& [options, message] : refusals) {
    const Outcome outcome = command.run(std::string("serve ") + options);
    EXPECT_EQ(outcome.status, 2) << options;
    EXPECT_EQ(count_lines(outcome.err), 1U) << options << '\n' << outcome.err;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << options << '\n' << outcome.err;
  }
}

TEST(ServeHm2, ASecondServerOnThePortIsToldSoAndTheFirstOneCounts) {
  const Command command;
  Running first(command, "serve --hm2 127.0.0.1:0 --axes 3", "first.err", "first.out");
  ASSERT_TRUE(eventually([&] { return contents(command.path("first.out")).find("hostmot2 at ") == 0; }));
  const std::string out = contents(command.path("first.out"));
  const std::string place = out.substr(12, out.find('\n') - 12);
  const Outcome second = command.run("serve --hm2 " + place);
  EXPECT_EQ(second.status, 2);
  EXPECT_NE(second.err.find("is in use"), std::string::npos) << second.err;
  first.signal(SIGTERM);
  const std::optional<int> status = first.wait();
  EXPECT_TRUE(status && WIFEXITED(*status) && WEXITSTATUS(*status) == 0);
  const std::string err = contents(command.path("first.err"));
  EXPECT_NE(err.find("has no hardware address"), std::string::npos) << err;
  EXPECT_NE(err.find("0 drivers; 0 datagrams, 0 answered, 0 refused"), std::string::npos) << err;
  EXPECT_NE(err.find("pulses at the pins 0 0 0; counters 0 0 0;"), std::string::npos) << err;
}

}  // namespace
}  // namespace trammel::test
