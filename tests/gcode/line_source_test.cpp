// Lines of programs, for any chunks in which the bytes arrive.
#include "trammel/gcode/line_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <rapidcheck/gtest.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "trammel/gcode/reader.hpp"

namespace trammel::gcode {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> all(LineSource& source) {
  std::vector<std::string> lines;
  for (std::string_view line; source.next(line);) {
    lines.emplace_back(line);
  }
  std::string_view line;
  EXPECT_FALSE(source.next(line)) << "a line behind the end";
  return lines;
}

std::vector<std::string> lines_of(const std::string& text, std::size_t chunk = 65536) {
  TextLines source(text, "text", chunk);
  return all(source);
}

// Reference implementation, byte by byte.
std::vector<std::string> plainly_split(const std::string& text) {
  std::vector<std::string> lines;
  std::string line;
  bool open = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    open = text[i] != '\n' && text[i] != '\r';
    if (open) {
      line += text[i];
      continue;
    }
    lines.push_back(line);
    line.clear();
    if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') {
      ++i;
    }
  }
  if (open) {
    lines.push_back(line);
  }
  return lines;
}

TEST(LineSource, EveryEndOfALine) {
  EXPECT_THAT(lines_of("a\nb\r\nc\rd"), ElementsAre("a", "b", "c", "d"));
  EXPECT_THAT(lines_of("a\n\nb\r\r\n\n\r"), ElementsAre("a", "", "b", "", "", ""));
  EXPECT_THAT(lines_of(""), ElementsAre());
  EXPECT_THAT(lines_of("\n"), ElementsAre(""));
  EXPECT_THAT(lines_of("\r\n"), ElementsAre(""));
  EXPECT_THAT(lines_of("a"), ElementsAre("a"));
  EXPECT_THAT(lines_of(std::string("a\0b\n", 4)), ElementsAre(std::string("a\0b", 3)));
}

RC_GTEST_PROP(LineSource, ChunksMakeNoDifference, ()) {
  const auto text = *rc::gen::container<std::string>(rc::gen::element('a', 'b', '\n', '\r'));
  const auto chunk = *rc::gen::inRange<std::size_t>(1, 9);
  RC_ASSERT(lines_of(text, chunk) == plainly_split(text));
}

TEST(LineSource, LongLinesStayWithinTheBuffer) {
  const std::string longest(kLongestLine, 'x');
  for (const std::size_t chunk : {std::size_t{1000}, std::size_t{65536}}) {
    EXPECT_THAT(lines_of("a\n" + longest + "\nb", chunk), ElementsAre("a", longest, "b"));
    EXPECT_THAT(lines_of(longest, chunk), ElementsAre(longest));
    const std::string program = "(a)\n;" + longest + longest + "\n(b)";
    TextLines source(program, "p.ngc", chunk);
    machine::Machine machine;
    Reader reader(source, machine);
    Motion motion;
    EXPECT_FALSE(reader.next(motion));
    ASSERT_TRUE(reader.error());
    EXPECT_EQ(reader.error()->code, ErrorCode::kLineTooLong);
    EXPECT_EQ(describe(*reader.error()), "p.ngc:2: a line of more than 65535 bytes");
  }
}

TEST(LineSource, FilesGiveTheirLines) {
  const std::string path = testing::TempDir() + "line_source.ngc";
  std::string text;
  for (int i = 0; i < 50000; ++i) {
    text += "N" + std::to_string(i) + (i % 3 == 0 ? "\r" : i % 3 == 1 ? "\n" : "\r\n");
  }
  std::ofstream(path, std::ios::binary) << text;
  FileLines file(path);
  EXPECT_EQ(file.name(), path);
  EXPECT_EQ(all(file), plainly_split(text));
  EXPECT_FALSE(file.failure());
}

