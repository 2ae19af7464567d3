// FrameBus and replies that are whole frames, but not replies of a working card to this request. FrameBus ignores each
// of them and reports the result of the request.
#include <gmock/gmock.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "error_message.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/driver/interrupt.hpp"
#include "trammel/frames/endpoint.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using frames::Reply;
using frames::Result;
using ::testing::HasSubstr;

// An in-memory link to a card with a memory. A test may change or drop its replies.
class ReplyLink final : public ByteLink {
 public:
  void send(const std::uint8_t* bytes, std::size_t count) override {
    frames::Bytes reply;
    for (std::size_t i = 0; i < count; ++i) endpoint.take(bytes[i], reply);
    frames::Deframer deframer{frames::kMaxReplyBody};
    for (const std::uint8_t byte : reply) {
      if (!deframer.take(byte)) continue;
      std::optional<Reply> whole = frames::parse_reply(deframer.body());
      if (!whole) continue;
      if (on_reply && !on_reply(*whole)) continue;
      frames::Bytes again;
      frames::append_reply(again, *whole);
      back_.insert(back_.end(), again.begin(), again.end());
    }
  }
  std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    const std::size_t count = std::min(room, back_.size());
    if (count == 0) {
      if (interrupting) throw InterruptedError("the program ends");
      clock_ += longest;
    }
    std::copy_n(back_.begin(), count, bytes);
    back_.erase(back_.begin(), back_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  void restart() override {
    back_.clear();
    endpoint.connect();
  }
  std::chrono::nanoseconds time_of(std::size_t) const override { return {}; }
  std::chrono::nanoseconds now() const override { return clock_; }
  void sleep(std::chrono::nanoseconds time) override { clock_ += time; }

  std::vector<std::uint32_t> written;
  frames::Endpoint endpoint{[this](bool write, std::uint32_t, std::uint32_t data) {
    if (write) written.push_back(data);
    return frames::Endpoint::Answer{false, 0x1234};
  }};
  std::function<bool(Reply&)> on_reply;  // false: the reply is lost
  bool interrupting = false;

 private:
  std::deque<std::uint8_t> back_;
  std::chrono::nanoseconds clock_{0};
};

// True for replies to reads and writes; other replies belong to the connection.
bool of_an_access(const Reply& reply) { return reply.made != 0 || reply.has_data; }

class FrameReplies : public ::testing::Test {
 protected:
  FrameReplies() { options_.sends = 2; }
  void connect() { bus_.emplace(link_, options_); }
  std::string write() {
    Access access = write_of(0x200, 7);
    return message_of<LinkError>([&] { bus_->transfer(&access, 1); });
  }

