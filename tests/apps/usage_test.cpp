// Text for people: names, help, notes, progress; programs from pipes; cards of any number of axes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "command.hpp"

namespace trammel::test {
namespace {

TEST(Names, MistypedSubcommandAndTheNearest) {
  const Command command;
  const auto error_of = [&](const std::string& arguments) {
    const Outcome outcome = command.run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    return outcome.err;
  };
  EXPECT_NE(error_of("rnu x.ngc").find("\"rnu\": did you mean run?"), std::string::npos);
  EXPECT_NE(error_of("comapre --line 0,0,1,1").find("did you mean compare?"), std::string::npos);
  EXPECT_NE(error_of("help stesp").find("did you mean steps?"), std::string::npos);
  const std::string far = error_of("simulate");
  EXPECT_NE(far.find("\"simulate\""), std::string::npos) << far;
  EXPECT_EQ(far.find("did you mean"), std::string::npos) << far;
}

TEST(Names, MistypedOptionAndTheNearest) {
  const Command command;
  const std::string program = command.write("a.ngc", "G1 X1 F600\n");
  const auto error_of = [&](const std::string& arguments) {
    const Outcome outcome = command.run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    return outcome.err;
  };
  for (const std::string option : {"--enginee model", "--enginee=model"}) {
    const std::string text = error_of("run " + option + " " + program);
    EXPECT_NE(text.find("trammel run has no option --enginee: did you mean --engine?"), std::string::npos) << text;
  }
  const std::string far = error_of("run --something " + program);
  EXPECT_NE(far.find("no option --something (--help"), std::string::npos) << far;
  EXPECT_NE(error_of("run " + program + " b.ngc").find("b.ngc"), std::string::npos) << "one program too many";
}

TEST(Names, WhatWasProbablyMeant) {
  const Command command;
  const auto error_of = [&](const std::string& arguments) { return command.run(arguments).err; };
  EXPECT_NE(error_of("info --card /dev/ttyUSB7").find("did you mean serial:/dev/ttyUSB7?"), std::string::npos);
  EXPECT_NE(error_of("info --card 127.0.0.1:5").find("did you mean tcp://127.0.0.1:5?"), std::string::npos);
  EXPECT_NE(error_of("line --to 9,x").find("--to: must be whole numbers of pulses, as 2000,-1000, not x"),
            std::string::npos);
  EXPECT_NE(error_of("line --to 9,3 --from 0.5,0").find("--from: must be whole numbers"), std::string::npos);
  EXPECT_NE(error_of("line --to 9,3 --trace x.vcd").find("the waveform is FST, not vcd: name it x.fst"),
            std::string::npos);
  EXPECT_NE(error_of("run a.ngc --report x.html.pdf").find("the page is HTML, not pdf: name it x.html"),
            std::string::npos);
  EXPECT_NE(error_of("line --to 9,3 --speed 9000mm/min").find("without its unit, as 150 or 0.5, not 9000mm/min"),
            std::string::npos);
  const std::string program = command.write("a.ngc", "G1 X1 F600\n");
  const Outcome png = command.run("run --engine model " + program + " --plot " + command.path("x.PNG"));
  EXPECT_EQ(png.status, 2);
  EXPECT_NE(png.err.find("SVG, not png: name it x.svg"), std::string::npos) << png.err;
  EXPECT_EQ(command.run("run --engine model " + program + " --plot " + command.path("x.svg")).status, 0);
}

TEST(Notes, AMonitorWithoutACardShowsAFreshOne) {
  const Command command;
  const Outcome monitor = command.run("monitor --looks 1 --interval 0.01");
  EXPECT_EQ(monitor.status, 0);
  EXPECT_NE(monitor.err.find("fresh simulated card"), std::string::npos) << monitor.err;
}

TEST(Notes, AProgramThatMovesNothing) {
  const Command command;
  const Outcome empty = command.run("run --engine model " + command.write("empty.ngc", ""));
  EXPECT_EQ(empty.status, 0);
  EXPECT_NE(empty.err.find("empty.ngc moves nothing"), std::string::npos) << empty.err;
  const Outcome checked = command.run("run --check " + command.write("spindle.ngc", "M3\n"));
  EXPECT_NE(checked.err.find("spindle.ngc moves nothing"), std::string::npos) << checked.err;
  EXPECT_EQ(command.run("run --engine model " + command.write("a.ngc", "G1 X1 F600\n")).err, "");
}

TEST(Names, HelpOfACommandIsItsHelp) {
  const Command command;
  EXPECT_EQ(command.run("help").out, command.run("--help").out);
  EXPECT_EQ(command.run("help help").out, command.run("--help").out);
  for (const std::string name :
       {"run", "line", "info", "monitor", "dump", "selftest", "drives", "position", "zero", "recover", "serve", "steps",
        "methods", "compare", "reproduce", "calibrate", "world", "panel"}) {
    const Outcome outcome = command.run("help " + name);
    EXPECT_EQ(outcome.status, 0) << name;
    EXPECT_EQ(outcome.out, command.run(name + " --help").out);
    EXPECT_EQ(outcome.out.find("e+"), std::string::npos) << "limits as a person writes them\n" << outcome.out;
  }
}

TEST(Limits, AreWrittenAsAPersonWritesThem) {
  const Command command;
  const Outcome clock = command.run("info --clock 5");
  EXPECT_EQ(clock.status, 2);
  EXPECT_NE(clock.err.find("1000 to 4294967295 Hz"), std::string::npos) << clock.err;
  EXPECT_NE(command.run("info --axes 9").err.find("1 to 8"), std::string::npos);
  EXPECT_NE(command.run("compare --circle 5 --threads 0").err.find("1 to 256"), std::string::npos);
  EXPECT_EQ(command.run("info --clock 1e6").status, 0);
}

// Standard error of the tests is not a terminal.
TEST(Progress, HasNoEscapesInALog) {
  const Command command;
  const std::string run = "run " + command.write("a.ngc", "G1 X20 F600\n");
  for (const std::string& arguments : {run, run + " --progress", std::string("compare --random 3000 --progress")}) {
    const Outcome outcome = command.run(arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find('\033'), std::string::npos) << arguments;
    EXPECT_EQ(outcome.err.find('\r'), std::string::npos) << arguments;
    EXPECT_TRUE(arguments != run || outcome.err.empty()) << outcome.err;
  }
}

TEST(Progress, TerminalGetsABarAndATimeLeft) {
  const Command command;
  const std::string program = command.write("a.ngc", "G1 X30 F600\n");
  // script(1) gives the command a terminal.
  const std::string line = "TERM=xterm script -qec \"'" TRAMMEL_COMMAND "' run " + program +
                           " --clock 2000000\" /dev/null >'" + command.path("log") + "' </dev/null";
  ASSERT_EQ(std::system(line.c_str()), 0);
  const std::string log = contents(command.path("log"));
  EXPECT_NE(log.find("\033[K["), std::string::npos);
  EXPECT_NE(log.find(" s left"), std::string::npos);
  for (std::size_t at = log.find("\033[K["); at != std::string::npos; at = log.find("\033[K[", at + 1)) {
    const std::size_t end = log.find('\r', at);
    EXPECT_LE(end - at, 83U) << "within 80 columns: " << log.substr(at, end - at);
  }
}

TEST(Notes, LongRunOfTheRtlEngine) {
  const Command command;
  const std::string program = command.write("long.ngc", "G1 X10000 F60\n");  // 10^10 clocks at 1 MHz
  Running running(command, "run " + program, "note");
  EXPECT_TRUE(eventually([&] { return count_lines(contents(command.path("note"))) == 1; }));
  const std::string note = contents(command.path("note"));
  EXPECT_NE(note.find(" for 10000 M clocks ("), std::string::npos) << note;
  EXPECT_NE(note.find("--engine model"), std::string::npos) << note;
}

// One line per cause, with the count and the line that reaches the smallest fraction of its feed.
TEST(Notes, FeedsThatAreNotReached) {
  const Command command;
  const Outcome reached = command.run("run --engine model " + command.write("a.ngc", "G1 X10 F600\n"));
  EXPECT_EQ(reached.err, "");
  const Outcome outcome = command.run(
      "run --engine model " + command.write("b.ngc", "F3000\nG1 X0.5\nG1 X0.1\nG1 X50\nG1 X0.2 F90000\nG1 X30 F600\n"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(count_lines(outcome.err), 2U) << outcome.err;
  // Moves of 0.4 mm forth and back at 1000 mm/s^2 reach 20 mm/s.
  EXPECT_NE(outcome.err.find("2 moves do not reach the feed: too short"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("b.ngc:3, 1200 of 3000 mm/min"), std::string::npos) << outcome.err;
  // The default machine's limit is 150 mm/s.
  EXPECT_NE(outcome.err.find("1 move does not reach the feed: beyond the max_velocity"), std::string::npos);
  EXPECT_NE(outcome.err.find("b.ngc:5, 9000 of 90000 mm/min"), std::string::npos) << outcome.err;
}

TEST(Notes, WordsWithoutEffectByTheReason) {
  const Command command;
  const Outcome outcome =
      command.run("run " + command.write("a.ngc", "G64 P0.1 Q0.05\nM3 S100\nG1 X1 F600\nM0\nM1\nM0\nM5 T2\nM84\nM2\n") +
                  " --engine model");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("which a simulation does not make: M0 (2) M1 (1)\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("lines are not joined (naive CAM detector): G64 Q (1)\n"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("[outputs] of the machine file: M3 (1) M5 (1)\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("no output for it in [spindle] of the machine file: S (1)\n"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("no hardware: M84 (1) T (1)\n"), std::string::npos) << outcome.out;
}

TEST(Notes, BlendsAndCornersThatAreKept) {
  const Command command;
  const std::string program = command.write("a.ngc", "G64 P0.1\nG1 F600 X10\nY10\nX5\nX9\nM2\n");
  for (const char* mode : {"", " --check"}) {
    const Outcome outcome = command.run("run " + program + " --engine model --json " + command.path("a.json") + mode);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("blends (G64 P): 2, at most 0.1 mm from the programmed path\n"), std::string::npos)
        << outcome.out;
    EXPECT_NE(outcome.out.find("corners not rounded by G64 P: 1 (reversals)\n"), std::string::npos) << outcome.out;
    EXPECT_NE(contents(command.path("a.json")).find("\"blends\": {\n    \"count\": 2,"), std::string::npos);
  }
  // Each line ends with a stop.
  const Outcome single = command.run("run " + program + " --engine model --single-block");
  EXPECT_EQ(single.out.find("G64 P"), std::string::npos) << single.out;
}

TEST(Words, LinesOfFurtherWordsAreLeftOut) {
  const Command command;
  const std::string program = command.write("a.gcode", "M808 L1\nM555.3 \"MK3S\"\nM909\nG9\nG1 X1 F600\n");
  const Outcome refused = command.run("run " + program + " --check");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("a.gcode:1: unsupported word 'M808'; --accept M808,M555.3,M909,G9 leaves out"),
            std::string::npos)
      << refused.err;
  // The option may also come before the program.
  const Outcome outcome = command.run("run --check --accept M808,m555.3 --accept M909,g9 " + program);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("no hardware: G9 (1) M555.3 (1) M808 (1) M909 (1)\n"), std::string::npos) << outcome.out;
  // The option takes one argument: a second word after a space is not part of it.
  const Outcome spaced = command.run("run --check --accept M808,M555.3,M909 G9 " + program);
  EXPECT_EQ(spaced.status, 2) << spaced.out;
  for (const char* word : {"900", "M", "M1.25", "M99999", "M-1", "Mx", "X1"}) {
    const Outcome bad = command.run("run " + program + " --check --accept " + word);
    EXPECT_EQ(bad.status, 2) << word;
    EXPECT_NE(bad.err.find("is not a G or M word such as M900 or M862.3"), std::string::npos) << bad.err;
  }
  for (const char* word : {"G1", "G20", "G17", "G92", "G91", "M83", "M2", "G68", "M98"}) {
    const Outcome bad = command.run("run " + program + " --check --accept " + word);
    EXPECT_EQ(bad.status, 2) << word;
    EXPECT_NE(bad.err.find(std::string("--accept: ") + word + " cannot be left out: "), std::string::npos) << bad.err;
  }
}

// Names that contain a line break, are not UTF-8, or are longer than any file name.
TEST(Messages, StayOneShortLineWhateverAFileIsCalled) {
  const Command command;
  const std::string folder = command.path("");
  const std::string latin = command.write("caf\xe9\n.ngc", "G0 X1\n");
  const Outcome taken = command.run("run '" + latin + "' --check --json " + command.path("a.json"));
  EXPECT_EQ(taken.status, 0) << taken.err;
  EXPECT_EQ(taken.out.find(folder + "caf\\xe9\\n.ngc: 1 path segment, 4 commands, "), 0U) << taken.out;
  EXPECT_EQ(read_json(command.path("a.json"))["program"], folder + "caf\\xe9\\n.ngc");
  const Outcome refused = command.run("run '" + command.write("q\xe9\n.ngc", "G0 Q\n") + "' --check");
  EXPECT_NE(refused.err.find("q\\xe9\\n.ngc:1: malformed number in 'Q'"), std::string::npos) << refused.err;
  const std::string far(5000, 'a');
  for (const std::string& arguments :
       {"run '" + folder + "no\n\xff'", "run " + far, "steps " + far, "run '" + latin + "' --check --json " + far,
        "run '" + latin + "' --machine " + far, "run '" + latin + "' --steps '" + folder + "no\n\xff/a'"}) {
    const Outcome outcome = command.run(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
    EXPECT_LT(outcome.err.size(), 2100U);
    EXPECT_EQ(outcome.err.find('\xff'), std::string::npos) << outcome.err;
  }
}

TEST(Words, WhatAPrinterWouldDoOtherwiseIsTold) {
  const Command command;
  const std::string program = command.write("a.gcode", "G28\nM104 S200\nG4 P2\nG4 S1\nG1 X1 F600\nG4\n");
  const Outcome outcome = command.run("run " + program + " --check");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("no hardware: G4 (1) M104 (1)\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("nothing was searched: G28 (1)\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("which printers' firmware takes as milliseconds: G4 P (1)\n"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.err.find("warning: " + program + ": G4 P is taken as seconds (1 time)."), std::string::npos)
      << outcome.err;
}

TEST(Parameters, PersistWhereAFileIsNamed) {
  const Command command;
  const std::string first = command.write("a.ngc", "#31=2.5\nG0 X4\nG10 L20 P1 X0\nG30.1\nT3 M6\nM2\n");
  const std::string second = command.write("b.ngc", "G0 X#31 Y#5400\nM2\n");
  const std::string file = command.path("machine.var");
  const std::string with = " --engine model --parameters " + file;
  EXPECT_EQ(command.run("run " + first + " --check --parameters " + file).status, 0);
  EXPECT_FALSE(std::filesystem::exists(file)) << "a check leaves nothing";
  const Outcome outcome = command.run("run " + first + with);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(contents(file), "31\t2.5\n5181\t4\n5220\t1\n5221\t4\n5400\t3\n");
  const Outcome next = command.run("run " + second + with);
  ASSERT_EQ(next.status, 0) << next.err;
  EXPECT_NE(next.out.find("X: 520 pulses made"), std::string::npos) << "6.5 mm: " << next.out;
  EXPECT_NE(next.out.find("Y: 240 pulses made"), std::string::npos) << next.out;
  EXPECT_EQ(command.run("run " + second + " --engine model").status, 0);

  const std::string kept = contents(file);
  EXPECT_NE(command.run("run " + command.write("c.ngc", "#31=9\nG1 X1\n") + with).status, 0);
  EXPECT_EQ(contents(file), kept) << "after a program that was refused";
  for (const char* line : {"31", "0 1", "5603 1", "31 x", "31 1 2", "31 1e13", "x 1"}) {
    command.write("machine.var", std::string("1 2\n\n") + line + "\n");
    const Outcome bad = command.run("run " + second + with);
    EXPECT_EQ(bad.status, 2) << line;
    EXPECT_NE(bad.err.find("machine.var:3: must be the number of a parameter (1 to 5602) and its value"),
              std::string::npos)
        << bad.err;
  }
  EXPECT_EQ(command.run("run " + second + " --engine model --parameters -").status, 2);
}

TEST(Program, FromStandardInputAndPipes) {
  const Command command;
  const std::string program = command.write("a.ngc", "G1 X1 F600\nG1 X0\n");
  ASSERT_EQ(command.run("run " + program + " --steps " + command.path("expected")).status, 0);
  const std::string expected = contents(command.path("expected"));
  for (const std::string& source : {"- <" + program, "- < <(cat " + program + ")", "<(cat " + program + ")"}) {
    const Outcome outcome = command.run("run --steps - " + source);
    EXPECT_EQ(outcome.status, 0) << source << '\n' << outcome.err;
    EXPECT_EQ(outcome.out, expected) << source;
  }
  const Outcome bad = command.run("run - < <(printf 'G1 X1 F600\\nQ5\\n')");
  EXPECT_EQ(bad.status, 2);
  EXPECT_NE(bad.err.find("standard input:2:"), std::string::npos) << bad.err;
}

// On a card with fewer axes the host reads less before the start, so all pulses come earlier by the same number of
// clocks.
TEST(Axes, CardHasAsManyAsTheMachine) {
  const Command command;
  std::string machine = contents(TRAMMEL_EXAMPLES_DIR "/machine.toml");
  machine.resize(machine.find("[axis.e]"));
  const std::string run = "run " + command.write("a.ngc", "G1 X2 Y-3 Z0.5 F2400\nG3 X0 I-1\nG0 X0 Y0 Z0\n") +
                          " --steps " + command.path("steps") + " --path-steps ";
  const std::string three = " --machine " + command.write("machine.toml", machine);
  ASSERT_EQ(command.run(run + command.path("path4")).status, 0);
  const std::vector<Step> four = read_steps(command.path("steps"));
  ASSERT_EQ(command.run(run + command.path("path3") + three).status, 0);
  std::vector<Step> steps = read_steps(command.path("steps"));
  EXPECT_EQ(contents(command.path("path3")), contents(command.path("path4")));
  ASSERT_EQ(steps.size(), four.size());
  ASSERT_GT(steps.size(), 500U);
  const std::uint64_t earlier = four[0].cycle - steps[0].cycle;
  EXPECT_LT(earlier, 200U);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    ASSERT_EQ(steps[i].cycle + earlier, four[i].cycle) << i;
    ASSERT_EQ(steps[i].axis, four[i].axis) << i;
    ASSERT_EQ(steps[i].direction, four[i].direction) << i;
  }
  // The trace shows a card with four axes, and the command says so.
  const Outcome traced = command.run(run + command.path("path3") + three + " --trace " + command.path("x.fst"));
  EXPECT_EQ(traced.status, 0);
  EXPECT_NE(traced.err.find("shows a card with 4 axes"), std::string::npos) << traced.err;
}

TEST(Axes, EveryNumberIsBuiltAndTracesSayWhatServes) {
  const Command command;
  for (const std::string axes : {"1", "2", "3", "4", "5", "6", "7", "8"}) {
    const Outcome outcome = command.run("info --axes " + axes);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("axes           " + axes + "\n"), std::string::npos) << outcome.out;
  }
  const Outcome refused = command.run("info --axes 3 --trace " + command.path("x.fst"));
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("4 or 8 axes"), std::string::npos) << refused.err;
}

// Start and end time of an FST file, in half clocks: 64 bits each, after the kind and the length of its first block.
std::pair<std::uint64_t, std::uint64_t> times_of(const std::string& file) {
  const std::string text = contents(file);
  const auto number = [&](std::size_t at) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 8; ++i) value = value << 8U | static_cast<unsigned char>(text.at(at + i));
    return value;
  };
  return {number(9), number(17)};
}

