// The parsers of host and card with arbitrary bytes. Bit 0 of the first byte selects the meaning of the others: 0: a
// stream; 1: the body of a frame, which gets a valid CRC so that the parsers after the CRC check are reached.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "trammel/frames/endpoint.hpp"

namespace {

using namespace trammel::frames;

[[noreturn]] void fail(const char* what) {
  std::fprintf(stderr, "frames_fuzz: %s\n", what);
  std::abort();
}

// A body that is parsed as a request or a reply must encode to the same bytes again.
void check_request(const Bytes& body) {
  const std::optional<ReceivedRequest> received = parse_request(body);
  if (!received || received->malformed) return;
  Bytes again;
  append_request(again, received->request);
  Bytes stream;
  append_frame(stream, body);
  if (again != stream) fail("a request is not what it was parsed from");
}
void check_reply(const Bytes& body) {
  const std::optional<Reply> reply = parse_reply(body);
  if (!reply) return;
  Bytes again;
  append_reply(again, *reply);
  Bytes stream;
  append_frame(stream, body);
  if (again != stream) fail("a reply is not what it was parsed from");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  Bytes stream(data + 1, data + size);
  if ((data[0] & 1) != 0) {
    Bytes body;
    body.swap(stream);
    check_request(body);
    check_reply(body);
    append_frame(stream, body);
  }
  std::uint64_t executed = 0;
  Endpoint card([&](bool write, std::uint32_t address, std::uint32_t) {
    if (write || address < 0x40 || address > 0x50) ++executed;
    if (address >= 4096 || address % 4 != 0) fail("an address outside the window");
    return Endpoint::Answer{address % 64 == 60, address};
  });
  Bytes out;
  for (const std::uint8_t byte : stream) {
    const std::uint64_t before = executed;
    card.take(byte, out);
    if (executed - before > kMaxWords) fail("more accesses than a request has");
  }
  Deframer host(kMaxReplyBody);
  for (const std::uint8_t byte : out) {
    if (host.take(byte) && !parse_reply(host.body())) fail("the card's reply is none");
  }
  if (!out.empty() && host.dropped() != 0) fail("the card's reply is damaged");
  Deframer any(kMaxReplyBody);
  for (const std::uint8_t byte : stream) {
    if (any.take(byte)) check_reply(any.body());
  }
  return 0;
}
