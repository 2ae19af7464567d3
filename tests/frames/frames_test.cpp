// Codec, session and endpoint without damage, and the test vectors of the page.
#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "trammel/card_map.hpp"
#include "trammel/frames/endpoint.hpp"

namespace {

using namespace trammel::frames;

Bytes text_bytes(const std::string& text) { return Bytes(text.begin(), text.end()); }

TEST(Crc32, CheckValueAndResidue) {
  const Bytes digits = text_bytes("123456789");
  EXPECT_EQ(crc32(digits.data(), digits.size()), 0xCBF43926U);
  Crc32 crc;
  for (const std::uint8_t byte : digits) crc.add(byte);
  for (unsigned i = 0; i < 4; ++i) crc.add(static_cast<std::uint8_t>(0xCBF43926U >> (8 * i)));
  EXPECT_TRUE(crc.whole());
}

// Every error of up to four bits in a frame of the longest reply must change the final value of the register. The
// effect of an error does not depend on the data. It is therefore enough that the effects of no four bits cancel, which
// is checked with pairs.
TEST(Crc32, FourWrongBitsAreSeenInTheLongestFrames) {
  const std::size_t bits = 8 * (kMaxReplyBody + kCrcBytes);
  // The effect of one bit, indexed by its distance from the end in bits.
  std::vector<std::uint32_t> effect{1};
  for (std::size_t i = 1; i < bits; ++i) {
    effect.push_back(effect.back() >> 1 ^ ((effect.back() & 1) != 0 ? 0xEDB88320U : 0));
  }
  std::vector<std::uint32_t> pairs;
  for (std::size_t i = 0; i < bits; ++i) {
    ASSERT_NE(effect[i], 0U);
    for (std::size_t j = 0; j < i; ++j) pairs.push_back(effect[i] ^ effect[j]);
  }
  // Three bits would be a pair with the effect of one bit. Four bits would be two equal pairs; two pairs with a bit in
  // common are two wrong bits.
  std::sort(pairs.begin(), pairs.end());
  EXPECT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end());
  EXPECT_NE(pairs.front(), 0U);
  for (const std::uint32_t one : effect) ASSERT_FALSE(std::binary_search(pairs.begin(), pairs.end(), one));
  EXPECT_EQ(pairs.size(), bits * (bits - 1) / 2);
}

TEST(Stuffing, AnyBytesComeBack) {
  std::mt19937_64 random(1);
  Deframer deframer(300);
  for (int i = 0; i < 20000; ++i) {
    Bytes body(1 + random() % 300);
    for (std::uint8_t& byte : body) {
      byte = static_cast<std::uint8_t>(random() % 3 == 0 ? kEnd + 27 * (random() % 2) : random());
    }
    Bytes stream;
    append_frame(stream, body);
    ASSERT_EQ(std::count(stream.begin(), stream.end(), kEnd), 1);
    for (std::size_t n = 0; n < stream.size(); ++n) ASSERT_EQ(deframer.take(stream[n]), n + 1 == stream.size());
    ASSERT_EQ(deframer.body(), body);
  }
  EXPECT_EQ(deframer.dropped(), 0U);
}

TEST(Stuffing, TooLongOrBadlyEscapedIsDropped) {
  Deframer deframer(8);
  Bytes stream;
  append_frame(stream, Bytes(9, 1));
  append_frame(stream, Bytes(8, 1));
  stream.insert(stream.end(), {kEscape, 1, kEnd, kEscape, kEnd, kEnd, kEnd});
  append_frame(stream, Bytes(8, 2));
  unsigned whole = 0;
  for (const std::uint8_t byte : stream) whole += deframer.take(byte) ? 1U : 0U;
  EXPECT_EQ(whole, 2U);
  EXPECT_EQ(deframer.dropped(), 3U);
  EXPECT_EQ(deframer.body(), Bytes(8, 2));
}

Request write_request(std::uint16_t number, std::uint16_t epoch, std::vector<std::uint32_t> data) {
  Request r;
  r.kind = Kind::Write;
  r.count = static_cast<std::uint8_t>(data.size());
  r.number = number;
  r.epoch = epoch;
  r.address = 0x184;
  r.data = std::move(data);
  return r;
}

