// Captures of inputs' edges.
#include "trammel/driver/captures.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "handle.hpp"

namespace trammel::c {

static_assert(TRAMMEL_MAX_CAPTURES == driver::kCaptureUnits);

namespace {

trammel_capture c_capture(const driver::Capture& capture) {
  return {c_snapshot(capture.at), capture.active, capture.overrun};
}

trammel_capture_states c_states(const driver::CaptureStates& states) {
  trammel_capture_states out{};
  std::transform(states.units.begin(), states.units.end(), out.units, [](const driver::CaptureState& unit) {
    return trammel_capture_state{unit.pending, unit.valid, unit.overrun, unit.active};
  });
  out.snapshots = states.snapshots;
  return out;
}

}  // namespace
}  // namespace trammel::c

using namespace trammel::c;
namespace driver = trammel::driver;

trammel_result trammel_count_captures(const trammel_card* card, unsigned* units) {
  return guarded([=] { required(units, "units") = required(card, "card").card.captures_present(); });
}

trammel_result trammel_select_capture(trammel_card* card, unsigned unit, const trammel_capture_select* select) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    const trammel_capture_select& is = required(select, "select");
    of.select_capture(unit, {is.input, is.to_active, is.to_inactive, is.continuous, is.queue});
  });
}

trammel_result trammel_stop_capture(trammel_card* card, unsigned unit) {
  return guarded([=] { card_of(card).stop_capture(unit); });
}

trammel_result trammel_read_captures(trammel_card* card, trammel_capture_states* states) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    required(states, "states") = c_states(of.read_captures());
  });
}

// The pointers are checked first, because the capture is cleared when it is taken.
trammel_result trammel_take_capture(trammel_card* card, unsigned unit, trammel_capture* capture, bool* taken) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    trammel_capture& out = required(capture, "capture");
    bool& any = required(taken, "taken");
    const std::optional<driver::Capture> is = of.take_capture(unit);
    any = is.has_value();
    if (is) out = c_capture(*is);
  });
}

trammel_result trammel_wait_for_capture(trammel_card* card, unsigned unit, int64_t timeout_ns,
                                        trammel_capture* capture) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    trammel_capture& out = required(capture, "capture");
    out = c_capture(of.wait_for_capture(unit, std::chrono::nanoseconds(timeout_ns)));
  });
}

trammel_result trammel_clear_captures(trammel_card* card, unsigned units) {
  return guarded([=] { card_of(card).clear_captures(units); });
}

trammel_result trammel_has_capture_queue(const trammel_card* card, bool* has) {
  return guarded([=] { required(has, "has") = required(card, "card").card.has_capture_queue(); });
}

trammel_result trammel_read_capture_queue(trammel_card* card, trammel_capture_queue* queue) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    trammel_capture_queue& out = required(queue, "queue");
    const driver::CaptureQueue is = of.read_capture_queue();
    out = {is.captures, is.lost};
  });
}

trammel_result trammel_take_queued_captures(trammel_card* card, trammel_queued_capture* captures, unsigned* count) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    trammel_queued_capture* const out = &required(captures, "captures");
    unsigned& number = required(count, "count");
    const std::vector<driver::QueuedCapture> taken = of.take_queued_captures();
    std::transform(taken.begin(), taken.end(), out, [](const driver::QueuedCapture& capture) {
      return trammel_queued_capture{c_snapshot(capture.at), capture.unit, capture.active};
    });
    number = static_cast<unsigned>(taken.size());
  });
}
