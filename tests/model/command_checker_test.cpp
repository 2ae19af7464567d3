// The model of the checker against the layout table: which commands it accepts, which it refuses and why. No part of a
// refused command is ever committed.
#include "trammel/model/command_checker.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "command_source.hpp"

namespace {

using trammel::card_map::Command;
using trammel::card_map::kCommands;
using trammel::card_map::Reason;
using trammel::model::CommandChecker;
using trammel::testing::CommandSource;
using trammel::testing::kAllEngines;
using trammel::testing::kUsualEngines;
using trammel::testing::Violation;
using trammel::testing::WireCommand;

using Halfwords = std::vector<std::uint16_t>;

// A checker between a host and two queues with adjustable room.
class Stream {
 public:
  explicit Stream(unsigned axes, std::uint32_t engines = kUsualEngines) : checker_(axes, engines) {}

  struct Queue {
    std::uint16_t room = 4096;
    Halfwords pending;
    Halfwords committed;
  };
  Queue geometry;
  Queue feed;
  std::vector<Reason> refusals;
  std::uint8_t refused_number = 0;
  bool closed = false;

  void clock(CommandChecker::Inputs in) {
    in.geometry_room = geometry.room;
    in.feed_room = feed.room;
    checker_.clock(in);
    const CommandChecker::Outputs& out = checker_.outputs();
    take(geometry, out.geometry_write, out.geometry_commit);
    take(feed, out.feed_write, out.feed_commit);
    if (!out.refuse) return;
    refusals.push_back(static_cast<Reason>(out.reason));
    refused_number = out.number;
  }

  // True when the word was accepted. The answer must take exactly the clocks that the header of the model promises.
  bool write(std::uint32_t word, int answer_clocks = CommandChecker::kAnswerClocks) {
    CommandChecker::Inputs in;
    in.write = true;
    in.word = word;
    in.closed = closed;
    const std::size_t refused = refusals.size();
    EXPECT_TRUE(checker_.outputs().ready);
    clock(in);
    for (int i = 1; i < answer_clocks; ++i) {
      EXPECT_FALSE(checker_.outputs().ready);
      clock({});
    }
    EXPECT_TRUE(checker_.outputs().ready);
    return refusals.size() == refused;
  }

  // Sends words until one is refused; true when all were accepted.
  bool send(const std::vector<std::uint32_t>& words) {
    for (const std::uint32_t word : words) {
      if (!write(word)) return false;
    }
    return true;
  }

  void clear() {
    CommandChecker::Inputs in;
    in.clear = true;
    clock(in);
    geometry.pending.clear();
    feed.pending.clear();
  }

  void flush() {
    CommandChecker::Inputs in;
    in.flush = true;
    clock(in);
  }

  const CommandChecker::Outputs& outputs() const { return checker_.outputs(); }

 private:
  void take(Queue& queue, bool write, bool commit) {
    EXPECT_FALSE(write && commit);
    EXPECT_FALSE(checker_.outputs().drop && (write || commit));
    if (write) queue.pending.push_back(checker_.outputs().halfword);
    EXPECT_LE(queue.pending.size(), queue.room);
    if (commit) queue.committed.insert(queue.committed.end(), queue.pending.begin(), queue.pending.end());
    if (commit || checker_.outputs().drop) queue.pending.clear();
  }

