// FrameBus over a link that damages, loses and repeats frames, and that fails. FrameBus must report exactly the
// accesses that the card has made.
#include "trammel/driver/frame_bus.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <random>

#include "trammel/driver/errors.hpp"
#include "trammel/frames/endpoint.hpp"

namespace {

using namespace trammel;
using namespace std::chrono_literals;
using driver::Access;

// An in-memory link with its own clock; each byte takes 1 us.
class Link final : public driver::ByteLink {
 public:
  explicit Link(frames::Endpoint::Access access) : endpoint(std::move(access)) {}

  void send(const std::uint8_t* bytes, std::size_t count) override {
    if (gone) throw driver::LinkError("the cable is out");
    clock_ += time_of(count);
    frames::Bytes sent(bytes, bytes + count);
    if (on_send) on_send(sent);
    frames::Bytes reply;
    for (const std::uint8_t byte : sent) endpoint.take(byte, reply);
    if (on_reply) on_reply(reply);
    back_.insert(back_.end(), reply.begin(), reply.end());
  }
  std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    if (back_.empty()) {
      clock_ += longest;
      return 0;
    }
    std::size_t count = 0;
    for (; count < room && !back_.empty(); ++count) {
      bytes[count] = back_.front();
      back_.pop_front();
    }
    clock_ += time_of(count);
    return count;
  }
  void restart() override {
    ++restarts;
    if (gone) throw driver::LinkError("the cable is out");
    if (has_break) endpoint.connect();
    back_.clear();
  }
  std::chrono::nanoseconds time_of(std::size_t bytes) const override { return 1us * static_cast<std::int64_t>(bytes); }
  std::chrono::nanoseconds now() const override { return clock_; }
  void sleep(std::chrono::nanoseconds time) override { clock_ += time; }

  frames::Endpoint endpoint;
  std::function<void(frames::Bytes&)> on_send;
  std::function<void(frames::Bytes&)> on_reply;
  bool gone = false;
  bool has_break = true;
  unsigned restarts = 0;

 private:
  std::deque<std::uint8_t> back_;
  std::chrono::nanoseconds clock_{0};
};

// Memory of 4 KiB that logs its writes.
struct Memory {
  std::vector<std::uint32_t> words = std::vector<std::uint32_t>(1024);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> log;
  std::uint32_t refused = 0xFFC;

  frames::Endpoint::Access access() {
    return [this](bool write, std::uint32_t address, std::uint32_t data) {
      if (address == refused) return frames::Endpoint::Answer{true, 0};
      if (write) {
        words[address / 4] = data;
        log.emplace_back(address, data);
      }
      return frames::Endpoint::Answer{false, words[address / 4]};
    };
  }
};

TEST(FrameBus, OneRequestForWhatGoesTogether) {
  Memory memory;
  Link link(memory.access());
  driver::FrameBus bus(link);
  std::vector<Access> accesses;
  for (std::uint32_t i = 0; i < 100; ++i) accesses.push_back(driver::write_of(0x1C0, i));
  for (std::uint32_t i = 0; i < 3; ++i) accesses.push_back(driver::write_of(0x200 + 4 * i, i));
  accesses.push_back(driver::read_of(0x208));
  accesses.push_back(driver::read_of(0x204));
  EXPECT_EQ(bus.transfer(accesses.data(), accesses.size()), accesses.size());
  EXPECT_EQ(accesses[103].data, 2U);
  EXPECT_EQ(accesses[104].data, 1U);
  EXPECT_EQ(memory.log.size(), 103U);
  EXPECT_EQ(bus.counts().requests,
            5U);  // 59 and 41 writes to one address, 3 writes, and two reads at falling addresses
  EXPECT_EQ(bus.counts().sent_again, 0U);
  EXPECT_EQ(bus.transfer(nullptr, 0), 0U);
}

TEST(FrameBus, ARefusalStopsAtItsWord) {
  Memory memory;
  Link link(memory.access());
  driver::FrameBus bus(link);
  memory.refused = 0x208;
  std::vector<Access> accesses{driver::write_of(0x200, 1), driver::write_of(0x204, 2), driver::write_of(0x208, 3),
                               driver::write_of(0x20C, 4)};
  EXPECT_EQ(bus.transfer(accesses.data(), accesses.size()), 2U);
  EXPECT_EQ(memory.log.size(), 2U);
  memory.refused = 0xFFC;
  EXPECT_EQ(bus.transfer(accesses.data(), accesses.size()), 4U);
}

