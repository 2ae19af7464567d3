// The model of the frame engine: its replies equal those of the endpoint, in the documented clocks.
#include "trammel/model/frame_engine.hpp"

#include <gtest/gtest.h>

#include <random>

#include "trammel/frames/endpoint.hpp"

namespace {

using namespace trammel::frames;
using trammel::model::FrameEngine;

// An inner port that answers a request after 4 clocks with its address, and refuses the last address.
class EngineBench {
 public:
  Bytes bring(const Bytes& bytes, unsigned gap = 10) {
    Bytes reply;
    requests.clear();
    offers.clear();
    for (clock_ = 0; clock_ < gap * bytes.size() + 4000; ++clock_) {
      FrameEngine::Inputs in;
      const bool comes = clock_ % gap == 0 && clock_ / gap < bytes.size();
      in.byte_valid = comes;
      if (comes) {
        in.byte = bytes[clock_ / gap];
        last_byte = clock_;
      }
      const FrameEngine::Outputs& out = engine.outputs();
      if (out.request) {
        requests.push_back(clock_);
        if (out.write) written.push_back(out.data);
        address_ = out.address;
        answer_ = clock_ + 4;
      }
      in.ack = !requests.empty() && clock_ == answer_;
      in.error = address_ == 0xFFC;
      in.data = in.error ? 0 : address_;
      in.ready = true;
      if (out.valid) {
        offers.push_back(clock_);
        reply.push_back(out.byte);
      }
      engine.clock(in);
    }
    return reply;
  }

  FrameEngine engine;
  std::vector<std::uint64_t> requests;  // clocks
  std::vector<std::uint64_t> offers;
  std::vector<std::uint32_t> written;
  std::uint64_t last_byte = 0;

