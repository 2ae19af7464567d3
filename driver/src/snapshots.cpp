#include "trammel/driver/low_level/snapshots.hpp"

#include <fmt/format.h>

#include <array>

#include "register_checks.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card_timing.hpp"

namespace trammel::driver {

namespace map = card_map;
namespace reg = card_map::reg;
namespace field = card_map::field;

namespace {

using TwoWords = std::array<std::uint32_t, 2>;

// Reads the words that all areas share into a Snapshot or a Rest, and returns two words that are specific to the area.
template <class State>
TwoWords read_words(Registers& registers, unsigned axes, map::Area area, const TwoWords& own, State& state) {
  constexpr std::size_t kHead = 8;
  std::array<Access, kHead + map::kMaxAxes + 1> accesses{read_of(reg::time_lo(area)),
                                                         read_of(reg::time_hi(area)),
                                                         read_of(reg::status(area)),
                                                         read_of(reg::fault(area)),
                                                         read_of(own[0]),
                                                         read_of(own[1]),
                                                         read_of(reg::geometry_begun(area)),
                                                         read_of(reg::feed_begun(area))};
  for (unsigned axis = 0; axis < axes; ++axis) accesses[kHead + axis] = read_of(reg::position(area, axis));
  registers.transfer(accesses.data(), kHead + axes, "snapshot");
  state.time = accesses[0].data | std::uint64_t{accesses[1].data} << 32;
  state.status = Registers::decode_status(accesses[2].data);
  state.faults = accesses[3].data;
  state.geometry_begun = accesses[6].data;
  state.feed_begun = accesses[7].data;
  for (unsigned axis = 0; axis < axes; ++axis) {
    state.position[axis] = static_cast<std::int32_t>(accesses[kHead + axis].data);
  }
  return {accesses[4].data, accesses[5].data};
}

}  // namespace

Snapshot Snapshots::take() {
  registers_.write(reg::kControl, field::kControlSnapshot, "snapshot");
  return read_area(map::Area::Snap);
}

Snapshot Snapshots::mark() {
  require_path_commands(card_.engines, "mark");
  return read_area(map::Area::Mark);
}

std::uint32_t Snapshots::marks() {
  require_path_commands(card_.engines, "marks");
  return registers_.read(reg::kMarks);
}

Snapshot Snapshots::probe() {
  require_path_commands(card_.engines, "probe");
  return read_area(map::Area::Probe);
}

void Snapshots::clear_probe() {
  require_path_commands(card_.engines, "probe");
  registers_.write(reg::kControl, field::kControlProbeClear, "probe");
}

Rest Snapshots::rest() {
  if (card_.map_minor < kMapMinorOfRest) {
    throw ArgumentError(fmt::format("rest: the card's map {}.{} has no area REST; it came with {}.{}", card_.map_major,
                                    card_.map_minor, card_.map_major, kMapMinorOfRest));
  }
  if (registers_.read_status().stopping) {
    throw StateError("rest: the card is on its way to a stop: wait_until_stopped() first");
  }
  wait_until_written();
  Rest result;
  const auto ticks_left =
      read_words(registers_, card_.axes, map::Area::Rest, {reg::kRestTicksLeftLo, reg::kRestTicksLeftHi}, result);
  result.ticks_left = ticks_left[0] | std::uint64_t{ticks_left[1]} << 32;
  return result;
}

void Snapshots::wait_until_written() {
  constexpr std::uint64_t kPause = 16;    // clocks; a snapshot is a few dozen register words
  constexpr std::uint64_t kLimit = 4096;  // clocks
  std::uint64_t waited = 0;
  while (registers_.read_status().snapshot) {
    if (waited >= kLimit) {
      throw TimeoutError("snapshot", waited);
    }
    registers_.bus().sleep(time_of(kPause, card_.clock_hz));
    waited += kPause;
  }
}

Snapshot Snapshots::read_area(map::Area area) {
  wait_until_written();
  return read_without_waiting(area);
}

Snapshot Snapshots::read_without_waiting(map::Area area) {
  Snapshot result;
  const auto speed = read_words(registers_, card_.axes, area, {reg::rate(area), reg::ratio(area)}, result);
  result.rate = speed[0];
  result.ratio = speed[1];
  return result;
}

}  // namespace trammel::driver
