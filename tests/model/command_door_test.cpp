// The door's model against the layout table: what it lets in, what it refuses and why, and that nothing of a refused
// command is ever committed.
#include "trammel/model/command_door.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_source.hpp"

namespace {

using trammel::card_map::Command;
using trammel::card_map::kCommands;
using trammel::card_map::MaskRule;
using trammel::card_map::Reason;
using trammel::model::CommandDoor;
using trammel::testing::CommandSource;
using trammel::testing::Violation;
using trammel::testing::WireCommand;

using Halfwords = std::vector<std::uint16_t>;

// A door with a host in front and two queues of any room behind it.
class Stream {
 public:
  explicit Stream(unsigned axes) : door_(axes) {}

  struct Queue {
    std::uint16_t room = 4096;
    Halfwords pending;
    Halfwords committed;
  };
  Queue geometry;
  Queue feed;
  std::vector<Reason> refusals;
  std::uint8_t refused_number = 0;

  void clock(CommandDoor::Inputs in) {
    in.geometry_room = geometry.room;
    in.feed_room = feed.room;
    door_.clock(in);
    const CommandDoor::Outputs& out = door_.outputs();
    take(geometry, out.geometry_write, out.geometry_commit);
    take(feed, out.feed_write, out.feed_commit);
    if (!out.refuse) return;
    refusals.push_back(static_cast<Reason>(out.reason));
    refused_number = out.number;
  }

  // True when the word was taken; the answer must come after exactly the time that the header promises.
  bool write(std::uint32_t word, int answer_clocks = CommandDoor::kAnswerClocks) {
    CommandDoor::Inputs in;
    in.write = true;
    in.word = word;
    EXPECT_TRUE(door_.outputs().ready);
    clock(in);
    for (int i = 1; i < answer_clocks; ++i) {
      EXPECT_FALSE(door_.outputs().ready || door_.outputs().done || door_.outputs().error);
      clock({});
    }
    EXPECT_TRUE(door_.outputs().ready);
    EXPECT_NE(door_.outputs().done, door_.outputs().error);
    return door_.outputs().done;
  }

  // Sends words until one is refused; true when all were taken.
  bool send(const std::vector<std::uint32_t>& words) {
    for (const std::uint32_t word : words) {
      if (!write(word)) return false;
    }
    return true;
  }

  void clear() {
    CommandDoor::Inputs in;
    in.clear = true;
    clock(in);
    geometry.pending.clear();
    feed.pending.clear();
  }

  void flush() {
    CommandDoor::Inputs in;
    in.flush = true;
    clock(in);
  }

  const CommandDoor::Outputs& outputs() const { return door_.outputs(); }
  bool quiet() const { return door_.quiet(); }

 private:
  void take(Queue& queue, bool write, bool commit) {
    EXPECT_FALSE(write && commit);
    EXPECT_FALSE(door_.outputs().drop && (write || commit));
    if (write) queue.pending.push_back(door_.outputs().halfword);
    EXPECT_LE(queue.pending.size(), queue.room);
    if (commit) queue.committed.insert(queue.committed.end(), queue.pending.begin(), queue.pending.end());
    if (commit || door_.outputs().drop) queue.pending.clear();
  }

