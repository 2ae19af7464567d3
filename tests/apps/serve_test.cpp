// External cards on the command line: a served card, and URLs behind which there is no card.
#include <gtest/gtest.h>

#include <csignal>

#include "bad_cable.hpp"
#include "command.hpp"
#include "server.hpp"

namespace trammel::test {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// The command prints one line and has status 2.
void expect_refused(const Command& command, const std::string& arguments, const std::string& message) {
  const Outcome outcome = command.run(arguments);
  EXPECT_EQ(outcome.status, 2) << arguments << '\n' << outcome.err;
  EXPECT_EQ(count_lines(outcome.err), 1U) << arguments << '\n' << outcome.err;
  EXPECT_TRUE(has(outcome.err, message)) << arguments << '\n' << outcome.err;
  EXPECT_EQ(outcome.out, "") << arguments;
}

TEST(Serve, EveryCommandOnACardBehindAPort) {
  const Command command;
  Server server(command, "--engine model --fast --axes 3");
  EXPECT_TRUE(has(server.url(), "tcp://127.0.0.1:")) << server.url();
  EXPECT_TRUE(has(command.run("info --card " + server.url()).out, "axes           3\n"));
  const std::string json = command.path("out.json");
  ASSERT_EQ(command.run("line --to 200,-100 --speed 20000 --card " + server.moving() + " --json " + json).status, 0);
  EXPECT_EQ(read_json(json)["moved"], (std::vector<int>{200, -100}));
  std::string machine = contents(TRAMMEL_EXAMPLES_DIR "/machine.toml");
  machine.resize(machine.find("[axis.e]"));
  const std::string program = command.write("ok.ngc", "G1 X1 Y-2 F6000\nG2 X3 Y-2 I1\n");
  const Outcome run = command.run("run " + program + " --machine " + command.write("machine.toml", machine) +
                                  " --card " + server.moving() + " --json " + json);
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(read_json(json)["final_position"], (std::vector<int>{240, -160, 0}))
      << "from where the card stood at its reset";
  const Outcome dump = command.run("dump --card " + server.url());
  EXPECT_TRUE(has(dump.out, "0x000  MAGIC                0x54524D4C")) << dump.out;
  EXPECT_TRUE(has(dump.out, "0x220  SNAP_POSITION[0]     0x000000F0  240")) << dump.out;
  EXPECT_TRUE(has(dump.out, "SNAP_POSITION[2]"));
  EXPECT_FALSE(has(dump.out, "SNAP_POSITION[3]")) << "of an axis that it lacks";
  const Outcome monitor = command.run("monitor --looks 2 --interval 0.01 --card " + server.url());
  EXPECT_EQ(monitor.status, 0) << monitor.err;
  EXPECT_TRUE(has(monitor.out, "axis 1   pulse -160")) << monitor.out;
  const Outcome selftest = command.run("selftest --card " + server.moving());
  EXPECT_EQ(selftest.status, 0) << selftest.out << selftest.err;
  EXPECT_TRUE(has(selftest.out, "pass  nothing has moved")) << selftest.out;
  EXPECT_TRUE(has(server.end(), "served 6 clients, 0 refused")) << server.errors();
}

TEST(Serve, WithoutTheTokenNothingMoves) {
  const Command command;
  Server server(command, "--engine model --fast");
  const std::string program = command.write("ok.ngc", "G1 X1 F6000\n");
  const std::string wrong = " --card '" + server.url() + "?token=other'";
  expect_refused(command, "run " + program + " --card " + server.url(), "give the token");
  expect_refused(command, "line --to 10,10 --card " + server.url(), "give the token");
  expect_refused(command, "selftest --card " + server.url(), "give the token");
  expect_refused(command, "run " + program + wrong, "wrong token");
  EXPECT_EQ(command.run("info" + wrong).status, 0) << "reading needs no token, and does without one";
  EXPECT_EQ(command.run_in(".", "TRAMMEL_TOKEN=secret", "dump --card " + server.url()).status, 0);
  EXPECT_EQ(command.run_in(".", "TRAMMEL_TOKEN=secret", "line --to 10,10 --card " + server.url()).status, 0);
  EXPECT_TRUE(eventually([&] { return server.said("the card holds"); })) << "it sees that the last client has left";
  const std::string said = server.end();
  EXPECT_TRUE(has(said, "path: 20 steps")) << "those of the last line";
  EXPECT_EQ(count_of(said, "the card holds"), 1U) << "dump does without the token";
}

TEST(Serve, OnAPseudoTerminal) {
  const Command command;
  Server server(command, "--engine model --fast --pty");
  EXPECT_TRUE(has(server.url(), "serial:/dev/pts/")) << server.url();
  EXPECT_EQ(command.run("info --card " + server.url()).status, 0);
  expect_refused(command, "line --to 10,10 --card " + server.url(), "give the token");
  EXPECT_EQ(command.run("line --to 10,10 --card " + server.moving()).status, 0);
  EXPECT_TRUE(has(server.end(), "path: 20 steps"));
}

// The number that follows `words` in a text; -1 if the words are missing.
int number_behind(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  return at == std::string::npos ? -1 : std::stoi(text.substr(at + words.size()));
}

// Waits until axis 0 has made `steps` steps. The client may start slowly.
bool comes_to(const Command& command, const Server& server, int steps) {
  return eventually([&] {
    const Outcome look = command.run("monitor --looks 1 --card " + server.url());
    return number_behind(look.out, "axis 0   pulse ") >= steps;
  });
}

// A client process is killed while the card moves. The card holds. The next client continues there if it comes before
// the watchdog expires.
TEST(Serve, AClientIsKilled) {
  const Command command;
  Server server(command, "--engine model");
  const std::string program = command.write("long.ngc", "G1 X100 F600\n");
  Running client(command, "run " + program + " --set motion.watchdog=40 --card " + server.moving(), "client.err");
  ASSERT_TRUE(comes_to(command, server, 40)) << server.errors();
  client.signal(SIGKILL);
  ASSERT_TRUE(client.wait());
  ASSERT_TRUE(eventually([&] { return server.said("the card holds"); })) << server.errors();
  ASSERT_TRUE(eventually([&] { return has(command.run("monitor --looks 1 --card " + server.url()).out, "held"); }));
  const Outcome next = command.run("line --to 10,10 --card " + server.moving());
  EXPECT_EQ(next.status, 0) << next.err;
  EXPECT_TRUE(has(next.err, "the rest of that motion is dropped")) << next.err;
}

// Ends a client by a signal while it moves the card. Returns the number that follows `words` in its message. If the
// signal came before the motion, the next client gets more time.
int stop_by(const Command& command, Server& server, const std::string& arguments, int number,
            const std::string& words) {
  for (const int milliseconds : {300, 1000, 5000}) {
    const std::size_t clients = count_of(server.errors(), "has come");
    Running client(command, arguments + " --card " + server.moving(), "client.err");
    EXPECT_TRUE(eventually([&] { return count_of(server.errors(), "has come") > clients; })) << server.errors();
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    client.signal(number);
    const std::optional<int> status = client.wait();
    const std::string said = contents(command.path("client.err"));
    EXPECT_TRUE(status && WIFSIGNALED(*status) && WTERMSIG(*status) == number) << said;
    const int told = number_behind(said, words);
    if (told <= 0 && status) continue;
    EXPECT_LE(count_lines(said), 3U) << "where machine zero was set, the stop, and how a run goes on: " << said;
    return told;
  }
  ADD_FAILURE() << "it has not stopped in order: " << contents(command.path("client.err"));
  return 0;
}

// Ctrl-C stops the card on the path, the command reports its place, and the next program begins there.
TEST(Serve, CtrlCStopsInOrder) {
  const Command command;
  Server server(command, "--engine model");
  const std::string json = " --json " + command.path("out.json");
  int steps = stop_by(command, server, "run " + command.write("long.ngc", "G1 X10 F600\nX100\n") + json, SIGINT,
                      "stopped by SIGINT: line 1, X at pulse ");
  steps += stop_by(command, server, "line --to 20000 --speed 1000" + json, SIGTERM, "stopped by SIGTERM: moved by ");
  const Outcome next = command.run("line --to 10,10 --card " + server.moving());
  EXPECT_EQ(next.status, 0) << next.err;
  EXPECT_EQ(next.err, "") << "nothing was left to drop";
  EXPECT_EQ(number_behind(server.end(), "path: "), steps + 20) << server.errors();
  EXPECT_FALSE(std::filesystem::exists(command.path("out.json")));
}

// A second Ctrl-C does not wait for the end of a long ramp.
TEST(Serve, ASecondCtrlCLeavesAtOnce) {
  const Command command;
  Server server(command, "--engine model");
  const std::string program = command.write("long.ngc", "G1 X100 F600\n");
  Running client(command, "run " + program + " --set axis.x.max_acceleration=1 --card " + server.moving(),
                 "client.err");
  ASSERT_TRUE(comes_to(command, server, 40)) << server.errors();
  client.signal(SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  client.signal(SIGINT);
  const std::optional<int> status = client.wait();
  EXPECT_TRUE(status && WIFSIGNALED(*status) && WTERMSIG(*status) == SIGINT);
  EXPECT_EQ(count_lines(contents(command.path("client.err"))), 1U) << "where machine zero was set";
  EXPECT_TRUE(eventually([&] { return server.said("the card holds"); })) << server.errors();
}

// A program begins at the end of the program before it, whichever client sent that one.
TEST(Serve, TheNextRunBeginsWhereTheMachineStands) {
  const Command command;
  Server server(command, "--engine model --fast");
  const std::string steps = command.write("steps.ngc", "G91 G1 X10 F6000\n");
  const std::string there = command.write("there.ngc", "G1 X10 F6000\nX12 Y3\nX0 Y0\n");
  const std::string at = " --set axis.x.max=15 --card " + server.moving();
  ASSERT_EQ(command.run("zero XYZE --homed --card " + server.moving()).status, 0);
  const Outcome first = command.run("run " + steps + at);
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_FALSE(has(first.err, "the machine stands at"));
  EXPECT_TRUE(has(first.out, "X: ends at pulse 800 (10.0000 mm)")) << first.out;
  const Outcome second = command.run("run " + steps + at);
  EXPECT_NE(second.status, 0);
  EXPECT_TRUE(has(second.err, "steps.ngc:1: X20 is beyond the axis's max of 15")) << second.err;
  EXPECT_TRUE(has(second.err, "the machine stands at X 10.0000 Y 0.0000 Z 0.0000 E 0.0000")) << second.err;
  const Outcome displaced = command.run("run " + there + " --from-line 3" + at);
  EXPECT_NE(displaced.status, 0);
  EXPECT_TRUE(has(displaced.err,
                  "the machine stands at X 10.0000 Y 0.0000 Z 0.0000 E 0.0000 mm, but the run begins at"
                  " X 12.0000 Y 3.0000"))
      << displaced.err;
  EXPECT_TRUE(has(displaced.err, "Give --yes to allow this move")) << displaced.err;
  const Outcome in_place = command.run("run " + there + " --from-line 2" + at);
  EXPECT_EQ(in_place.status, 0) << in_place.err;
  EXPECT_TRUE(has(in_place.out, "X: ends at pulse 0 (0.0000 mm)")) << in_place.out;
  EXPECT_EQ(number_behind(server.end(), "path: "), 800 + 160 + 240 + 960 + 240) << server.errors();
}

// The run continues, and its path equals that over an undisturbed cable.
TEST(Serve, ACableThatIsCutThreeTimes) {
  const Command command;
  std::string text = "F3000\n";
  for (int i = 1; i <= 400; ++i) text += "G1 X" + std::to_string(0.1 * i) + " Y" + std::to_string(i % 7 * 0.05) + "\n";
  const std::string run = "run " + command.write("p.ngc", text);
  ASSERT_EQ(command.run(run + " --engine model --clock 1000000 --json " + command.path("here.json")).status, 0);
  Server server(command, "--engine model --fast");
  const BadCable cable(server.url(), 9'000, 3);
  const Outcome outcome =
      command.run(run + " --card '" + cable.url() + "?token=secret' --json " + command.path("there.json"));
  ASSERT_EQ(outcome.status, 0) << outcome.err << server.errors();
  EXPECT_EQ(cable.cuts(), 3U);
  EXPECT_TRUE(has(outcome.err, "the motion continues")) << outcome.err;
  const nlohmann::json here = read_json(command.path("here.json"));
  const nlohmann::json there = read_json(command.path("there.json"));
  EXPECT_EQ(there["final_position"], here["final_position"]);
  EXPECT_EQ(there["link"]["reconnections"], 3);
  const std::string identity = here["path_steps"]["identity"].get<std::string>();
  EXPECT_TRUE(has(server.end(), "identity " + identity)) << server.errors();
}

TEST(Serve, SaysThatItCannotKeepRealTime) {
  const Command command;
  Server server(command, "--engine rtl --clock 100000000");
  EXPECT_TRUE(eventually([&] { return server.said("not in real time: the card made"); }));
}

TEST(Serve, ASecondClientAndASecondServer) {
  const Command command;
  Server server(command, "--engine model");
  const std::string program = command.write("long.ngc", "G4 P20\n");
  const Running client(command, "run " + program + " --card " + server.moving(), "client.err");
  ASSERT_TRUE(eventually([&] { return server.said("has come"); }));
  expect_refused(command, "line --to 1,1 --card " + server.moving(), "another client moves the card");
  const Outcome monitor = command.run("monitor --looks 2 --interval 0.01 --card " + server.url());
  EXPECT_EQ(monitor.status, 0) << monitor.err;
  EXPECT_TRUE(has(monitor.out, "axis 0   pulse 0")) << monitor.out;
  const std::string port = server.url().substr(server.url().rfind(':') + 1);
  expect_refused(command, "serve --port " + port, "is in use");
}

TEST(CardOutside, BadInput) {
  const Command command;
  const std::string run = "run " + command.write("ok.ngc", "G1 X1 F600\n") + " --card ";
  for (const std::string& verb : {std::string("info --card "), std::string("line --to 1,1 --card "), run}) {
    expect_refused(command, verb + "usb:1", "must be sim:, tcp://");
    expect_refused(command, verb + "tcp://127.0.0.1:1", "is `trammel serve` running there?");
    expect_refused(command, verb + "tcp://no-such-host.invalid:5", "no such host");
    expect_refused(command, verb + "serial:/dev/no-such-device", "no such device");
    expect_refused(command, verb + "serial:/dev/null", "serial line");
    expect_refused(command, verb + "spi:/dev/no-such-device", "cannot open it");
    expect_refused(command, verb + "mmap:/dev/no-such-device", "cannot open it");
    expect_refused(command, verb + "mmap:" + command.write("zeros", std::string(4096, '\0')), "MAGIC reads 0x00000000");
  }
  const std::string there = "tcp://127.0.0.1:1";
  for (const std::string option :
       {"--steps x", "--path-steps x", "--outputs x", "--plot x", "--trace x.fst", "--engine model", "--clock 1000000",
        "--limit-bus 100", "--hold-at 1:1", "--override-at 1:50", "--input-at 1:0:1"}) {
    expect_refused(command, run + there + " " + option, option.substr(0, option.find(' ')));
  }
  expect_refused(command, run + there + " --check", "--check");
  expect_refused(command, "line --to 1,1 --plot x --card " + there, "--plot");
  expect_refused(command, "info --trace x.fst --card " + there, "--trace");
  expect_refused(command, "line --to 1,1 --clear-faults", "--clear-faults: needs --card");
  expect_refused(command, "serve --token 'a b'", "--token");
  expect_refused(command, "serve --port 70000", "--port");
  expect_refused(command, "serve --listen no-such-host.invalid", "no such address");
  expect_refused(command, "serve --listen ''", "no such address");
  expect_refused(command, "serve --listen 127.0.0.1:4000", "Give the port with --port");
  expect_refused(command, "serve --pty --port 5", "--pty");
  expect_refused(command, "monitor --interval 0", "--interval");
}

TEST(CardOutside, AnAddressThatOthersReachIsWarnedOf) {
  const auto warned = [](const std::string& options) {
    const Command command;
    Server server(command, "--engine model " + options);
    return server.said("the token is transmitted unencrypted");
  };
  EXPECT_TRUE(warned("--listen 0.0.0.0"));
  EXPECT_FALSE(warned(""));
  EXPECT_FALSE(warned("--pty"));
}

TEST(CardOutside, ACardOfAnotherMapVersionAndOneThatEndsEarly) {
  const Command command;
  std::string window(4096, '\0');
  const auto put = [&](std::size_t address, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) window[address + i] = static_cast<char>(value >> 8 * i);
  };
  put(0x000, 0x54524D4C);
  put(0x004, 0x00040000);
  expect_refused(command, "info --card mmap:" + command.write("newer", window), "MAP_VERSION: 4.0");
  EXPECT_EQ(contents(command.path("newer")), window) << "nothing was written";
}

}  // namespace
}  // namespace trammel::test