TEST(Frames, ImpossibleRequestsAreNotMade) {
  Bytes stream;
  Request r = write_request(1, 1, {});
  EXPECT_THROW(append_request(stream, r), std::invalid_argument);
  r = write_request(1, 1, std::vector<std::uint32_t>(kMaxWords + 1));
  EXPECT_THROW(append_request(stream, r), std::invalid_argument);
  r = write_request(1, 1, {1});
  r.address = 0x186;
  EXPECT_THROW(append_request(stream, r), std::invalid_argument);
  r.address = 0x1000;
  EXPECT_THROW(append_request(stream, r), std::invalid_argument);
  EXPECT_TRUE(stream.empty());
}

// A card of plain memory that refuses one address.
class Bench {
 public:
  std::optional<Reply> send(const Request& request) {
    Bytes stream;
    append_request(stream, request);
    return bytes(stream);
  }
  std::optional<Reply> bytes(const Bytes& stream) {
    Bytes out;
    for (const std::uint8_t byte : stream) endpoint.take(byte, out);
    std::optional<Reply> reply;
    unsigned replies = 0;
    Deframer deframer(kMaxReplyBody);
    for (const std::uint8_t byte : out) {
      if (!deframer.take(byte)) continue;
      reply = parse_reply(deframer.body());
      EXPECT_TRUE(reply.has_value());
      ++replies;
    }
    EXPECT_LE(replies, 1U);
    return reply;
  }
  std::uint16_t connect() {
    Request request;
    request.kind = Kind::Connect;
    request.epoch = endpoint.session().epoch();
    const std::optional<Reply> reply = send(request);
    EXPECT_TRUE(reply && reply->result == Result::Done);
    return reply->epoch;
  }

  std::vector<std::uint32_t> memory = std::vector<std::uint32_t>(1024);
  std::uint32_t refused = 0xFFC;
  std::uint64_t writes = 0;
  Endpoint endpoint{[this](bool write, std::uint32_t address, std::uint32_t data) {
    if (address == refused) return Endpoint::Answer{true, 0};
    if (write) {
      memory[address / 4] = data;
      ++writes;
    }
    return Endpoint::Answer{false, memory[address / 4]};
  }};
};

TEST(Endpoint, RunsANumberOnceAndRepliesAgain) {
  Bench bench;
  const std::uint16_t epoch = bench.connect();
  EXPECT_EQ(epoch, 1);
  const Request request = write_request(1, epoch, {10, 11, 12});
  for (int i = 0; i < 3; ++i) {
    const std::optional<Reply> reply = bench.send(request);
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->result, Result::Done);
    EXPECT_EQ(reply->made, 3);
    EXPECT_EQ(reply->last, 1);
  }
  EXPECT_EQ(bench.writes, 3U);
  EXPECT_EQ(bench.memory[0x188 / 4], 11U);
  EXPECT_EQ(bench.send(write_request(3, epoch, {1}))->result, Result::WrongNumber);
  EXPECT_EQ(bench.send(write_request(0, epoch, {1}))->result, Result::WrongNumber);
  EXPECT_EQ(bench.send(write_request(2, 0, {1}))->result, Result::WrongEpoch);
  EXPECT_EQ(bench.writes, 3U);
}

TEST(Endpoint, ARefusalEndsItAndIsNamed) {
  Bench bench;
  bench.refused = 0x18C;
  const std::uint16_t epoch = bench.connect();
  for (int i = 0; i < 2; ++i) {
    const std::optional<Reply> reply = bench.send(write_request(1, epoch, {1, 2, 3, 4}));
    EXPECT_EQ(reply->result, Result::Refused);
    EXPECT_EQ(reply->made, 2);
    EXPECT_EQ(reply->last, 1);
  }
  EXPECT_EQ(bench.writes, 2U);
  EXPECT_EQ(bench.send(write_request(2, epoch, {1, 2}))->result, Result::Done);
}

TEST(Endpoint, WhatWasReadIsKeptForARepeat) {
  Bench bench;
  const std::uint16_t epoch = bench.connect();
  Request request;
  request.kind = Kind::Read;
  request.count = 2;
  request.address = 0x200;
  request.number = 1;
  request.epoch = epoch;
  bench.memory[0x200 / 4] = 7;
  bench.memory[0x040 / 4] = 1;
  EXPECT_EQ(bench.send(request)->data, (std::vector<std::uint32_t>{7, 0}));
  bench.memory[0x200 / 4] = 8;
  bench.memory[0x040 / 4] = 2;
  const std::optional<Reply> again = bench.send(request);
  EXPECT_EQ(again->data, (std::vector<std::uint32_t>{7, 0}));
  EXPECT_EQ(again->state.status(), 2U);  // the state is the present one
}