  CommandChecker checker_;
};

bool possible(const Command& layout, unsigned axes, std::uint32_t engines = kUsualEngines) {
  return CommandSource::possible(layout, axes, engines);
}

void append(Halfwords& to, const Halfwords& from) { to.insert(to.end(), from.begin(), from.end()); }

TEST(CommandChecker, RefusesImpossibleCards) {
  EXPECT_THROW(CommandChecker(0, kUsualEngines), std::invalid_argument);
  EXPECT_THROW(CommandChecker(9, kUsualEngines), std::invalid_argument);
}

TEST(CommandChecker, StoresEveryKindOfCommandExactly) {
  for (unsigned axes = 1; axes <= 8; ++axes) {
    for (const Command& layout : kCommands) {
      if (!possible(layout, axes, kAllEngines)) continue;
      CommandSource source(axes, axes, kAllEngines);
      Stream stream(axes, kAllEngines);
      const WireCommand command = source.make(layout, 0);
      ASSERT_TRUE(stream.send(command.words())) << layout.name;
      const Halfwords nothing;
      EXPECT_EQ(stream.geometry.committed, layout.to_geometry ? command.stored() : nothing);
      EXPECT_EQ(stream.feed.committed, layout.to_feed ? command.stored() : nothing);
      EXPECT_FALSE(stream.outputs().partial);
      EXPECT_TRUE(stream.refusals.empty());
    }
  }
}

// A line coded by hand, so that the layout table is not only compared with itself: 0x3322221111 ticks, X 2^-40 pulses
// per tick, Z -1.
TEST(CommandChecker, StoresThisLine) {
  Stream stream(4);
  ASSERT_TRUE(stream.send({0x00060501, 0x22221111, 0x00010033, 0x00000000, 0x00000000, 0x0000FF00}));
  EXPECT_EQ(stream.geometry.committed,
            (Halfwords{0x0501, 0x1111, 0x2222, 0x0033, 0x0001, 0x0000, 0x0000, 0x0000, 0x0000, 0xFF00}));
  EXPECT_TRUE(stream.feed.committed.empty());
}

void expect_refused(unsigned axes, const Violation& violation, std::uint32_t engines = kUsualEngines) {
  SCOPED_TRACE(std::string(violation.command.layout->name) + ", " + violation.name);
  Stream stream(axes, engines);
  EXPECT_FALSE(stream.send(violation.command.words(violation.padding)));
  EXPECT_EQ(stream.refusals, std::vector<Reason>{violation.reason});
  EXPECT_EQ(stream.refused_number, violation.command.number());
  EXPECT_TRUE(stream.geometry.committed.empty() && stream.feed.committed.empty());
  EXPECT_TRUE(stream.geometry.pending.empty() && stream.feed.pending.empty());
  EXPECT_FALSE(stream.outputs().partial);
}

TEST(CommandChecker, RefusesEverySingleViolationWithItsReason) {
  for (const std::uint32_t engines : {kUsualEngines, kAllEngines}) {
    for (const unsigned axes : {1U, 4U, 8U}) {
      CommandSource source(axes, 11 * axes, engines);
      for (const Command& layout : kCommands) {
        if (!possible(layout, axes, engines)) continue;
        const auto list = violations(source.make(layout, 0), axes, engines);
        ASSERT_GT(list.size(), 700U);
        for (const Violation& violation : list) expect_refused(axes, violation, engines);
      }
    }
  }
}

// A list made by hand: the engine that each opcode needs.
TEST(CommandChecker, KnowsTheCommandsOfItsEnginesAlone) {
  const std::vector<std::pair<unsigned, unsigned>> needs = {{1, 0},  {2, 1},  {3, 3},  {16, 0}, {32, 0}, {33, 0},
                                                            {34, 7}, {35, 7}, {36, 7}, {37, 7}, {38, 7}};
  for (const auto& [opcode, engine] : needs) {
    const Command& layout = *trammel::card_map::find_command(static_cast<std::uint8_t>(opcode));
    // Every card has the engine for lines.
    for (const std::uint32_t engines : {kAllEngines, (kAllEngines & ~(1U << engine)) | 1U}) {
      SCOPED_TRACE(std::string(layout.name) + " with engines " + std::to_string(engines));
      CommandSource source(4, opcode, engines);
      Stream stream(4, engines);
      const bool known = engine == 0 || engines == kAllEngines;
      EXPECT_EQ(stream.send(source.make(layout, 0).words()), known);
      EXPECT_EQ(stream.refusals, known ? std::vector<Reason>{} : std::vector<Reason>{Reason::UnknownOpcode});
    }
  }
}

TEST(CommandChecker, StepRuleAndClassNeedTheirEngines) {
  CommandSource source(4, 30);
  WireCommand arc = source.make(*trammel::card_map::find_command(2), 0);
  arc.halfwords[11] |= 2;
  WireCommand rapid = source.make(*trammel::card_map::find_command(16), 0);
  rapid.halfwords[0] |= 0x0100;
  for (const bool has : {false, true}) {
    const std::uint32_t engines = kUsualEngines | (has ? 1U << 2 | 1U << 9 : 0);
    Stream stream(4, engines);
    EXPECT_EQ(stream.send(arc.words()), has);
    if (!has) {
      EXPECT_EQ(stream.refusals.back(), Reason::BadField);
    }
    Stream second(4, engines);
    EXPECT_EQ(second.send(rapid.words()), has);
    if (!has) {
      EXPECT_EQ(second.refusals.back(), Reason::BadMask);
    }
  }
}

// A word that arrives during a fault is refused without being decoded: nothing is closed or dropped, and the expected
// number stays.
TEST(CommandChecker, RefusesWordsAsFaultedWhileAFaultStands) {
  CommandSource source(4, 31);
  Stream stream(4);
  ASSERT_TRUE(stream.send(source.any(0).words()));
  const WireCommand next = source.make(kCommands[0], 1);
  stream.closed = true;
  for (const std::uint32_t word : next.words()) {
    EXPECT_FALSE(stream.write(word, CommandChecker::kClosedAnswerClocks));
    EXPECT_EQ(stream.refusals.back(), Reason::Faulted);
    EXPECT_FALSE(stream.outputs().drop);
    EXPECT_FALSE(stream.outputs().partial);
  }
  stream.closed = false;
  EXPECT_TRUE(stream.send(next.words())) << "the stream is as it was";
  stream.closed = true;
  stream.clear();
  EXPECT_FALSE(stream.write(next.words()[0], CommandChecker::kClosedAnswerClocks));
  EXPECT_EQ(stream.refused_number, 0) << "after a cut";
}

TEST(CommandChecker, FaultedGoesBeforeStreamClosed) {
  CommandSource source(4, 32);
  Stream stream(4);
  EXPECT_FALSE(stream.write(0x000000FF));
  EXPECT_EQ(stream.refusals.back(), Reason::UnknownOpcode);
  stream.closed = true;
  EXPECT_FALSE(stream.write(0, CommandChecker::kClosedAnswerClocks));
  EXPECT_EQ(stream.refusals.back(), Reason::Faulted);
  stream.closed = false;
  EXPECT_FALSE(stream.write(0, CommandChecker::kClosedAnswerClocks));
  EXPECT_EQ(stream.refusals.back(), Reason::StreamClosed);
}

TEST(CommandChecker, PassesRandomStreamsAndWrapsTheNumber) {
  CommandSource source(8, 12, kAllEngines);
  Stream stream(8, kAllEngines);
  Halfwords geometry;
  Halfwords feed;
  for (unsigned i = 0; i < 1000; ++i) {
    const WireCommand command = source.any(static_cast<std::uint8_t>(i));
    ASSERT_TRUE(stream.send(command.words())) << command.layout->name << " at " << i;
    if (command.layout->to_geometry) append(geometry, command.stored());
    if (command.layout->to_feed) append(feed, command.stored());
  }
  EXPECT_EQ(stream.geometry.committed, geometry);
  EXPECT_EQ(stream.feed.committed, feed);
}

// Words with three flipped bits. An accepted command has become another valid command (DWELL for END, other axes,
// another value, or a short command in place of the first words of a long one); the queues must hold exactly its
// halfwords.
TEST(CommandChecker, CommitsWhatWasSentOrNothing) {
  CommandSource source(4, 13);
  auto& random = source.random();
  unsigned refused = 0;
  for (int i = 0; i < 20000; ++i) {
    Stream stream(4);
    std::vector<std::uint32_t> words = source.any(0).words();
    for (int flips = 0; flips < 3; ++flips) words[random() % words.size()] ^= 1U << random() % 32;
    const bool whole = stream.send(words) && !stream.outputs().partial;
    if (!whole) ++refused;
    if (stream.geometry.committed.empty() && stream.feed.committed.empty()) {
      EXPECT_FALSE(whole);
      continue;
    }
    WireCommand sent;
    sent.layout = trammel::card_map::find_command(static_cast<std::uint8_t>(words[0]));
    ASSERT_NE(sent.layout, nullptr);
    const auto mask = static_cast<std::uint8_t>(words[0] >> 8);
    const std::size_t length = trammel::card_map::words(*sent.layout, mask);
    ASSERT_TRUE(whole ? words.size() == length : words.size() > length);
    for (std::size_t h = 0; h < trammel::card_map::halfwords(*sent.layout, mask); ++h) {
      sent.halfwords.push_back(static_cast<std::uint16_t>(words[h / 2] >> (16 * (h % 2))));
    }
    EXPECT_EQ(stream.geometry.committed, sent.layout->to_geometry ? sent.stored() : Halfwords{});
    EXPECT_EQ(stream.feed.committed, sent.layout->to_feed ? sent.stored() : Halfwords{});
  }
  EXPECT_GT(refused, 1000U);
  EXPECT_LT(refused, 20000U);
}

TEST(CommandChecker, NeverCommitsGarbage) {
  CommandSource source(8, 14);
  Stream stream(8);
  for (int i = 0; i < 200000; ++i) {
    if (!stream.write(static_cast<std::uint32_t>(source.random()()))) stream.clear();
  }
  // The probability that a random first word is valid is about 10^-7.
  EXPECT_TRUE(stream.geometry.committed.empty() && stream.feed.committed.empty());
}

TEST(CommandChecker, NeedsRoomForTheWholeCommandInEachOfItsQueues) {
  for (const Command& layout : kCommands) {
    if (!possible(layout, 4, kAllEngines)) continue;
    CommandSource source(4, 15, kAllEngines);
    const WireCommand command = source.make(layout, 0);
    const auto needed = static_cast<std::uint16_t>(command.stored().size());
    for (int lack = 0; lack < 4; ++lack) {
      SCOPED_TRACE(std::string(layout.name) + " lack " + std::to_string(lack));
      Stream stream(4, kAllEngines);
      stream.geometry.room = static_cast<std::uint16_t>(needed - (lack & 1));
      stream.feed.room = static_cast<std::uint16_t>(needed - (lack >> 1));
      const bool lacks = (layout.to_geometry && (lack & 1) != 0) || (layout.to_feed && (lack >> 1) != 0);
      EXPECT_EQ(stream.send(command.words()), !lacks);
      EXPECT_EQ(stream.refusals, lacks ? std::vector<Reason>{Reason::NoRoom} : std::vector<Reason>{});
    }
  }
}

TEST(CommandChecker, RefusesAPartialCommandAtAFlush) {
  CommandSource source(4, 16);
  const WireCommand command = source.make(kCommands[1], 0);
  const auto words = command.words();
  for (std::size_t sent = 1; sent < words.size(); ++sent) {
    Stream stream(4);
    ASSERT_TRUE(stream.send({words.begin(), words.begin() + static_cast<std::ptrdiff_t>(sent)}));
    EXPECT_TRUE(stream.outputs().partial);
    stream.flush();
    EXPECT_EQ(stream.refusals, std::vector<Reason>{Reason::Truncated});
    EXPECT_TRUE(stream.outputs().drop);
    EXPECT_FALSE(stream.outputs().partial);
    EXPECT_TRUE(stream.geometry.pending.empty() && stream.geometry.committed.empty());
  }
}

TEST(CommandChecker, TakesNoNoticeOfAFlushBetweenCommands) {
  CommandSource source(4, 17);
  Stream stream(4);
  stream.flush();
  ASSERT_TRUE(stream.send(source.any(0).words()));
  stream.flush();
  ASSERT_TRUE(stream.send(source.any(1).words()));
  EXPECT_TRUE(stream.refusals.empty());
}

TEST(CommandChecker, LetsAFlushWaitForTheWordUnderWay) {
  CommandSource source(4, 18);
  const auto words = source.make(kCommands[0], 0).words();
  Stream stream(4);
  CommandChecker::Inputs in;
  in.write = true;
  in.word = words[0];
  stream.clock(in);
  stream.flush();
  for (int i = 2; i < CommandChecker::kAnswerClocks; ++i) stream.clock({});
  EXPECT_TRUE(stream.outputs().ready);
  EXPECT_TRUE(stream.outputs().partial);
  EXPECT_TRUE(stream.refusals.empty());
  stream.clock({});
  EXPECT_EQ(stream.refusals, std::vector<Reason>{Reason::Truncated});
}

TEST(CommandChecker, StaysClosedUntilClear) {
  CommandSource source(4, 19);
  Stream stream(4);
  ASSERT_TRUE(stream.send(source.any(0).words()));
  EXPECT_FALSE(stream.write(0x000000FF));
  stream.refusals.clear();
  for (const std::uint32_t word : source.any(1).words()) {
    EXPECT_FALSE(stream.write(word, CommandChecker::kClosedAnswerClocks));
    EXPECT_FALSE(stream.outputs().drop);
  }
  for (const Reason reason : stream.refusals) EXPECT_EQ(reason, Reason::StreamClosed);
  EXPECT_FALSE(stream.refusals.empty());
  stream.clear();
  EXPECT_TRUE(stream.send(source.any(0).words()));
}

TEST(CommandChecker, DropsAWordUnderWayAtClearWithoutARefusal) {
  CommandSource source(4, 20);
  Stream stream(4);
  CommandChecker::Inputs in;
  in.write = true;
  in.word = source.any(0).words()[0];
  stream.clock(in);
  stream.clear();
  EXPECT_TRUE(stream.outputs().ready);
  EXPECT_FALSE(stream.outputs().refuse);
  EXPECT_TRUE(stream.send(source.any(0).words()));
}

TEST(CommandChecker, IgnoresAWriteThatDoesNotWait) {
  CommandSource source(4, 21);
  const WireCommand command = source.make(kCommands[0], 0);
  Stream stream(4);
  for (const std::uint32_t word : command.words()) {
    CommandChecker::Inputs in;
    in.write = true;
    in.word = word;
    stream.clock(in);
    in.word = 0xFFFFFFFF;
    while (!stream.outputs().ready) stream.clock(in);
  }
  EXPECT_EQ(stream.geometry.committed, command.stored());
}

}  // namespace
