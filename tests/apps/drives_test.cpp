// `trammel drives`: the order for which motion waits with enable_manual, and the end of that order. `trammel line`
// writes [outputs] too.
#include <gtest/gtest.h>

#include "command.hpp"
#include "server.hpp"

namespace trammel::test {
namespace {

class Drives : public testing::Test {
 protected:
  std::string state(const Server& server) const { return command_.run("drives --card '" + server.url() + "'").out; }
  Outcome order(const Server& server, const std::string& arguments) const {
    return command_.run("drives --card " + server.moving() + " " + arguments);
  }

  Command command_;
  // The default machine with an enable output. With kManual, motion waits for an order.
  static constexpr const char* kManual = " --set outputs.enable=2 --set outputs.enable_manual=true ";
  static constexpr const char* kPlain = " --set outputs.enable=2 ";
};

TEST_F(Drives, AreEnabledByOrderAndStaySo) {
  const Server server(command_, "--fast");
  EXPECT_EQ(state(server),
            "drives   disabled (of no axis; motion does not wait for drives)\norder    off: motion enables them\n");
  EXPECT_EQ(order(server, std::string("on") + kManual).out, "drives   enabled\norder    on: they stay enabled\n");
  const Outcome moved = command_.run(std::string("jog X1 --card ") + server.moving() + kManual);
  EXPECT_EQ(moved.status, 0) << moved.err;
  EXPECT_EQ(state(server), "drives   enabled\norder    on: they stay enabled\n");
  EXPECT_EQ(order(server, std::string("off") + kManual).status, 0);
  EXPECT_NE(state(server).find("order    off: motion waits for `trammel drives on`\n"), std::string::npos);
}

TEST_F(Drives, AreRefusedWhatTheyCannotDo) {
  const Server server(command_, "--fast");
  const Outcome none = order(server, "on");
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("Name an output `enable` in [outputs]"), std::string::npos) << none.err;
  EXPECT_EQ(order(server, "perhaps").status, 2);
  EXPECT_EQ(command_.run("drives on").status, 2) << "no card";
  EXPECT_EQ(command_.run("drives on --card '" + server.url() + "'" + kPlain).status, 2) << "no token";
}

TEST_F(Drives, AreThoseOfALineToo) {
  const Server server(command_, "--fast");
  const Outcome line = command_.run("line --to 100 --card " + server.moving() + kPlain);
  EXPECT_EQ(line.status, 0) << line.err;
  EXPECT_EQ(state(server), "drives   enabled\norder    off: motion enables them\n");
}

}  // namespace
}  // namespace trammel::test