 private:
  std::uint64_t clock_ = 0;
  std::uint64_t answer_ = 0;
  std::uint32_t address_ = 0;
};

Bytes stream_of(const Request& request) {
  Bytes stream;
  append_request(stream, request);
  return stream;
}

TEST(FrameEngine, RepliesAsTheEndpoint) {
  std::mt19937_64 random(1);
  EngineBench bench;
  Endpoint endpoint([](bool, std::uint32_t address, std::uint32_t) {
    return Endpoint::Answer{address == 0xFFC, address == 0xFFC ? 0 : address};
  });
  unsigned replies = 0;
  for (int i = 0; i < 600; ++i) {
    Request r;
    r.kind = static_cast<Kind>(random() % 4);
    r.fixed = random() % 2 == 0;
    const bool moves = r.kind == Kind::Read || r.kind == Kind::Write;
    r.count = static_cast<std::uint8_t>(moves ? 1 + random() % 10 : 0);
    r.address = static_cast<std::uint16_t>(4 * (random() % 3 == 0 ? 1018 + random() % 6 : random() % 1024));
    r.number = static_cast<std::uint16_t>(endpoint.session().last() + random() % 3);
    r.epoch = static_cast<std::uint16_t>(endpoint.session().epoch() + (random() % 8 == 0 ? 1U : 0U));
    for (unsigned n = 0; r.kind == Kind::Write && n < r.count; ++n)
      r.data.push_back(static_cast<std::uint32_t>(random()));
    Bytes stream = stream_of(r);
    if (random() % 8 == 0) stream[random() % stream.size()] ^= 4;
    Bytes due;
    for (const std::uint8_t byte : stream) endpoint.take(byte, due);
    ASSERT_EQ(bench.bring(stream), due) << i;
    replies += due.empty() ? 0U : 1U;
  }
  EXPECT_GT(replies, 400U);
}

// The documented clocks, counted from the END byte at c.
TEST(FrameEngine, Clocks) {
  EngineBench bench;
  Request r;
  bench.bring(stream_of(r));
  const std::uint64_t asked = bench.last_byte;
  ASSERT_EQ(bench.requests.size(), kStateWords);
  for (std::size_t i = 0; i < kStateWords; ++i) EXPECT_EQ(bench.requests[i] - asked, 2 + 10 * i);
  // The last answer comes at c+46.
  EXPECT_EQ(bench.offers.front() - asked, 46U + 5 + 12);
  for (std::size_t i = 1; i < bench.offers.size(); ++i) EXPECT_EQ(bench.offers[i] - bench.offers[i - 1], 12U);

  r.kind = Kind::Write;
  r.count = 2;
  r.number = 1;
  r.data = {7, 8};
  bench.bring(stream_of(r));
  EXPECT_EQ(bench.written, r.data);
  EXPECT_EQ(bench.requests[0] - bench.last_byte, 7U);
  EXPECT_EQ(bench.requests[1] - bench.requests[0], 4U + 7);
  EXPECT_EQ(bench.requests[2] - bench.requests[1], 4U + 2);
}

// Bytes that arrive during a reply are lost, including a frame that begins then; the next frame is accepted.
TEST(FrameEngine, WhatComesWhileItAnswersIsPassedOver) {
  EngineBench bench;
  Request first;
  first.kind = Kind::Write;
  first.count = 1;
  first.number = 1;
  first.data = {7};
  Request second = first;
  second.number = 2;
  second.data = {8};
  Endpoint endpoint([](bool, std::uint32_t address, std::uint32_t) { return Endpoint::Answer{false, address}; });
  Bytes due;
  for (const std::uint8_t byte : stream_of(first)) endpoint.take(byte, due);
  Bytes both = stream_of(first);
  for (const std::uint8_t byte : stream_of(second)) both.push_back(byte);
  EXPECT_EQ(bench.bring(both, 1), due);
  EXPECT_EQ(bench.written, first.data);
  // The first bytes of this frame arrive during the reply and the rest after it; it is not accepted.
  const Bytes stream = stream_of(second);
  bench.written.clear();
  Bytes begun = stream_of(Request{});
  begun.insert(begun.end(), stream.begin(), stream.begin() + 5);
  bench.bring(begun, 1);
  EXPECT_TRUE(bench.bring(Bytes(stream.begin() + 5, stream.end())).empty());
  EXPECT_TRUE(bench.written.empty());
  EXPECT_FALSE(bench.bring(stream).empty());
  EXPECT_EQ(bench.written, second.data);
}

// The port takes a byte now and then. After a new connection in any clock, no further byte of the reply is offered.
TEST(FrameEngine, ANewConnectionEndsTheReplyInAnyClock) {
  const Bytes stream = stream_of(Request{});
  unsigned begun = 0;
  for (unsigned when = 1; when < 300; ++when) {
    FrameEngine engine;
    unsigned offered = 0;
    for (unsigned clock = 0; clock < 1500; ++clock) {
      FrameEngine::Inputs in;
      in.byte_valid = clock < stream.size();
      if (in.byte_valid) in.byte = stream[clock];
      in.restart = clock == stream.size() + when;
      in.ack = clock % 5 == 0;
      in.ready = clock % 11 == 0;
      const bool offers = engine.outputs().valid;
      if (clock <= stream.size() + when)
        offered += offers ? 1U : 0U;
      else
        ASSERT_FALSE(offers) << when << ' ' << clock;
      engine.clock(in);
    }
    begun += offered != 0 ? 1U : 0U;
    EXPECT_TRUE(engine.listening()) << when;
    EXPECT_EQ(engine.session().epoch(), 1) << when;
  }
  EXPECT_GT(begun, 150U) << "replies that had begun";
}

TEST(FrameEngine, ANewConnectionDropsTheReply) {
  for (const unsigned when : {1U, 8U, 30U, 60U, 200U}) {
    FrameEngine engine;
    Request r;
    r.kind = Kind::Write;
    r.count = 1;
    r.number = 1;
    r.data = {1};
    const Bytes stream = stream_of(r);
    unsigned ends = 0;
    unsigned writes = 0;
    for (unsigned clock = 0; clock < 2000; ++clock) {
      FrameEngine::Inputs in;
      in.byte_valid = clock % 10 == 0 && clock / 10 < stream.size();
      if (in.byte_valid) in.byte = stream[clock / 10];
      in.restart = clock == 10 * (stream.size() - 1) + when;
      in.ack = clock % 5 == 0;
      in.ready = true;
      ends += engine.outputs().valid && engine.outputs().byte == kEnd ? 1U : 0U;
      writes += engine.outputs().request && engine.outputs().write ? 1U : 0U;
      engine.clock(in);
    }
    EXPECT_EQ(ends, 0U) << when;
    EXPECT_EQ(writes, when == 1 ? 0U : 1U) << when;  // a restart in the clock of the decision takes precedence
    EXPECT_EQ(engine.session().epoch(), 1);
    EXPECT_EQ(engine.session().last(), when == 1 ? 0 : 1);
    EXPECT_TRUE(engine.listening());
  }
}

}  // namespace
