// The model of the queue against a deque of committed and one of pending halfwords.
#include "trammel/model/halfword_queue.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <deque>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "trammel/skip/commands.hpp"

namespace {

using trammel::model::HalfwordQueue;

HalfwordQueue::Inputs write_of(std::uint16_t word) {
  HalfwordQueue::Inputs in;
  in.write = true;
  in.word = word;
  return in;
}

HalfwordQueue::Inputs commit() {
  HalfwordQueue::Inputs in;
  in.commit = true;
  return in;
}

HalfwordQueue::Inputs drop() {
  HalfwordQueue::Inputs in;
  in.drop = true;
  return in;
}

HalfwordQueue::Inputs read() {
  HalfwordQueue::Inputs in;
  in.read = true;
  return in;
}

TEST(HalfwordQueue, RefusesDepthsItCannotCount) {
  EXPECT_THROW(HalfwordQueue(1), std::invalid_argument);
  EXPECT_THROW(HalfwordQueue(32769), std::invalid_argument);
  EXPECT_NO_THROW(HalfwordQueue(32768));
}

TEST(HalfwordQueue, ShowsOnlyWhatIsCommitted) {
  HalfwordQueue queue(8);
  queue.clock(write_of(0x1234));
  for (int i = 0; i < 5; ++i) {
    queue.clock(read());
    EXPECT_TRUE(queue.outputs().empty);
  }
  EXPECT_EQ(queue.free(), 7);
  queue.clock(commit());
  EXPECT_TRUE(queue.outputs().empty);
  queue.clock({});
  EXPECT_FALSE(queue.outputs().empty);
  queue.clock(read());
  EXPECT_TRUE(queue.outputs().empty);
  EXPECT_EQ(queue.free(), 8);
  EXPECT_NE(queue.outputs().word, 0x1234);
  queue.clock({});
  EXPECT_EQ(queue.outputs().word, 0x1234);
}

TEST(HalfwordQueue, RoomComesTwoClocksAfterAndAfterAClearAtOnce) {
  HalfwordQueue queue(8);
  queue.clock(write_of(1));
  EXPECT_EQ(queue.outputs().room, 8);
  queue.clock(drop());
  EXPECT_EQ(queue.outputs().room, 7);
  queue.clock(write_of(2));
  EXPECT_EQ(queue.outputs().room, 8);
  queue.clock(write_of(3));
  EXPECT_EQ(queue.outputs().room, 7);
  HalfwordQueue::Inputs clear;
  clear.clear = true;
  queue.clock(clear);
  EXPECT_EQ(queue.outputs().room, 8);
}

TEST(HalfwordQueue, DropGivesTheRoomBackAndKeepsWhatIsCommitted) {
  HalfwordQueue queue(5);
  queue.clock(write_of(1));
  queue.clock(commit());
  queue.clock(write_of(2));
  queue.clock(write_of(3));
  queue.clock(drop());
  EXPECT_EQ(queue.free(), 4);
  queue.clock(write_of(4));
  queue.clock(commit());
  queue.clock({});
  queue.clock(read());
  queue.clock(read());
  EXPECT_EQ(queue.outputs().word, 1);
  queue.clock({});
  EXPECT_EQ(queue.outputs().word, 4);
  EXPECT_TRUE(queue.outputs().empty);
}

TEST(HalfwordQueue, ClearForgetsEverything) {
  HalfwordQueue queue(5);
  for (std::uint16_t i = 0; i < 5; ++i) queue.clock(write_of(i));
  EXPECT_EQ(queue.free(), 0);
  queue.clock(commit());
  HalfwordQueue::Inputs clear;
  clear.clear = true;
  queue.clock(clear);
  queue.clock({});
  EXPECT_TRUE(queue.outputs().empty);
  EXPECT_EQ(queue.free(), 5);
}

// Reads return the committed halfwords in order, with any operations in between; room is exact, delayed by one clock.
void compare_with_deque(std::size_t depth, std::uint64_t seed) {
  HalfwordQueue queue(depth);
  std::mt19937_64 random(seed);
  std::deque<std::uint16_t> committed;
  std::vector<std::uint16_t> pending;
  std::deque<std::pair<int, std::uint16_t>> due;
  std::size_t reads = 0;
  for (int now = 0; now < 20000; ++now) {
    HalfwordQueue::Inputs in;
    const std::uint16_t free = queue.free();
    in.write = free != 0 && random() % 2 == 0;
    in.word = static_cast<std::uint16_t>(random());
    in.commit = !in.write && random() % 4 == 0;
    in.drop = !in.commit && !in.write && random() % 20 == 0;
    in.read = random() % 2 == 0;
    if (in.read && !queue.outputs().empty) {
      ASSERT_FALSE(committed.empty());
      due.emplace_back(now + 1, committed.front());
      committed.pop_front();
      ++reads;
    }
    if (in.write) pending.push_back(in.word);
    if (in.commit) committed.insert(committed.end(), pending.begin(), pending.end());
    if (in.commit || in.drop) pending.clear();
    queue.clock(in);
    ASSERT_EQ(queue.outputs().room, free);
    ASSERT_EQ(queue.free(), depth - committed.size() - pending.size());
    ASSERT_TRUE(queue.outputs().empty || !committed.empty());
    if (!due.empty() && due.front().first == now) {
      ASSERT_EQ(queue.outputs().word, due.front().second);
      due.pop_front();
    }
  }
  EXPECT_GT(reads, 1000U);
}

TEST(HalfwordQueue, GivesBackWhatWasCommittedInOrder) {
  for (const std::size_t depth : {2U, 3U, 37U, 64U, 2560U, 8192U, 32768U}) compare_with_deque(depth, 7 + depth);
}

// The room has one bit more than a pointer: an empty queue of the largest depth shows 0x8000.
TEST(HalfwordQueue, CountsItsFullDepth) {
  HalfwordQueue queue(32768);
  EXPECT_EQ(queue.free(), 32768);
  for (std::uint32_t i = 0; i < 32768; ++i) queue.clock(write_of(static_cast<std::uint16_t>(i * 40503U)));
  EXPECT_EQ(queue.free(), 0);
  queue.clock(commit());
  queue.clock({});
  for (std::uint32_t i = 0; i < 32768; ++i) {
    queue.clock(read());
    if (i != 0) {
      ASSERT_EQ(queue.outputs().word, static_cast<std::uint16_t>((i - 1) * 40503U)) << i;
    }
  }
  EXPECT_TRUE(queue.outputs().empty);
  EXPECT_EQ(queue.free(), 32768);
}

TEST(HalfwordQueue, QuietMeansThatAClockChangesNothing) {
  HalfwordQueue queue(4);
  queue.clock(write_of(9));
  queue.clock(commit());
  EXPECT_FALSE(trammel::skip::horizon(queue, {}) != 0);
  queue.clock({});
  EXPECT_TRUE(trammel::skip::horizon(queue, {}) != 0);
  queue.clock(read());
  EXPECT_FALSE(trammel::skip::horizon(queue, {}) != 0);
  queue.clock({});
  EXPECT_TRUE(trammel::skip::horizon(queue, {}) != 0);
  const auto before = queue.outputs();
  for (int i = 0; i < 10; ++i) queue.clock({});
  EXPECT_EQ(queue.outputs().word, before.word);
  EXPECT_EQ(queue.outputs().empty, before.empty);
  EXPECT_EQ(queue.outputs().room, before.room);
}

}  // namespace
