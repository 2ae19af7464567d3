// Requests and replies between a host and a card over a stream of bytes: docs/reference/frames.md. Plain values;
// functions throw only where their comment says so.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "trammel/frames/stuffing.hpp"

namespace trammel::frames {

// Data and state of a reply fill the 256 bytes that the card reserves for it.
constexpr std::size_t kStateWords = 5;
constexpr std::size_t kMaxWords = (256 - 4 * kStateWords) / 4;
constexpr std::size_t kHeaderBytes = 8;
constexpr std::size_t kMaxRequestBody = kHeaderBytes + 4 * kMaxWords;
constexpr std::size_t kMaxReplyBody = kHeaderBytes + 4 * kStateWords + 4 * kMaxWords;

enum class Kind : std::uint8_t { Ask = 0, Connect = 1, Read = 2, Write = 3 };

struct Request {
  Kind kind = Kind::Ask;
  bool fixed = false;      // all words at one address, for STREAM
  std::uint8_t count = 0;  // words to read or write: 1 .. kMaxWords; 0 for Ask and Connect
  std::uint16_t number = 0;
  std::uint16_t epoch = 0;
  std::uint16_t address = 0;        // byte address of the first word
  std::vector<std::uint32_t> data;  // words to write: `count`

  bool operator==(const Request& o) const;
};

enum class Result : std::uint8_t { Done = 0, Refused = 1, WrongNumber = 2, WrongEpoch = 3, Malformed = 4 };

// State of the card when it replied: registers STATUS to FEED_ROOM.
struct CardState {
  std::array<std::uint32_t, kStateWords> words{};

  std::uint32_t status() const { return words[0]; }
  std::uint32_t fault() const { return words[1]; }
  std::uint32_t refusal() const { return words[2]; }
  std::uint32_t geometry_room() const { return words[3]; }
  std::uint32_t feed_room() const { return words[4]; }
};

struct Reply {
  Result result = Result::Done;
  std::uint8_t made = 0;     // words read or written; of a refused request: index of the refused word
  std::uint16_t number = 0;  // number of the request
  std::uint16_t last = 0;    // number of the last executed request
  std::uint16_t epoch = 0;   // epoch of the connection
  CardState state;
  bool has_data = false;            // the request was a read and was executed
  std::vector<std::uint32_t> data;  // words read: `made`

  bool operator==(const Reply& o) const;
};

// Appends the frame. Throws std::invalid_argument if the data do not match kind and count.
void append_request(Bytes& stream, const Request& request);
void append_reply(Bytes& stream, const Reply& reply);

// Parses a body with a correct CRC. Returns nullopt if its length does not match its kind and count.
struct ReceivedRequest {
  Request request;
  bool malformed = false;  // unused bits set, or a count or address that no request has
};
std::optional<ReceivedRequest> parse_request(const Bytes& body);
std::optional<Reply> parse_reply(const Bytes& body);

}  // namespace trammel::frames
