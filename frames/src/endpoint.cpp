#include "trammel/frames/endpoint.hpp"

#include <utility>

#include "trammel/card_map.hpp"

namespace trammel::frames {

namespace {

namespace reg = card_map::reg;
// The state in a reply is read from one block of registers.
static_assert(reg::kFault == reg::kStatus + 4 && reg::kRefusal == reg::kStatus + 8);
static_assert(reg::kGeometryRoom == reg::kStatus + 12 && reg::kFeedRoom == reg::kStatus + 16);
static_assert(reg::kFeedRoom == reg::kStatus + 4 * (kStateWords - 1));

}  // namespace

void Endpoint::take(std::uint8_t byte, Bytes& out) {
  if (!deframer_.take(byte)) return;
  const std::optional<ReceivedRequest> received = parse_request(deframer_.body());
  if (!received) return;
  if (session_.take(*received) == Session::Step::Execute) execute(received->request);
  append_reply(out, session_.reply(state()));
}

void Endpoint::connect() {
  deframer_.clear();
  session_.connect();
}

void Endpoint::execute(const Request& request) {
  std::vector<std::uint32_t> data;
  const bool write = request.kind == Kind::Write;
  std::uint32_t address = request.address;
  std::uint8_t made = 0;
  bool refused = false;
  while (made < request.count) {
    const Answer answer = access_(write, address, write ? request.data[made] : 0);
    refused = answer.refused;
    if (refused) break;
    if (!write) data.push_back(answer.data);
    if (!request.fixed) address = (address + 4) % card_map::kWindowBytes;
    ++made;
  }
  session_.executed(made, refused, std::move(data));
}

CardState Endpoint::state() {
  CardState state;
  for (std::size_t i = 0; i < kStateWords; ++i) {
    state.words[i] = access_(false, reg::kStatus + 4 * static_cast<std::uint32_t>(i), 0).data;
  }
  return state;
}

}  // namespace trammel::frames
