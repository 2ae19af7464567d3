// `trammel run` on a link that is cut in mid program, closed or silent: the run ends and tells why, the card stops on
// the path, and --resume completes the undisturbed path. A jog and a line end as soon.
#include <gmock/gmock.h>

#include <chrono>
#include <cstdlib>
#include <random>

#include "cable.hpp"
#include "resumed_run.hpp"

namespace trammel::test {
namespace {

using ::testing::HasSubstr;
using State = Cable::State;

class CutLink : public ResumedRun {
 protected:
  CutLink() {
    watchdog_ = "1";
    // The resume file is named after the card's URL, which is that of the cable.
    card_ = "'" + cable_.url() + "?token=secret'";
  }

  // Starts a run and cuts its link after a while. Returns the run's standard error.
  std::string cut(State way, int milliseconds, const std::string& options, bool resumed) {
    Running client = start(options);
    return cut(client, way, milliseconds, resumed);
  }
  std::string cut(Running& client, State way, int milliseconds, bool resumed) {
    let_move(milliseconds, resumed);
    cable_.set(way);
    const std::optional<int> status = client.wait();
    const std::string said = contents(command_.path(said_in()));
    EXPECT_TRUE(status && WIFEXITED(*status) && WEXITSTATUS(*status) == 1) << said;
    EXPECT_TRUE(eventually([&] { return !shows("on a path"); })) << "the card stops without a host";
    cable_.set(State::kWhole);
    await_gone();
    return said;
  }

  // Cuts the link 5 times; with TRAMMEL_LONG, 100 times.
  void expect_undisturbed_path(State way, unsigned seed) {
    const int cuts = std::getenv("TRAMMEL_LONG") != nullptr ? 100 : 5;
    if (cuts > 5) write_long_program();
    const std::string wanted = undisturbed();
    std::mt19937 random(seed);
    for (int i = 0; i < cuts; ++i) {
      // An override of 10 percent changes no step, and makes the run long enough for all cuts.
      cut(way, static_cast<int>(random() % 400), std::string("--override 10") + (i == 0 ? "" : " --resume"), i != 0);
      ASSERT_FALSE(HasFailure()) << i;
    }
    const Outcome last = run("--resume");
    EXPECT_EQ(last.status, 0) << last.err;
    EXPECT_THAT(last.out, HasSubstr("X: ends at pulse 0"));
    EXPECT_EQ(path_of(server_.end()), wanted) << server_.errors();
  }

  Cable cable_{server_.url()};
};

TEST_F(CutLink, ThatClosesAgainAndAgainMakesTheUndisturbedPath) { expect_undisturbed_path(State::kClosed, 1); }
TEST_F(CutLink, ThatFallsSilentAgainAndAgainMakesTheUndisturbedPath) { expect_undisturbed_path(State::kSilent, 2); }

// The sum of the watchdog's second, one second beyond it, three for a new connection, and some for the last requests of
// a run.
TEST_F(CutLink, ThatFallsSilentEndsTheRunBehindTheWatchdogAndSaysWhatToDo) {
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  const std::string said = cut(State::kSilent, 100, "--override 10", false);
  EXPECT_LT(Clock::now() - begun, std::chrono::seconds(20)) << said;
  EXPECT_THAT(said, HasSubstr("p.ngc:"));
  EXPECT_THAT(said, HasSubstr("no answer for "));
  EXPECT_THAT(said, HasSubstr("the link to the card is lost; the card stops on the path, by its watchdog "
                              "of 1 s at the latest"));
  EXPECT_THAT(said, HasSubstr("`trammel recover` says where it stands"));
  EXPECT_THAT(said, HasSubstr("`timeout=MS` in the URL"));
  EXPECT_THAT(said, HasSubstr("with the same arguments and --resume continues"));
  EXPECT_THAT(command_.run("recover --card " + server_.url()).out, HasSubstr("WATCHDOG"));
}

// Motions of 20 s. Without the watchdog's limit they would wait 100 s for an answer.
TEST_F(CutLink, ThatFallsSilentEndsAJogAndALine) {
  using Clock = std::chrono::steady_clock;
  for (const char* motion : {"jog X100 --speed 5", "line --to 20000,0 --speed 1000"}) {
    SCOPED_TRACE(motion);
    const auto begun = Clock::now();
    ++started_;
    Running client(command_, motion + (" --clear-faults --set motion.watchdog=1 --card " + card_), said_in());
    const std::string said = cut(client, State::kSilent, 100, false);
    EXPECT_LT(Clock::now() - begun, std::chrono::seconds(20)) << said;
    EXPECT_THAT(said, HasSubstr("no answer for "));
    EXPECT_THAT(said, HasSubstr("the link to the card is lost; the card stops on the path"));
    EXPECT_THAT(command_.run("recover --card " + server_.url()).out, HasSubstr("WATCHDOG"));
  }
}

}  // namespace
}  // namespace trammel::test
