#include "trammel/driver/low_level/snapshots.hpp"

#include <array>

#include "register_checks.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card_timing.hpp"

namespace trammel::driver {

namespace map = card_map;
namespace reg = card_map::reg;
namespace field = card_map::field;

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

Snapshot Snapshots::read_area(map::Area area) {
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
  constexpr std::size_t kHead = 8;
  std::array<Access, kHead + map::kMaxAxes + 1> accesses{
      read_of(reg::time_lo(area)),        read_of(reg::time_hi(area)),   read_of(reg::status(area)),
      read_of(reg::fault(area)),          read_of(reg::rate(area)),      read_of(reg::ratio(area)),
      read_of(reg::geometry_begun(area)), read_of(reg::feed_begun(area))};
  for (unsigned axis = 0; axis < card_.axes; ++axis) {
    accesses[kHead + axis] = read_of(reg::position(area, axis));
  }
  registers_.transfer(accesses.data(), kHead + card_.axes, "snapshot");
  Snapshot result;
  result.time = accesses[0].data | std::uint64_t{accesses[1].data} << 32;
  result.status = Registers::decode_status(accesses[2].data);
  result.faults = accesses[3].data;
  result.rate = accesses[4].data;
  result.ratio = accesses[5].data;
  result.geometry_begun = accesses[6].data;
  result.feed_begun = accesses[7].data;
  for (unsigned axis = 0; axis < card_.axes; ++axis) {
    result.position[axis] = static_cast<std::int32_t>(accesses[kHead + axis].data);
  }
  return result;
}

}  // namespace trammel::driver
