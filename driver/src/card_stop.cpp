// Ends of motion: waiting for it, a stop on the path, a take-over.
#include <fmt/format.h>

#include <algorithm>

#include "card_identity.hpp"
#include "register_checks.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/interrupt.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "wait_budget.hpp"

namespace trammel::driver {

namespace reg = card_map::reg;

void Card::wait_until_idle(std::chrono::nanoseconds timeout) {
  constexpr const char* kContext = "waiting for the end of motion";
  WaitBudget budget(*this, kContext, 0);
  // The commands under way run at one of the ratios; the slowest one gives the longest time.
  PieceClass slowest = PieceClass::kFeed;
  for (const PieceClass other : {PieceClass::kRapid, PieceClass::kFixed}) {
    if (ratio(other) != 0 && (ratio(slowest) == 0 || ratio(other) < ratio(slowest))) slowest = other;
  }
  budget.allow(PlannedTime::of(clocks_of(timeout, timing().clock_hz, "timeout"), slowest));
  for (bool first = true;; first = false) {
    const Status now = read_status();
    parts_->registers.throw_if_faulted(now, kContext);
    if (!now.busy) {
      return check_identity(*parts_);
    }
    if (first && now.held && !parts_->time_base.holds_by_this_program()) parts_->time_base.throw_if_held(kContext);
    serve_requests(*this);
    budget.pause(now, poll_interval(timing().clock_hz), WaitBudget::kIdle);
  }
}

std::optional<Snapshot> Card::take_over() {
  const Status now = read_status();
  const bool holds = parts_->time_base.hold();
  if (now.busy && !now.held && !holds) {
    throw StateError("the card is moving, and not by this program: wait until it is idle, or hold it");
  }
  if (now.busy) return stop();
  set_hold(false);
  return std::nullopt;
}

Snapshot Card::stop(std::chrono::nanoseconds margin) {
  set_hold(true);
  const std::uint64_t margin_clocks = clocks_of(margin, timing().clock_hz, "stop: margin");
  wait_for_rest(kSlowestSlew / std::max<std::uint32_t>(parts_->registers.read(reg::kSlew), 1) + margin_clocks, true);
  const Snapshot at_rest = read_snapshot();
  abort();
  wait_for_rest(margin_clocks, false);  // waits for pulses that the shapers have accepted
  Snapshot end = read_snapshot();
  set_hold(false);
  end.geometry_begun = at_rest.geometry_begun;
  end.feed_begun = at_rest.feed_begun;
  return end;
}

void Card::wait_until_stopped(std::chrono::nanoseconds margin) {
  if (!read_status().stopping) return;
  const std::uint64_t ramp = kSlowestSlew / std::max<std::uint32_t>(parts_->registers.read(reg::kSlew), 1);
  const std::uint64_t limit = ramp + clocks_of(margin, timing().clock_hz, "waiting for a stop: margin");
  const std::uint64_t pause = poll_interval(timing().clock_hz);
  for (std::uint64_t waited = 0; read_status().stopping; waited += pause) {
    if (waited > limit) throw TimeoutError("waiting for a stop", waited);
    if (interrupted()) throw InterruptedError("waiting for a stop: interrupted; the card goes on to rest");
    bus().sleep(time_of(pause, timing().clock_hz));
  }
}

// Waits for the stop first: a card on its ramp would refuse commands although FAULT is clear, and would set the same
// fault again.
void Card::clear_faults(std::chrono::nanoseconds margin) {
  wait_until_stopped(margin);
  const auto times = parts_->watchdog.restart();
  const std::size_t count = parts_->watchdog.restarts();
  std::array<Access, Watchdog::kRestarts + 2> accesses{};
  std::copy_n(times.begin(), count, accesses.begin());
  accesses[count] = write_of(reg::kFault, register_at(reg::kFault).mask);
  parts_->registers.transfer(accesses.data(), count + 1, "clearing faults");
}

// Waits until the card is idle, or, with `held_is_rest`, until the time base is held and nothing moves.
void Card::wait_for_rest(std::uint64_t limit, bool held_is_rest) {
  const std::uint64_t pause = poll_interval(timing().clock_hz);
  for (std::uint64_t waited = 0;; waited += pause) {
    const Status now = read_status();
    parts_->registers.throw_if_faulted(now, "stop");
    parts_->watchdog.look();
    // Settled: all ticks taken have made their steps, so REST is exact after the abort.
    if (!now.busy || (held_is_rest && now.held && (now.settled || identification().map_minor < kMapMinorOfRest)))
      return;
    if (waited > limit) throw TimeoutError("stop on the path", waited);
    if (interrupted()) throw InterruptedError("stop on the path: interrupted; the card goes on to rest, and holds");
    bus().sleep(time_of(pause, timing().clock_hz));
  }
}

}  // namespace trammel::driver
