// Random bytes and random lines: nothing ends the controller, and each line gets exactly one answer.
#include "random.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "session.hpp"

namespace trammel::grbl {
namespace {

constexpr std::size_t kBytes = 65'536;

// Lines that cause neither a reset nor a lock.
constexpr std::array<const char*, 40> kLines{
    "G0X1", "G1X2Y3F500", "X4",      "G91",        "G90",      "G2X1I1", "G4P0.1",   "M0",      "M3S100",     "M5",
    "M30",  "$G",         "$$",      "$#",         "$I",       "$N",     "$",        "$J=X1F9", "$J=G91Y1F9", "$X",
    "G20",  "G21",        "G92X0",   "G10L20P1Y0", "G54",      "G55",    "(remark)", "",        "%",          "G5",
    "X1X2", "N5G0Z1",     "G53G0Z0", "$10=3",      "$110=900", "$0=1",   "$N0=",     "G43.1Z1", "G49",        "G80"};
constexpr std::array<const char*, 14> kCommands{"?",    "!",    "~",    "~",    "~",    "~",    "\x85",
                                                "\x84", "\x90", "\x91", "\x97", "\x9A", "\xC2", "\xFF"};
constexpr std::array<const char*, 14> kRough{"\x18",       "$C",     "$SLP",   "$H",      "G38.2Z-1F9",
                                             "G38.3Z-1F9", "$RST=*", "$RST=#", "G0X-999", "$J=X-999F1",
                                             "$22=1",      "$22=0",  "$20=1",  "G28"};

std::vector<std::uint64_t> seeds() {
  const char* const wanted = std::getenv("TRAMMEL_SEED");
  return wanted != nullptr ? std::vector<std::uint64_t>{std::stoull(wanted)} : std::vector<std::uint64_t>{1, 2, 3};
}

class Traffic {
 public:
  Traffic(Session& session, std::string bytes, std::uint64_t seed)
      : session_(session), bytes_(std::move(bytes)), random_(seed) {
    session_.fake.set_meanwhile([this] {
      pump();
      session_.controller.serve();
    });
  }

  void run() {
    while (at_ < bytes_.size()) {
      pump();
      session_.controller.work();
    }
    session_.settle();
  }

 private:
  // Sends some bytes. After the last one, '~' ends holds and pauses.
  void pump() {
    const std::size_t count = std::min<std::size_t>(random_.below(12), bytes_.size() - at_);
    session_.put(bytes_.substr(at_, count));
    at_ += count;
    if (at_ == bytes_.size()) session_.put("~");
  }

  Session& session_;
  std::string bytes_;
  test::Random random_;
  std::size_t at_ = 0;
};

// Lines with real-time commands at random places.
std::string random_lines(std::uint64_t seed, bool rough, std::size_t size) {
  test::Random random(seed);
  constexpr std::array<const char*, 3> kEnds{"\n", "\r", "\r\n"};
  std::string bytes;
  while (bytes.size() < size) {
    std::string line = kLines[random.below(kLines.size())];
    if (rough && random.below(8) == 0) line = kRough[random.below(kRough.size())];
    for (std::size_t n = random.below(3); n > 0; --n) {
      line.insert(random.below(line.size() + 1), kCommands[random.below(kCommands.size())]);
    }
    bytes += line + kEnds[random.below(kEnds.size())];
  }
  return bytes;
}

std::string random_bytes(std::uint64_t seed) {
  test::Random random(seed);
  std::string bytes;
  // Half of the bytes are random, and half are characters of lines.
  for (std::size_t n = 0; n < kBytes; ++n) {
    constexpr std::string_view kUsual = "GXYZFMJ$=0123456789.-\n\n\n\r~~~";
    bytes += random.below(2) == 0 ? static_cast<char>(random.below(256)) : kUsual[random.below(kUsual.size())];
  }
  return bytes + "\n";
}

// Number of line ends, not counting real-time commands.
std::size_t lines_in(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    if (c != '?' && c != '!' && c != '~' && c != 0x18 && static_cast<unsigned char>(c) < 0x80) text += c;
  }
  std::size_t count = 0;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const bool second = text[n] == '\n' && n > 0 && text[n - 1] == '\r';
    count += (text[n] == '\n' || text[n] == '\r') && !second ? 1U : 0U;
  }
  return count;
}

std::size_t answers_in(const std::vector<std::string>& texts) {
  return static_cast<std::size_t>(std::count_if(texts.begin(), texts.end(), [](const std::string& text) {
    return text == "ok" || text.rfind("error:", 0) == 0;
  }));
}

// After any input, a reset and $X make the controller work.
void expect_alive(Session& session) {
  session.fake.set_meanwhile([&session] { session.controller.serve(); });
  session.fake.unlock_leaves = {};
  session.put("\x18");
  session.settle();
  session.ask("");
  session.ask("$X");
  session.ask("$N0=");
  session.ask("$N1=");
  session.ask("$RST=#");
  EXPECT_EQ(session.last("G53G0X-1"), "ok");
  EXPECT_EQ(session.fake.at()[0], -1);
  EXPECT_EQ(session.state(), "Idle");
}

TEST(RandomTraffic, HasOneAnswerForEachLine) {
  for (const std::uint64_t seed : seeds()) {
    SCOPED_TRACE(fmt::format("repeat with TRAMMEL_SEED={}", seed));
    Session session;
    session.begun();
    const std::string bytes = random_lines(seed, false, kBytes / 2);
    Traffic(session, bytes, seed).run();
    EXPECT_EQ(answers_in(session.answers()), lines_in(bytes));
    EXPECT_GT(session.fake.motions.size(), 300U);
    expect_alive(session);
  }
}

TEST(RandomTraffic, OutlivesResetsAndAlarms) {
  for (const std::uint64_t seed : seeds()) {
    SCOPED_TRACE(fmt::format("repeat with TRAMMEL_SEED={}", seed));
    Session session(fenced_router());
    session.begun();
    session.fake.edge = 0.5;
    const std::string bytes = random_lines(seed, true, kBytes);
    Traffic(session, bytes, seed).run();
    EXPECT_LE(answers_in(session.answers()), lines_in(bytes));
    expect_alive(session);
  }
}

TEST(RandomTraffic, OutlivesBytes) {
  for (const std::uint64_t seed : seeds()) {
    SCOPED_TRACE(fmt::format("repeat with TRAMMEL_SEED={}", seed));
    Session session;
    session.begun();
    const std::string bytes = random_bytes(seed);
    Traffic(session, bytes, seed).run();
    EXPECT_LE(answers_in(session.answers()), lines_in(bytes));
    expect_alive(session);
  }
}

}  // namespace
}  // namespace trammel::grbl
