// `trammel run --resume` and `--from-line` on a served card: hosts that are killed or stopped, and the run that
// continues.
#include <gmock/gmock.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "bad_cable.hpp"
#include "resumed_run.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/transport/card_url.hpp"
#include "trammel/transport/connection.hpp"

namespace trammel::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// With TRAMMEL_LONG, 200 kills.
TEST_F(ResumedRun, OfAHostThatIsKilledAgainAndAgainMakesTheUndisturbedPath) {
  const std::string whole = undisturbed();
  const int kills = std::getenv("TRAMMEL_LONG") != nullptr ? 200 : 10;
  std::mt19937 random(1);
  if (kills > 10) write_long_program();
  const std::string wanted = kills > 10 ? undisturbed() : whole;
  for (int i = 0; i < kills; ++i) {
    // An override of 10 percent changes no step, and makes the run long enough for all kills.
    Running client = start(std::string("--override 10") + (i == 0 ? "" : " --resume"));
    end(client, SIGKILL, static_cast<int>(random() % 400), i != 0);
    ASSERT_FALSE(HasFailure()) << i;
  }
  const Outcome last = run("--resume");
  EXPECT_EQ(last.status, 0) << last.err;
  EXPECT_THAT(last.err, HasSubstr("the run begins at line "));
  EXPECT_EQ(path_of(server_.end()), wanted) << server_.errors();
}

TEST_F(ResumedRun, OfAHostThatWasStoppedInOrder) {
  Running client = start();
  end(client, SIGINT, 300);
  EXPECT_THAT(contents(command_.path(said_in())),
              AllOf(HasSubstr("note: the run was stopped in command "), HasSubstr(" ticks before its end (exact); "),
                    HasSubstr("--resume continues the run")));
  EXPECT_THAT(command_.run("recover --card " + server_.url()).out, HasSubstr("p.ngc --resume`"));
  const Outcome resumed = run("--resume");
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_THAT(resumed.out, HasSubstr("X: ends at pulse 0"));
  EXPECT_EQ(path_of(server_.end()), undisturbed());
}

// The run keeps its own hold until its first piece that moves has begun, and then releases it on a ramp.
TEST_F(ResumedRun, AConnectionMadeAnewInTheSilenceDoesNotTakeTheHoldBack) {
  command_.write("p.ngc", "G1 X900 F9000\n");
  const std::string file = "--resume-file " + command_.path("own.json");
  Running killed = start(file);
  end(killed, SIGKILL, 3000);
  transport::Connection reader(transport::parse_card_url(server_.url()));
  driver::Card card = driver::Card::open(reader.bus());
  ASSERT_TRUE(eventually([&] { return card.read_status().held; }));
  BadCable cable(server_.url());
  Running resumed(command_,
                  "run " + command_.path("p.ngc") + " --resume " + file + " --set motion.watchdog=40 --card '" +
                      cable.url() + "?token=secret'",
                  "resumed.err");
  // The silent piece repeats the ticks of the interrupted run at one tick per clock, which takes some seconds.
  const auto in_silence = [&] { return card.read_status().path_active && card.read_snapshot().feed_begun == 1; };
  ASSERT_TRUE(eventually(in_silence)) << contents(command_.path("resumed.err"));
  const std::int32_t stands = card.read_snapshot().position[0];
  cable.cut();
  ASSERT_TRUE(eventually([&] {
    return contents(command_.path("resumed.err")).find("was lost and made again") != std::string::npos;
  })) << server_.errors();
  unsigned looks = 0;
  for (;; ++looks) {
    const std::uint32_t hold = card.parts().registers.read(card_map::reg::kHold);
    const driver::Snapshot now = card.read_snapshot();
    if (now.feed_begun != 1) break;
    ASSERT_EQ(hold, 1U) << looks;
    ASSERT_EQ(now.position[0], stands);
  }
  EXPECT_GT(looks, 10U);
  const auto moves = [&] { return card.read_snapshot().position[0] != stands; };
  EXPECT_TRUE(eventually(moves)) << "the run ends its hold itself";
  resumed.signal(SIGINT);
  resumed.wait();
}