TEST(Trace, WindowOfTime) {
  const Command command;
  const std::string run = "run " + command.write("a.ngc", "G1 X1 F600\n") + " --trace " + command.path("x.fst");
  using Times = std::pair<std::uint64_t, std::uint64_t>;
  ASSERT_EQ(command.run(run + " --trace-window 0.01:0.02").status, 0);
  EXPECT_EQ(times_of(command.path("x.fst")), Times(20'000, 39'999));
  ASSERT_EQ(command.run(run + " --trace-window :0.005").status, 0);
  EXPECT_EQ(times_of(command.path("x.fst")), Times(0, 9'999));
  ASSERT_EQ(command.run(run + " --trace-window 0.02:").status, 0);
  EXPECT_EQ(times_of(command.path("x.fst")).first, 40'000U);
  for (const std::string window : {"1", "2:1", "a:b", "-1:2", "0:1x"}) {
    const Outcome outcome = command.run(run + " --trace-window=" + window);
    EXPECT_EQ(outcome.status, 2) << window;
    EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  }
  EXPECT_EQ(command.run("info --trace-window 0:1").status, 2) << "no trace";
}

// The demo would build something. The name of a missing program is resolved and reported before that.
TEST(Scripts, NamesAreMeantFromTheCallersFolderAndLogsArePlain) {
  const Command command;
  const std::string scripts = TRAMMEL_EXAMPLES_DIR "/../scripts/";
  const std::string log = command.path("log");
  const std::string demo = "cd '" + command.path("") + "' && bash '" + scripts + "demo' none.ngc 2>'" + log + "'";
  EXPECT_NE(std::system(demo.c_str()), 0);
  EXPECT_EQ(contents(log),
            "error: " + std::filesystem::canonical(command.path("")).string() + "/none.ngc: cannot be read\n");
  const std::string say = "bash -c 'source \"" + scripts + "common.sh\"; say hello' 2>'" + log + "'";
  EXPECT_EQ(std::system(say.c_str()), 0);
  EXPECT_EQ(contents(log), "== hello\n");
}

// The user's own machine file is the default, and the summary says so.
TEST(MachineFile, OfTheUserIsTheDefault) {
  const Command command;
  const std::string program = command.write("x.ngc", "G21 G90 G0 X1\n");
  const std::string check = "run --check " + program;
  EXPECT_NE(command.run(check).out.find("  machine: built-in\n"), std::string::npos);
  ASSERT_TRUE(std::filesystem::create_directories(command.path("configuration/trammel")));
  const std::string own =
      command.write("configuration/trammel/machine.toml", contents(TRAMMEL_EXAMPLES_DIR "/machine.toml") + "\n");
  const Outcome taken = command.run(check + " --set axis.x.steps_per_mm=20");
  EXPECT_NE(taken.out.find("  machine: " + own + ", entries by --set: 1\n"), std::string::npos) << taken.out;
  EXPECT_NE(taken.out.find("X: ends at pulse 20 "), std::string::npos) << taken.out;
  EXPECT_NE(command.run(check + " --machine built-in").out.find("  machine: built-in\n"), std::string::npos);
  command.write("configuration/trammel/machine.toml", "nothing = 1\n");
  const Outcome refused = command.run(check);
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find(own), std::string::npos) << refused.err;
  EXPECT_EQ(command.run(check + " --machine built-in").status, 0);
}

// Colour is for terminals only, and NO_COLOR is obeyed.
TEST(Colour, IsForTerminalsThatWantIt) {
  const Command command;
  const auto on_terminal = [&](const std::string& environment) {
    const std::string out = command.path("terminal.txt");
    const std::string line =
        environment + " script -qec \"'" TRAMMEL_COMMAND "' run none.ngc\" /dev/null >" + out + " </dev/null";
    (void)std::system(line.c_str());
    return contents(out);
  };
  EXPECT_NE(on_terminal("TERM=xterm").find("\033[1;31merror\033[0m"), std::string::npos);
  EXPECT_NE(on_terminal("TERM=xterm NO_COLOR=").find("\033["), std::string::npos) << "an empty one counts as none";
  EXPECT_EQ(on_terminal("TERM=xterm NO_COLOR=1").find("\033["), std::string::npos);
  EXPECT_EQ(on_terminal("TERM=dumb").find("\033["), std::string::npos);
  EXPECT_EQ(command.run("run none.ngc").err.find("\033["), std::string::npos);
}

}  // namespace
}  // namespace trammel::test
