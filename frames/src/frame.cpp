#include "trammel/frames/frame.hpp"

#include <stdexcept>

namespace trammel::frames {

namespace {

constexpr std::uint8_t kKindMask = 0x03;
constexpr std::uint8_t kFixed = 0x10;
constexpr std::uint8_t kReply = 0x80;
constexpr std::uint8_t kData = 0x20;
constexpr std::uint8_t kResultMask = 0x07;
constexpr std::uint16_t kAddressMask = 0xFFC;

void put(Bytes& bytes, std::uint32_t value, unsigned count) {
  for (unsigned i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

std::uint32_t get(const Bytes& bytes, std::size_t place, unsigned count) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < count; ++i) value |= std::uint32_t{bytes[place + i]} << (8 * i);
  return value;
}

std::uint16_t get16(const Bytes& bytes, std::size_t place) { return static_cast<std::uint16_t>(get(bytes, place, 2)); }

bool legal(std::uint8_t first, std::uint8_t count, std::uint16_t address) {
  const auto kind = static_cast<Kind>(first & kKindMask);
  const bool moves = kind == Kind::Read || kind == Kind::Write;
  if ((first & ~(kKindMask | kFixed)) != 0 || (address & ~kAddressMask) != 0) return false;
  return moves ? count >= 1 && count <= kMaxWords : count == 0;
}

}  // namespace

bool Request::operator==(const Request& o) const {
  return kind == o.kind && fixed == o.fixed && count == o.count && number == o.number && epoch == o.epoch &&
         address == o.address && data == o.data;
}

bool Reply::operator==(const Reply& o) const {
  return result == o.result && made == o.made && number == o.number && last == o.last && epoch == o.epoch &&
         state.words == o.state.words && has_data == o.has_data && data == o.data;
}

void append_request(Bytes& stream, const Request& request) {
  const auto first = static_cast<std::uint8_t>(static_cast<unsigned>(request.kind) | (request.fixed ? kFixed : 0U));
  const std::size_t words = request.kind == Kind::Write ? request.count : 0U;
  if (!legal(first, request.count, request.address) || request.data.size() != words) {
    throw std::invalid_argument("frame: no such request");
  }
  Bytes body{first, request.count};
  put(body, request.number, 2);
  put(body, request.epoch, 2);
  put(body, request.address, 2);
  for (const std::uint32_t word : request.data) put(body, word, 4);
  append_frame(stream, body);
}

void append_reply(Bytes& stream, const Reply& reply) {
  if (reply.made > kMaxWords || reply.data.size() != (reply.has_data ? reply.made : 0U)) {
    throw std::invalid_argument("frame: no such reply");
  }
  Bytes body{static_cast<std::uint8_t>(kReply | (reply.has_data ? kData : 0U) | static_cast<unsigned>(reply.result)),
             reply.made};
  put(body, reply.number, 2);
  put(body, reply.last, 2);
  put(body, reply.epoch, 2);
  for (const std::uint32_t word : reply.state.words) put(body, word, 4);
  for (const std::uint32_t word : reply.data) put(body, word, 4);
  append_frame(stream, body);
}

std::optional<ReceivedRequest> parse_request(const Bytes& body) {
  if (body.size() < kHeaderBytes) return std::nullopt;
  ReceivedRequest received;
  Request& request = received.request;
  request.kind = static_cast<Kind>(body[0] & kKindMask);
  request.fixed = (body[0] & kFixed) != 0;
  request.count = body[1];
  request.number = get16(body, 2);
  request.epoch = get16(body, 4);
  request.address = get16(body, 6);
  const std::size_t words = request.kind == Kind::Write ? request.count : 0U;
  if (body.size() != kHeaderBytes + 4 * words) return std::nullopt;
  for (std::size_t i = 0; i < words; ++i) request.data.push_back(get(body, kHeaderBytes + 4 * i, 4));
  received.malformed = !legal(body[0], request.count, request.address);
  return received;
}

std::optional<Reply> parse_reply(const Bytes& body) {
  constexpr std::size_t kFirstData = kHeaderBytes + 4 * kStateWords;
  if (body.size() < kFirstData) return std::nullopt;
  const std::uint8_t result = body[0] & kResultMask;
  const bool known = (body[0] & ~(kReply | kData | kResultMask)) == 0 && (body[0] & kReply) != 0;
  if (!known || result > static_cast<std::uint8_t>(Result::Malformed)) return std::nullopt;
  Reply reply;
  reply.result = static_cast<Result>(result);
  reply.has_data = (body[0] & kData) != 0;
  reply.made = body[1];
  reply.number = get16(body, 2);
  reply.last = get16(body, 4);
  reply.epoch = get16(body, 6);
  const std::size_t words = reply.has_data ? reply.made : 0U;
  if (reply.made > kMaxWords || body.size() != kFirstData + 4 * words) return std::nullopt;
  for (std::size_t i = 0; i < kStateWords; ++i) reply.state.words[i] = get(body, kHeaderBytes + 4 * i, 4);
  for (std::size_t i = 0; i < words; ++i) reply.data.push_back(get(body, kFirstData + 4 * i, 4));
  return reply;
}

}  // namespace trammel::frames