TEST(LineSource, ReadsAnOpenFileFromWhereItStands) {
  std::FILE* file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  std::fputs("first\nsecond\n", file);
  for (int pass = 0; pass < 2; ++pass) {
    std::rewind(file);
    FileLines source(fileno(file), "-");
    EXPECT_EQ(source.name(), "-");
    EXPECT_THAT(all(source), ElementsAre("first", "second"));
  }
  std::fclose(file);
}

class Pipe {
 public:
  Pipe() { EXPECT_EQ(pipe(ends_), 0); }
  ~Pipe() {
    close(ends_[0]);
    end();
  }
  int reader() const { return ends_[0]; }
  void write(const std::string& text) const {
    EXPECT_EQ(::write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void end() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }

 private:
  int ends_[2]{-1, -1};
};

TEST(LineSource, CallsBeforeEachReadAndWhileItWaits) {
  Pipe pipe;
  FileLines source(pipe.reader(), "pipe");
  int calls = 0;
  source.set_meanwhile([&] {
    ++calls;
    if (calls == 3) pipe.write("G0 X1\nG0");
    if (calls == 5) pipe.write(" X2\n");
    if (calls == 7) pipe.end();
  });
  EXPECT_THAT(all(source), ElementsAre("G0 X1", "G0 X2"));
  EXPECT_EQ(calls, 7);
  EXPECT_FALSE(source.failure());
}

TEST(LineSource, WhatIsThrownMeanwhileComesThrough) {
  Pipe pipe;
  FileLines source(pipe.reader(), "pipe");
  source.set_meanwhile([] { throw std::runtime_error("stopped"); });
  std::string_view line;
  EXPECT_THROW(source.next(line), std::runtime_error);
}

// A signal arrives every 2 ms. The pipe stays silent until ten signals have arrived.
TEST(LineSource, SignalsDoNotEndAWait) {
  static std::atomic<int> signals;
  struct sigaction counting {};
  struct sigaction before {};
  counting.sa_handler = [](int) { ++signals; };
  ASSERT_EQ(sigaction(SIGALRM, &counting, &before), 0);
  for (const bool meanwhile : {false, true}) {
    signals = 0;
    Pipe pipe;
    FileLines source(pipe.reader(), "pipe");
    int calls = 0;
    if (meanwhile) source.set_meanwhile([&] { ++calls; });
    std::thread writer([&] {
      sigset_t alarm;  // only the reading thread receives SIGALRM
      sigemptyset(&alarm);
      sigaddset(&alarm, SIGALRM);
      pthread_sigmask(SIG_BLOCK, &alarm, nullptr);
      while (signals < 10) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      pipe.write("G0 X1\n");
      pipe.end();
    });
    const itimerval every{{0, 2000}, {0, 2000}};
    setitimer(ITIMER_REAL, &every, nullptr);
    EXPECT_THAT(all(source), ElementsAre("G0 X1"));
    const itimerval never{};
    setitimer(ITIMER_REAL, &never, nullptr);
    writer.join();
    EXPECT_FALSE(source.failure());
    if (!meanwhile) continue;
    EXPECT_GT(calls, 3) << "each signal ends a wait of 20 ms, and another one begins";
  }
  sigaction(SIGALRM, &before, nullptr);
}

TEST(LineSource, SaysWhyAFileCannotBeRead) {
  for (const auto& [path, reason] :
       {std::pair("no/such.ngc", "No such file or directory"), std::pair("/", "Is a directory")}) {
    FileLines source(path);
    machine::Machine machine;
    Reader reader(source, machine);
    Motion motion;
    EXPECT_FALSE(reader.next(motion));
    ASSERT_TRUE(reader.error());
    EXPECT_EQ(reader.error()->code, ErrorCode::kCannotRead);
    EXPECT_EQ(reader.error()->line, 0U);
    EXPECT_EQ(reader.error()->message, std::string("cannot read the program: ") + reason);
  }
}

}  // namespace
}  // namespace trammel::gcode
