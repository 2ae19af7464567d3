#include <algorithm>

#include "handle.hpp"

namespace trammel::c {

using driver::PositionStream;

static_assert(TRAMMEL_POSITION_PULSE == PositionStream::kPulse);

namespace {

PositionStream& positions_of(trammel_card* card) {
  std::optional<PositionStream>& positions = required(card, "card").positions;
  if (!positions) throw driver::StateError("position streaming is not open: trammel_open_positions() opens it");
  return *positions;
}

driver::PositionStreamOptions options_of(const trammel_position_options& options) {
  driver::PositionStreamOptions out;
  out.stale_periods = options.stale_periods;
  out.ahead = options.ahead;
  std::copy(std::begin(options.max_speed), std::end(options.max_speed), out.max_speed.begin());
  if (options.margin_ns != 0) out.margin = std::chrono::nanoseconds(options.margin_ns);
  return out;
}

}  // namespace
}  // namespace trammel::c

using namespace trammel::c;

trammel_result trammel_open_positions(trammel_card* card, const trammel_position_options* options) {
  return guarded([=] {
    trammel_card& opened = required(card, "card");
    opened.stream.reset();
    opened.positions.reset();
    opened.positions.emplace(opened.card,
                             options != nullptr ? options_of(*options) : trammel::driver::PositionStreamOptions());
  });
}

trammel_result trammel_send_positions(trammel_card* card, const int64_t* targets, int64_t duration_ns,
                                      trammel_position_sent* sent) {
  return guarded([=] {
    PositionStream& stream = positions_of(card);
    PositionStream::Positions places{};
    std::copy_n(&required(targets, "targets"), places.size(), places.begin());
    const PositionStream::Sent said = stream.send(places, std::chrono::nanoseconds(duration_ns));
    if (sent != nullptr) *sent = {said.ahead, said.stale_ticks, stream.ticks_behind()};
  });
}

trammel_result trammel_recover_positions(trammel_card* card, trammel_position_stop* stopped) {
  return guarded([=] {
    PositionStream& stream = positions_of(card);
    trammel_position_stop& out = required(stopped, "stopped");
    const PositionStream::Stopped found = stream.recover();
    out.faults = found.faults;
    out.stale_ticks = found.stale_ticks;
    std::copy(found.positions.begin(), found.positions.end(), out.positions);
  });
}

trammel_result trammel_finish_positions(trammel_card* card, int64_t* positions) {
  return guarded([=] {
    const PositionStream::Positions at_end = positions_of(card).finish();
    if (positions != nullptr) std::copy(at_end.begin(), at_end.end(), positions);
  });
}
