// Real-time commands, homing, probing and several clients, as the user of a sender sees them. The card runs in real
// time.
#include <gmock/gmock.h>

#include "sender.hpp"

namespace trammel::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kFirstMachine =
    std::string(" --machine ") + TRAMMEL_EXAMPLES_DIR + "/first-machine.toml --world default";

class Controls : public ::testing::Test {
 protected:
  Command command_;
  GrblServer server_{command_, "--engine model"};
  Sender sender_{server_};
};

TEST_F(Controls, AHoldStopsOnThePathAndResumeGoesOn) {
  sender_.put("G21 G91 G1 F3000 X40 Y20\n");
  EXPECT_TRUE(eventually([&] { return sender_.axis(0) > 5; }));
  sender_.put("!");
  ASSERT_TRUE(sender_.await_state("Hold:0"));
  const double x = sender_.axis(0);
  EXPECT_GT(x, 5);
  EXPECT_LT(x, 39);
  EXPECT_NEAR(sender_.axis(1), x / 2, 0.02) << "on the line";
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(sender_.axis(0), x);
  sender_.put("~");
  ASSERT_TRUE(sender_.await_state("Idle"));
  EXPECT_EQ(sender_.place(), "40.000,20.000,0.000");
}

TEST_F(Controls, AResetInMotionKeepsThePosition) {
  sender_.put("G21 G91 G1 F3000 X60\nX-60\nX60\n");
  EXPECT_TRUE(eventually([&] { return sender_.axis(0) > 5; }));
  sender_.put("\x18");
  EXPECT_EQ(sender_.until("Grbl "), "Grbl 1.1h ['$' for help]");
  EXPECT_EQ(sender_.state(), "Idle") << "no alarm: nothing was lost";
  const double x = sender_.axis(0);
  EXPECT_GT(x, 5);
  EXPECT_LT(x, 59);
  EXPECT_EQ(sender_.ask("G90 G0 X0"), "ok");
  ASSERT_TRUE(sender_.await_state("Idle"));
  EXPECT_EQ(sender_.place(), "0.000,0.000,0.000");
  EXPECT_THAT(sender_.report(), Not(HasSubstr("ALARM")));
}

TEST_F(Controls, AJogIsCancelledOnARamp) {
  EXPECT_EQ(sender_.ask("$J=G91 G21 X500 F4000"), "ok");
  EXPECT_EQ(sender_.state(), "Jog");
  EXPECT_EQ(sender_.ask("G1 X1 F100"), "error:9");
  EXPECT_TRUE(eventually([&] { return sender_.axis(0) > 5; }));
  sender_.put("\x85");
  ASSERT_TRUE(sender_.await_state("Idle"));
  const double x = sender_.axis(0);
  EXPECT_LT(x, 200);
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(sender_.axis(0), x);
  EXPECT_EQ(sender_.ask("$J=G90 G21 X0 F6000"), "ok") << "the cancel is over, and the next jog goes its way";
  ASSERT_TRUE(sender_.await_state("Idle"));
  EXPECT_EQ(sender_.place(), "0.000,0.000,0.000");
}

TEST_F(Controls, OverridesActOnThePath) {
  sender_.put("G21 G91 G1 F1200 X40\n");
  EXPECT_TRUE(eventually([&] { return sender_.axis(0) > 2; }));
  for (int n = 0; n < 5; ++n) sender_.put("\x92");  // -10 % each
  EXPECT_TRUE(eventually([&] { return sender_.report().find("FS:600,") != std::string::npos; })) << sender_.report();
  sender_.put("\x90");
  ASSERT_TRUE(sender_.await_state("Idle"));
  EXPECT_EQ(sender_.place(), "40.000,0.000,0.000");
}