// Damages bytes in transit, as a bad link does.
void spoil(frames::Bytes& bytes, std::mt19937_64& random) {
  if (bytes.empty() || random() % 4 != 0) return;
  const auto place = static_cast<std::size_t>(random() % bytes.size());
  switch (random() % 5) {
    case 0:
      bytes.clear();
      break;
    case 1:
      bytes.resize(place);
      break;
    case 2:
      bytes[place] = static_cast<std::uint8_t>(bytes[place] ^ 1U << random() % 8);
      break;
    case 3:
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(place), static_cast<std::uint8_t>(random()));
      break;
    default:
      bytes.insert(bytes.end(), bytes.begin(), bytes.end());
  }
}

TEST(FrameBus, ABadLinkMakesEveryAccessOnce) {
  std::mt19937_64 random(5);
  Memory memory;
  Link link(memory.access());
  driver::FrameBus::Options options;
  options.sends = 6;
  options.restarts = 6;
  driver::FrameBus bus(link, options);
  link.on_send = [&](frames::Bytes& bytes) { spoil(bytes, random); };
  frames::Bytes late;
  link.on_reply = [&](frames::Bytes& bytes) {
    spoil(bytes, random);
    if (random() % 16 == 0) {
      late.swap(bytes);
      bytes.clear();
    } else if (random() % 16 == 0) {
      bytes.insert(bytes.begin(), late.begin(), late.end());
    }
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> due;
  for (unsigned i = 0; i < 80'000; ++i) {
    std::vector<Access> accesses;
    const auto count = static_cast<std::uint32_t>(1 + random() % 8);
    const auto first = static_cast<std::uint32_t>(0x200 + 4 * (random() % 128));
    const bool write = random() % 2 == 0;
    for (std::uint32_t n = 0; n < count; ++n) {
      const auto data = static_cast<std::uint32_t>(random());
      accesses.push_back({first + 4 * n, data, write});
      if (write) due.emplace_back(first + 4 * n, data);
    }
    ASSERT_EQ(bus.transfer(accesses.data(), count), count);
    for (const Access& access : accesses) ASSERT_EQ(access.data, memory.words[access.address / 4]);
  }
  EXPECT_EQ(memory.log, due);
  EXPECT_GT(bus.counts().sent_again, 20'000U);
  EXPECT_GT(bus.counts().restarts, 10U);
  EXPECT_GT(bus.counts().strange, 1'000U);
}

// The link fails at any request, before or after the card has run it. resume() reports which.
TEST(FrameBus, AfterALossItIsKnownWhatRan) {
  for (const bool ran : {false, true}) {
    for (const bool has_break : {false, true}) {
      Memory memory;
      Link link(memory.access());
      link.has_break = has_break;
      driver::FrameBus bus(link);
      std::vector<Access> accesses;
      for (std::uint32_t i = 0; i < 150; ++i) accesses.push_back(driver::write_of(0x1C0, i));
      unsigned frames_left = 1;
      const auto cut = [&](frames::Bytes& bytes) {
        if (frames_left-- != 0) return;
        link.gone = true;
        bytes.clear();
      };
      (ran ? link.on_reply : link.on_send) = cut;
      EXPECT_THROW(bus.transfer(accesses.data(), accesses.size()), driver::LinkError);
      EXPECT_THROW(bus.resume(), driver::LinkError);
      link.gone = false;
      link.on_send = nullptr;
      link.on_reply = nullptr;
      EXPECT_EQ(bus.resume(), ran ? 118U : 59U);
      EXPECT_EQ(memory.log.size(), ran ? 118U : 59U);
      EXPECT_EQ(bus.resume(), ran ? 118U : 59U);
      EXPECT_EQ(bus.transfer(accesses.data(), 1), 1U);
    }
  }
}

TEST(FrameBus, ARefusalIsFoundAfterALoss) {
  Memory memory;
  Link link(memory.access());
  driver::FrameBus bus(link);
  memory.refused = 0x208;
  std::vector<Access> accesses{driver::write_of(0x200, 1), driver::write_of(0x204, 2), driver::write_of(0x208, 3)};
  link.on_reply = [&](frames::Bytes& bytes) {
    link.gone = true;
    bytes.clear();
  };
  EXPECT_THROW(bus.transfer(accesses.data(), accesses.size()), driver::LinkError);
  link.gone = false;
  link.on_reply = nullptr;
  EXPECT_EQ(bus.resume(), 2U);
}

TEST(FrameBus, ACardThatWasResetIsToldFromOneThatWasNot) {
  Memory memory;
  Link link(memory.access());
  driver::FrameBus bus(link);
  Access access = driver::write_of(0x200, 1);
  bus.transfer(&access, 1);
  link.on_send = [&](frames::Bytes&) {
    link.endpoint = frames::Endpoint(memory.access());
    link.on_send = nullptr;
  };
  try {
    bus.transfer(&access, 1);
    FAIL() << "a request to a card that had been reset was reported as made";
  } catch (const driver::LinkError& error) {
    EXPECT_NE(std::string(error.what()).find("reset"), std::string::npos) << error.what();
  }
  EXPECT_THROW(bus.resume(), driver::LinkError);
  EXPECT_EQ(bus.transfer(&access, 1), 1U);
  EXPECT_EQ(memory.log.size(), 2U);
}

TEST(FrameBus, NoCardIsALinkError) {
  Memory memory;
  Link link(memory.access());
  link.on_reply = [](frames::Bytes& bytes) { bytes.clear(); };
  EXPECT_THROW(driver::FrameBus bus(link), driver::LinkError);
  link.on_reply = nullptr;
  // An echo of the host's own frames is not taken for a card.
  link.on_send = [](frames::Bytes&) {};
  Link echo([](bool, std::uint32_t, std::uint32_t) { return frames::Endpoint::Answer{}; });
  frames::Bytes last;
  echo.on_send = [&](frames::Bytes& bytes) { last = bytes; };
  echo.on_reply = [&](frames::Bytes& bytes) { bytes = last; };
  EXPECT_THROW(driver::FrameBus bus(echo), driver::LinkError);
}

// Request numbers wrap. Nothing is lost, and the epoch changes before a number comes again.
TEST(FrameBus, NumbersComeRound) {
  Memory memory;
  Link link(memory.access());
  driver::FrameBus bus(link);
  Access access = driver::write_of(0x200, 1);
  for (unsigned i = 0; i < 140'000; ++i) ASSERT_EQ(bus.transfer(&access, 1), 1U);
  EXPECT_EQ(memory.log.size(), 140'000U);
  EXPECT_EQ(bus.counts().restarts, 3U);
  EXPECT_EQ(bus.counts().sent_again, 0U);
}

// set_patience() limits the wait for a silent card. After this time the card counts as lost, and further requests fail
// at once until it answers.
TEST(FrameBus, PatienceEndsBeforeAllTries) {
  Memory memory;
  Link link(memory.access());
  driver::FrameBus::Options options;
  options.answer = 20s;
  driver::FrameBus bus(link, options);
  bus.set_patience(6s);
  bool silent = true;
  link.on_reply = [&silent](frames::Bytes& reply) {
    if (silent) reply.clear();
  };
  const auto ask = [&] {
    const auto begun = link.now();
    Access access = driver::write_of(0x200, 7);
    try {
      bus.transfer(&access, 1);
    } catch (const driver::LinkError& error) {
      EXPECT_EQ(std::string(error.what()).find("no "), 0U) << error.what();
    }
    return std::chrono::duration<double>(link.now() - begun).count();
  };
  const double first = ask();
  EXPECT_TRUE(first > 6 && first < 7) << first;
  EXPECT_TRUE(bus.lost());
  const double again = ask();
  EXPECT_LT(again, 1.5);
  silent = false;
  ask();
  EXPECT_FALSE(bus.lost());
  EXPECT_EQ(memory.words[0x200 / 4], 7U);
  // If an answer may not take longer than the patience, all tries are made.
  silent = true;
  bus.set_patience(30s);
  const auto begun = link.now();
  Access access = driver::read_of(0x200);
  EXPECT_THROW(bus.transfer(&access, 1), driver::LinkError);
  EXPECT_GT(link.now() - begun, 4 * 20s);
}

}  // namespace