  ReplyLink link_;
  FrameBus::Options options_;
  std::optional<FrameBus> bus_;
};

TEST_F(FrameReplies, ACardThatConnectsButMakesNoAccess) {
  connect();
  link_.on_reply = [](Reply& reply) { return !of_an_access(reply); };
  EXPECT_EQ(write(), "no answer to a request, sent 2 times on each of 4 connections");
  EXPECT_TRUE(bus_->lost());
  EXPECT_EQ(link_.written.size(), 1U) << "run once";
  EXPECT_EQ(message_of<LinkError>([&] { bus_->resume(); }), "the card connects, but does not answer");
  link_.on_reply = nullptr;
  EXPECT_EQ(bus_->resume(), 1U);
  EXPECT_EQ(write(), "");
  EXPECT_EQ(link_.written.size(), 2U);
}

TEST_F(FrameReplies, FewerWordsThanAskedForWithoutARefusal) {
  connect();
  link_.on_reply = [](Reply& reply) {
    if (of_an_access(reply)) reply.made = 1;
    return true;
  };
  std::vector<Access> accesses{write_of(0x200, 1), write_of(0x204, 2)};
  EXPECT_EQ(message_of<LinkError>([&] { bus_->transfer(accesses.data(), accesses.size()); }),
            "the card made 1 of 2 accesses and refused none");
}

// Replies with a wrong epoch, with data after a write, or with a wrong number are ignored.
TEST_F(FrameReplies, AnotherShapeIsPassedOver) {
  const std::function<void(Reply&)> changes[] = {
      [](Reply& reply) { reply.epoch = static_cast<std::uint16_t>(reply.epoch + 1); },
      [](Reply& reply) {
        reply.has_data = true;
        reply.data = {1};
      },
      [](Reply& reply) { reply.number = static_cast<std::uint16_t>(reply.number + 1); }};
  for (const auto& change : changes) {
    connect();
    int changed = 0;
    link_.on_reply = [&](Reply& reply) {
      if (of_an_access(reply) && ++changed == 1) change(reply);
      return true;
    };
    const std::uint64_t strange = bus_->counts().strange;
    EXPECT_EQ(write(), "");
    EXPECT_EQ(bus_->counts().strange, strange + 1);
    EXPECT_EQ(bus_->counts().sent_again, 1U);
    EXPECT_EQ(changed, 2) << "the card has kept its reply";
    link_.on_reply = nullptr;
  }
  EXPECT_EQ(link_.written.size(), 3U);
}

TEST_F(FrameReplies, AReplyToAConnectionTellsOfNoAccesses) {
  const std::function<void(Reply&)> changes[] = {[](Reply& reply) { reply.made = 1; },
                                                 [](Reply& reply) { reply.has_data = true; },
                                                 [](Reply& reply) { reply.result = Result::Refused; }};
  for (const auto& change : changes) {
    int changed = 0;
    link_.on_reply = [&](Reply& reply) {
      if (++changed == 1) change(reply);
      return true;
    };
    connect();
    EXPECT_EQ(bus_->counts().strange, 1U);
    EXPECT_EQ(write(), "");
  }
}

// Another program has used the card in the meantime, so its last number is higher.
TEST_F(FrameReplies, ACardThatOthersHaveUsedIsToldFromOneThatHasRunTheRequest) {
  connect();
  ASSERT_EQ(write(), "");
  bool away = true;
  link_.on_reply = [&](Reply& reply) {
    if (of_an_access(reply) && away) return false;
    reply.last = static_cast<std::uint16_t>(reply.last + 5);
    return true;
  };
  EXPECT_THAT(write(), HasSubstr("the card was reset, or used by somebody else"));
  EXPECT_THAT(message_of<LinkError>([&] { bus_->resume(); }), HasSubstr("used by somebody else"));
}

TEST_F(FrameReplies, OpensAtOnceOrNotAtAll) {
  options_.opens_at_once = true;
  options_.answer = 30ms;
  unsigned asked = 0;
  link_.on_reply = [&](Reply&) { return ++asked == 0; };
  EXPECT_EQ(message_of<LinkError>([&] { connect(); }), "no card answers within 30 ms");
  EXPECT_EQ(asked, 1U);
  link_.on_reply = nullptr;
  connect();
  // The option does not reduce the number of tries of a request.
  unsigned lost = 0;
  link_.on_reply = [&](Reply& reply) { return !of_an_access(reply) || ++lost > 3; };
  EXPECT_EQ(write(), "");
  EXPECT_EQ(lost, 4U);
}

// An interrupt by the caller is not treated as a silent card: it passes through every call.
TEST_F(FrameReplies, AnInterruptPassesThrough) {
  connect();
  link_.on_reply = [](Reply& reply) { return !of_an_access(reply); };
  link_.interrupting = true;
  Access access = write_of(0x200, 7);
  EXPECT_EQ(message_of<InterruptedError>([&] { bus_->transfer(&access, 1); }), "the program ends");
  EXPECT_EQ(message_of<InterruptedError>([&] { bus_->resume(); }), "the program ends");
  link_.interrupting = false;
  link_.on_reply = nullptr;
  EXPECT_EQ(bus_->resume(), 1U);
  // It also passes through a new connection.
  link_.on_reply = [&](Reply& reply) {
    link_.interrupting = !of_an_access(reply);
    return false;
  };
  EXPECT_EQ(message_of<InterruptedError>([&] { bus_->transfer(&access, 1); }), "the program ends");
  link_.interrupting = false;
  link_.on_reply = nullptr;
  EXPECT_EQ(bus_->resume(), 1U);
  EXPECT_EQ(link_.written.size(), 2U);
}

}  // namespace
}  // namespace trammel::driver