TEST_F(ResumedRun, GoesBackFirstWhereTheMachineWasMoved) {
  interrupt();
  ASSERT_EQ(command_.run("jog X1 Y-1 --card " + server_.moving()).status, 0);
  const std::string moved = position();
  const Outcome asked = run("--resume");
  expect_refused(asked, "Give --yes to allow this move");
  EXPECT_THAT(asked.err, HasSubstr("the machine moves there first, on a straight line at 37.5 mm/s"));
  EXPECT_EQ(position(), moved);
  const Outcome resumed = run("--resume --yes");
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  const std::string whole = undisturbed();
  const int steps = std::stoi(whole.substr(6));
  EXPECT_THAT(server_.end(), HasSubstr("path: " + std::to_string(steps + 4 * 80) + " steps"));
}

TEST_F(ResumedRun, AsksOnATerminal) {
  interrupt();
  ASSERT_EQ(command_.run("jog X1 --card " + server_.moving()).status, 0);
  const std::string moved = position();
  const PseudoTerminal terminal;
  for (const std::string answer : {"n", "y"}) {
    Running client(command_, line("--resume"), answer + ".err", terminal);
    ASSERT_TRUE(
        eventually([&] { return contents(command_.path(answer + ".err")).find("[y/N]") != std::string::npos; }));
    EXPECT_EQ(position(), moved);
    terminal.type(answer + "\n");
    const std::optional<int> status = client.wait();
    ASSERT_TRUE(status && WIFEXITED(*status)) << contents(command_.path(answer + ".err"));
    EXPECT_EQ(WEXITSTATUS(*status), answer == "y" ? 0 : 2);
  }
  EXPECT_THAT(contents(command_.path("n.err")), HasSubstr("nothing has moved"));
}

TEST_F(ResumedRun, IsRefusedByNameWhereItIsNotTheRunThatWasInterrupted) {
  expect_refused(run("--resume"), "no record of a run on this card was found");
  interrupt();
  const std::string stands = position();
  expect_refused(run("--resume --set axis.x.max_velocity=100"), "the machine file or --set has changed");
  expect_refused(run("--resume --arcs chords"), "--arcs was 'generator', and is 'chords' now");
  expect_refused(run("--resume --single-block"), "--single-block was 'not given', and is 'given' now");
  expect_refused(run("--resume --stream"), "needs the whole program before the run");
  expect_refused(run("--resume --from-line 3"), "not with --from-line");
  command_.write("p.ngc", program() + "(more)\n");
  expect_refused(run("--resume"), "p.ngc differ from those that");
  command_.write("p.ngc", program());
  EXPECT_EQ(position(), stands) << "nothing has moved";
  ASSERT_EQ(command_.run("jog X1 --card " + server_.moving()).status, 0);
  ASSERT_EQ(command_.run("zero X --card " + server_.moving()).status, 0);
  expect_refused(run("--resume"), "machine zero was set anew");
  expect_refused(command_.run("run " + program_ + " --resume"), "needs --card");
}

TEST_F(ResumedRun, HasNothingToGoOnWithBehindItsEnd) {
  command_.write("p.ngc", "G1 X1 F6000\n");
  ASSERT_EQ(run().status, 0);
  expect_refused(run("--resume"), "the last run on this card reached its end");
}

TEST_F(ResumedRun, KeepsItsFileWhereItIsToldAndOverwritesNoOther) {
  command_.write("p.ngc", "G1 X1 F6000\n");
  const std::string other = command_.write("other.json", "{}");
  expect_refused(run("--resume-file " + other), "other.json: is not the file of an interrupted run");
  EXPECT_EQ(contents(other), "{}");
  EXPECT_EQ(run("--resume-file " + command_.path("own.json")).status, 0);
  EXPECT_EQ(read_json(command_.path("own.json"))["state"], "done");
  EXPECT_FALSE(std::filesystem::exists(command_.path("state")));
}

// The coordinates are those of the interrupted run's start, independent of the machine's present place.
TEST_F(ResumedRun, FromALineOnWithTheSamePath) {
  const Outcome whole = run("--override 100");
  ASSERT_EQ(whole.status, 0) << whole.err;
  ASSERT_EQ(command_.run("jog X3 --card " + server_.moving()).status, 0);
  expect_refused(run("--from-line 30"), "Give --yes to allow this move");
  const Outcome made = run("--from-line 30 --yes");
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_THAT(made.err, AllOf(HasSubstr("the run begins at line 30, at X "), Not(HasSubstr("ticks into a path"))));
  EXPECT_THAT(made.out, HasSubstr("X: ends at pulse 0"));
}

}  // namespace
}  // namespace trammel::test