  CommandDoor door_;
};

bool possible(const Command& layout, unsigned axes) { return layout.mask_rule != MaskRule::Plane || axes >= 2; }

void append(Halfwords& to, const Halfwords& from) { to.insert(to.end(), from.begin(), from.end()); }

TEST(CommandDoor, RefusesImpossibleCards) {
  EXPECT_THROW(CommandDoor(0), std::invalid_argument);
  EXPECT_THROW(CommandDoor(9), std::invalid_argument);
}

TEST(CommandDoor, StoresEveryKindOfCommandExactly) {
  for (unsigned axes = 1; axes <= 8; ++axes) {
    for (const Command& layout : kCommands) {
      if (!possible(layout, axes)) continue;
      CommandSource source(axes, axes);
      Stream stream(axes);
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

// A line by hand, so that the layout table is not its own only judge: 0x3322221111 ticks, X 2^-40 pulses a tick, Z -1.
TEST(CommandDoor, StoresThisLine) {
  Stream stream(4);
  ASSERT_TRUE(stream.send({0x00060501, 0x22221111, 0x00010033, 0x00000000, 0x00000000, 0x0000FF00}));
  EXPECT_EQ(stream.geometry.committed,
            (Halfwords{0x0501, 0x1111, 0x2222, 0x0033, 0x0001, 0x0000, 0x0000, 0x0000, 0x0000, 0xFF00}));
  EXPECT_TRUE(stream.feed.committed.empty());
}

void expect_refused(unsigned axes, const Violation& violation) {
  SCOPED_TRACE(std::string(violation.command.layout->name) + ", " + violation.name);
  Stream stream(axes);
  EXPECT_FALSE(stream.send(violation.command.words(violation.padding)));
  EXPECT_EQ(stream.refusals, std::vector<Reason>{violation.reason});
  EXPECT_EQ(stream.refused_number, violation.command.number());
  EXPECT_TRUE(stream.geometry.committed.empty() && stream.feed.committed.empty());
  EXPECT_TRUE(stream.geometry.pending.empty() && stream.feed.pending.empty());
  EXPECT_FALSE(stream.outputs().partial);
}

TEST(CommandDoor, RefusesEverySingleViolationWithItsReason) {
  for (const unsigned axes : {1U, 4U, 8U}) {
    CommandSource source(axes, 11 * axes);
    for (const Command& layout : kCommands) {
      if (!possible(layout, axes)) continue;
      const auto list = violations(source.make(layout, 0), axes);
      ASSERT_GT(list.size(), 700U);
      for (const Violation& violation : list) expect_refused(axes, violation);
    }
  }
}

TEST(CommandDoor, PassesRandomStreamsAndWrapsTheNumber) {
  CommandSource source(8, 12);
  Stream stream(8);
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

// Words with three bits turned over. What is taken nevertheless has become another good command (DWELL for END, other
// axes, another value), and stands in its queues exactly as it was sent.
TEST(CommandDoor, CommitsWhatWasSentOrNothing) {
  CommandSource source(4, 13);
  auto& random = source.random();
  unsigned refused = 0;
  for (int i = 0; i < 20000; ++i) {
    Stream stream(4);
    std::vector<std::uint32_t> words = source.any(0).words();
    for (int flips = 0; flips < 3; ++flips) words[random() % words.size()] ^= 1U << random() % 32;
    if (!stream.send(words) || stream.outputs().partial) {
      ++refused;
      EXPECT_TRUE(stream.geometry.committed.empty() && stream.feed.committed.empty());
      continue;
    }
    WireCommand sent;
    sent.layout = trammel::card_map::find_command(static_cast<std::uint8_t>(words[0]));
    ASSERT_NE(sent.layout, nullptr);
    const auto mask = static_cast<std::uint8_t>(words[0] >> 8);
    ASSERT_EQ(words.size(), trammel::card_map::words(*sent.layout, mask));
    for (std::size_t h = 0; h < trammel::card_map::halfwords(*sent.layout, mask); ++h) {
      sent.halfwords.push_back(static_cast<std::uint16_t>(words[h / 2] >> (16 * (h % 2))));
    }
    EXPECT_EQ(stream.geometry.committed, sent.layout->to_geometry ? sent.stored() : Halfwords{});
    EXPECT_EQ(stream.feed.committed, sent.layout->to_feed ? sent.stored() : Halfwords{});
  }
  EXPECT_GT(refused, 1000U);
  EXPECT_LT(refused, 20000U);
}

TEST(CommandDoor, NeverCommitsGarbage) {
  CommandSource source(8, 14);
  Stream stream(8);
  for (int i = 0; i < 200000; ++i) {
    if (!stream.write(static_cast<std::uint32_t>(source.random()()))) stream.clear();
  }
  // A random first word is right about once in 10^7.
  EXPECT_TRUE(stream.geometry.committed.empty() && stream.feed.committed.empty());
}

TEST(CommandDoor, NeedsRoomForTheWholeCommandInEachOfItsQueues) {
  for (const Command& layout : kCommands) {
    CommandSource source(4, 15);
    const WireCommand command = source.make(layout, 0);
    const auto needed = static_cast<std::uint16_t>(command.stored().size());
    for (int lack = 0; lack < 4; ++lack) {
      SCOPED_TRACE(std::string(layout.name) + " lack " + std::to_string(lack));
      Stream stream(4);
      stream.geometry.room = static_cast<std::uint16_t>(needed - (lack & 1));
      stream.feed.room = static_cast<std::uint16_t>(needed - (lack >> 1));
      const bool lacks = (layout.to_geometry && (lack & 1) != 0) || (layout.to_feed && (lack >> 1) != 0);
      EXPECT_EQ(stream.send(command.words()), !lacks);
      EXPECT_EQ(stream.refusals, lacks ? std::vector<Reason>{Reason::NoRoom} : std::vector<Reason>{});
    }
  }
}

TEST(CommandDoor, RefusesAPartialCommandAtAFlush) {
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

TEST(CommandDoor, TakesNoNoticeOfAFlushBetweenCommands) {
  CommandSource source(4, 17);
  Stream stream(4);
  stream.flush();
  ASSERT_TRUE(stream.send(source.any(0).words()));
  stream.flush();
  ASSERT_TRUE(stream.send(source.any(1).words()));
  EXPECT_TRUE(stream.refusals.empty());
}

TEST(CommandDoor, LetsAFlushWaitForTheWordInWork) {
  CommandSource source(4, 18);
  const auto words = source.make(kCommands[0], 0).words();
  Stream stream(4);
  CommandDoor::Inputs in;
  in.write = true;
  in.word = words[0];
  stream.clock(in);
  stream.flush();
  for (int i = 2; i < CommandDoor::kAnswerClocks; ++i) stream.clock({});
  EXPECT_TRUE(stream.outputs().done);
  EXPECT_TRUE(stream.refusals.empty());
  stream.clock({});
  EXPECT_EQ(stream.refusals, std::vector<Reason>{Reason::Truncated});
}

TEST(CommandDoor, StaysClosedUntilClear) {
  CommandSource source(4, 19);
  Stream stream(4);
  ASSERT_TRUE(stream.send(source.any(0).words()));
  EXPECT_FALSE(stream.write(0x000000FF));
  stream.refusals.clear();
  for (const std::uint32_t word : source.any(1).words()) {
    EXPECT_FALSE(stream.write(word, CommandDoor::kClosedAnswerClocks));
    EXPECT_FALSE(stream.outputs().drop);
  }
  for (const Reason reason : stream.refusals) EXPECT_EQ(reason, Reason::DoorClosed);
  EXPECT_FALSE(stream.refusals.empty());
  stream.clear();
  EXPECT_TRUE(stream.send(source.any(0).words()));
}

TEST(CommandDoor, AnswersAWordInWorkAtClearWithAnError) {
  CommandSource source(4, 20);
  Stream stream(4);
  CommandDoor::Inputs in;
  in.write = true;
  in.word = source.any(0).words()[0];
  stream.clock(in);
  stream.clear();
  EXPECT_TRUE(stream.outputs().error);
  EXPECT_TRUE(stream.outputs().ready);
  EXPECT_FALSE(stream.outputs().refuse);
  EXPECT_TRUE(stream.send(source.any(0).words()));
}

TEST(CommandDoor, IgnoresAWriteThatDoesNotWait) {
  CommandSource source(4, 21);
  const WireCommand command = source.make(kCommands[0], 0);
  Stream stream(4);
  for (const std::uint32_t word : command.words()) {
    CommandDoor::Inputs in;
    in.write = true;
    in.word = word;
    stream.clock(in);
    in.word = 0xFFFFFFFF;
    while (!stream.outputs().ready) stream.clock(in);
  }
  EXPECT_EQ(stream.geometry.committed, command.stored());
}

TEST(CommandDoor, QuietMeansThatAClockChangesNothing) {
  CommandSource source(4, 22);
  Stream stream(4);
  EXPECT_TRUE(stream.quiet());
  ASSERT_TRUE(stream.send(source.any(0).words()));
  EXPECT_FALSE(stream.quiet());
  stream.clock({});
  EXPECT_TRUE(stream.quiet());
  const CommandDoor::Outputs before = stream.outputs();
  for (int i = 0; i < 10; ++i) stream.clock({});
  EXPECT_TRUE(stream.quiet());
  EXPECT_EQ(stream.outputs().halfword, before.halfword);
  EXPECT_EQ(stream.outputs().number, before.number);
}

}  // namespace