TEST(Endpoint, AConnectionRunsNothingOfTheOneBefore) {
  Bench bench;
  const std::uint16_t first = bench.connect();
  EXPECT_EQ(bench.send(write_request(1, first, {1}))->result, Result::Done);
  bench.endpoint.connect();
  const std::optional<Reply> reply = bench.send(write_request(2, first, {1}));
  EXPECT_EQ(reply->result, Result::WrongEpoch);
  EXPECT_EQ(reply->epoch, first + 1);
  EXPECT_EQ(reply->last, 1);
  // The new connection can still get the reply to the last executed request.
  EXPECT_EQ(bench.send(write_request(1, static_cast<std::uint16_t>(first + 1), {9}))->made, 1);
  EXPECT_EQ(bench.writes, 1U);
}

TEST(Endpoint, MalformedRequestsAreToldAndDoNothing) {
  Bench bench;
  const std::uint16_t epoch = bench.connect();
  const auto low = static_cast<std::uint8_t>(epoch);
  const Bytes bodies[] = {
      {0x23, 1, 1, 0, low, 0, 0x84, 1, 1, 2, 3, 4},  // an unknown bit
      {0x02, 0, 1, 0, low, 0, 0x84, 1},              // no words
      {0x02, kMaxWords + 1, 1, 0, low, 0, 0x84, 1},  // more words than a reply holds
      {0x02, 1, 1, 0, low, 0, 0x85, 1},              // not the address of a word
      {0x02, 1, 1, 0, low, 0, 0x84, 0x11},           // outside the window
      {0x00, 1, 1, 0, low, 0, 0, 0},                 // a question with words
      {0x03, 0, 1, 0, low, 0, 0x84, 1},
  };
  for (const Bytes& body : bodies) {
    Bytes stream;
    append_frame(stream, body);
    const std::optional<Reply> reply = bench.bytes(stream);
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->result, Result::Malformed);
    EXPECT_EQ(reply->number, 1);
    EXPECT_EQ(reply->last, 0);
  }
  // A frame whose length does not fit its count is ignored.
  for (const Bytes& body : {Bytes{3, 2, 1, 0, low, 0, 0x84, 1, 1, 2, 3, 4}, Bytes{0, 0, 0, 0, 0, 0, 0}, Bytes{0}}) {
    Bytes stream;
    append_frame(stream, body);
    EXPECT_FALSE(bench.bytes(stream));
  }
  EXPECT_EQ(bench.writes, 0U);
}

// Test vectors on the page: table rows `| what | bytes in hexadecimal |`, which one card gets in order.
TEST(FramesPage, VectorsAreWhatACardSays) {
  std::ifstream page(TRAMMEL_FRAMES_PAGE);
  ASSERT_TRUE(page);
  Endpoint endpoint([](bool, std::uint32_t address, std::uint32_t) {
    if (address == 0x040) return Endpoint::Answer{false, 0x00000001};
    if (address == 0x04C) return Endpoint::Answer{false, 4096};
    if (address == 0x050) return Endpoint::Answer{false, 2560};
    if (address == 0x000) return Endpoint::Answer{false, trammel::card_map::kMagicValue};
    if (address == 0x044 || address == 0x048) return Endpoint::Answer{};
    return Endpoint::Answer{address == 0x188, address};
  });
  Bytes said;
  unsigned requests = 0;
  unsigned replies = 0;
  for (std::string line; std::getline(page, line);) {
    const bool request = line.rfind("| request:", 0) == 0;
    const bool reply = line.rfind("| reply:", 0) == 0;
    if (!request && !reply) continue;
    const std::size_t first = line.find('`') + 1;
    std::istringstream cells(line.substr(first, line.rfind('`') - first));
    Bytes bytes;
    for (std::string cell; cells >> cell;) bytes.push_back(static_cast<std::uint8_t>(std::stoul(cell, nullptr, 16)));
    if (request) {
      said.clear();
      ++requests;
      for (const std::uint8_t byte : bytes) endpoint.take(byte, said);
    } else {
      ++replies;
      std::ostringstream hex;
      for (const std::uint8_t byte : said) hex << fmt::format("{:02X} ", byte);
      EXPECT_EQ(said, bytes) << line << "\nthe card says: " << hex.str();
    }
  }
  EXPECT_EQ(requests, 8U);
  EXPECT_EQ(replies, 8U);
}

}  // namespace
