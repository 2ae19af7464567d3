// The parsers of both sides with arbitrary bytes. The first byte says how the others are meant: as a stream, or as the
// body of a frame whose CRC is made good, so that the parsers behind it are reached.
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

// What is taken for a request or a reply is, written again, the same bytes.
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