TEST_F(Controls, WhatSendersDoBesides) {
  // cncjs encodes bytes over 0x7F as UTF-8; others send CR LF, '%', blank lines, and '?' all the time.
  sender_.put("%\r\n\r\nG21 G91\r\nG1 X20 F2000 (a comment)\r\n");
  for (int n = 0; n < 4; ++n) EXPECT_EQ(sender_.line(), "ok");
  for (int n = 0; n < 10; ++n) {
    EXPECT_THAT(sender_.report(), HasSubstr("MPos:"));
    std::this_thread::sleep_for(20ms);
  }
  sender_.put("\xC2\x91");
  ASSERT_TRUE(sender_.await_state("Idle"));
  // bCNC's end of a job: a hold in Idle, a reset, and the modal words that bCNC has stored.
  sender_.put("!");
  std::this_thread::sleep_for(100ms);
  sender_.put("\x18");
  EXPECT_EQ(sender_.until("Grbl "), "Grbl 1.1h ['$' for help]");
  EXPECT_EQ(sender_.ask("G43.1Z0"), "ok");
  EXPECT_EQ(sender_.ask("$G"), "ok");
  EXPECT_EQ(sender_.place(), "20.000,0.000,0.000");
  EXPECT_EQ(sender_.state(), "Idle");
}

TEST_F(Controls, OneClientSendsTheOthersRead) {
  Sender reader(server_, false);
  EXPECT_THAT(reader.until("[MSG:"), HasSubstr("Another client sends"));
  reader.put("G91 G1 X5 F6000\n$X\n\x18");
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(sender_.place(), "0.000,0.000,0.000") << "what a reader sends moves nothing";
  EXPECT_THAT(reader.report(), HasSubstr("<Idle|"));
  sender_.put("G91 G1 X40 F3000\n");
  EXPECT_TRUE(eventually([&] { return sender_.axis(0) > 2; }));
  reader.put("!");
  EXPECT_TRUE(sender_.await_state("Hold:0")) << "but everybody may stop the machine";
  sender_.put("~");
  EXPECT_TRUE(sender_.await_state("Idle"));
}

TEST(ControlsOfAMachine, HomingSoftLimitsAndProbing) {
  const Command command;
  GrblServer server(command, "--engine model" + kFirstMachine);
  Sender sender(server);
  EXPECT_EQ(sender.state(), "Alarm") << "not homed yet";
  EXPECT_EQ(sender.ask("G0 X1"), "error:9");
  EXPECT_EQ(sender.ask("$H"), "ok") << server.errors();
  EXPECT_EQ(sender.state(), "Idle");
  EXPECT_EQ(sender.place(), "0.000,0.000,0.000") << "the final position of homing";
  EXPECT_EQ(sender.ask("G90 G1 X-100 F3000"), "ALARM:2") << "beyond the soft limit, before anything moves";
  EXPECT_EQ(sender.place(), "0.000,0.000,0.000");
  EXPECT_EQ(sender.ask("G1 X1 F1000"), "error:9");
  EXPECT_EQ(sender.ask("$X"), "ok");
  EXPECT_EQ(sender.ask("$J=G91 X-100 F3000"), "error:15") << "a jog beyond it is refused without an alarm";
  EXPECT_EQ(sender.ask("G1 X1 F1000"), "ok");
  EXPECT_TRUE(sender.await_state("Idle"));
  EXPECT_EQ(sender.place(), "1.000,0.000,0.000");
}

TEST(ControlsOfAMachine, AResetWhileHomingIsAlarmSix) {
  const Command command;
  GrblServer server(command, "--engine model" + kFirstMachine);
  Sender sender(server);
  sender.put("$H\n");
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(sender.state(), "Home");
  sender.put("\x18");
  EXPECT_EQ(sender.until("ALARM:"), "ALARM:6");
  EXPECT_TRUE(sender.await_state("Alarm"));
}

TEST(Settings, AreKeptInTheirFile) {
  const Command command;
  const std::string file = command.path("grbl-settings");
  {
    GrblServer server(command, "--engine model --settings " + file);
    Sender sender(server);
    EXPECT_EQ(sender.ask("$110=1200"), "ok");
    EXPECT_EQ(sender.ask("G10 L2 P3 X12.5"), "ok");
    server.end();
  }
  const Command again;
  GrblServer server(again, "--engine model --settings " + file);
  Sender sender(server);
  EXPECT_EQ(sender.ask("$$"), "ok");
  EXPECT_THAT(sender.told(), ::testing::Contains("$110=1200.000"));
  EXPECT_EQ(sender.ask("$#"), "ok");
  EXPECT_THAT(sender.told(), ::testing::Contains("[G56:12.500,0.000,0.000]"));
}

}  // namespace
}  // namespace trammel::test
