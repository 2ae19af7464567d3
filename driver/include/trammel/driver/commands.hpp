// The card's stream commands as values. Layouts, widths and limits: rtl/regs/commands.toml.
// Plain data, no card access; encode() is pure and thread-safe.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/driver/wide.hpp"

namespace trammel::driver {

// A straight line over `ticks` feed ticks; axes outside `mask` stand still.
struct LineCommand {
  std::uint64_t ticks = 0;                                   // N, feed ticks, 1 .. 2^40 - 1
  std::uint8_t mask = 0;                                     // bit n: axis n moves
  std::array<std::int64_t, card_map::kMaxAxes> increment{};  // by axis index; 2^-40 pulses per tick, |.| <= 2^40
};

// An arc on the deviation accumulator.
struct ArcCommand {
  std::uint64_t ticks = 0;        // N, feed ticks
  std::uint64_t path_ticks = 0;   // L <= N, steps
  std::uint64_t prescale = 0;     // round(L * 2^40 / N), 2^-40 path ticks per feed tick
  bool clockwise = false;         // seen with the first axis to the right and the second up
  bool eight_directions = false;  // a step may be along both axes; only on cards with accumulator_8
  std::uint8_t axis_x = 0;        // index of the first axis of the plane
  std::uint8_t axis_y = 1;        // index of the second
  std::uint16_t quadrants = 0;    // Q, quadrant changes before the end may be taken
  std::int32_t end_x = 0;         // displacement start to end, pulses
  std::int32_t end_y = 0;
  Int128 deviation;   // F at the start; 80 bits
  Int128 gradient_x;  // GX, GY at the start; 80 bits
  Int128 gradient_y;
  std::uint64_t half_x = 0;  // CX/2, CY/2
  std::uint64_t half_y = 0;
};

// An arc in chords on the arc generator; further axes of the mask go along straight lines over the same path ticks.
struct ArcChordCommand {
  std::uint64_t ticks = 0;       // N, feed ticks
  std::uint64_t path_ticks = 0;  // L <= N, L < 2^37
  std::uint64_t prescale = 0;    // round(L * 2^40 / N), 2^-40 path ticks per feed tick
  std::uint8_t mask = 0;         // both axes of the plane, and any further ones
  bool clockwise = false;        // seen with the first axis to the right and the second up
  std::uint8_t axis_x = 0;       // index of the first axis of the plane
  std::uint8_t axis_y = 1;       // index of the second
  std::uint8_t k = 1;            // a chord turns by 2 asin(2^-(k+1)); 1 .. 27 are of use
  std::uint8_t m = 5;            // 2^m path ticks per chord; 5 .. 31
  std::int64_t x = 0;            // X at the start, 2^(m-40) pulses
  std::int64_t y = 0;            // Y half a chord before it
  // 2^-40 pulses per path tick, |.| <= 2^40. Of the first path tick: preset, first chord and closing together.
  std::int64_t first_x = 0;
  std::int64_t first_y = 0;
  std::int64_t closing_x = 0;
  std::int64_t closing_y = 0;
  std::array<std::int64_t, card_map::kMaxAxes> increment{};  // of the further axes, by axis index
};

// Which ratio of the time base a piece runs at, where the card has classes. A hold waits for the end of fixed pieces.
enum class PieceClass : std::uint8_t {
  kFeed = card_map::constant::kClassFeed,
  kRapid = card_map::constant::kClassRapid,
  kFixed = card_map::constant::kClassFixed,  // probing, threading
};
inline constexpr std::size_t kPieceClasses = 3;

inline constexpr std::uint8_t kMaxSlewShift = card_map::constant::kMaxSlewShift;

// One piece of the feed profile.
struct FeedCommand {
  std::uint64_t ticks = 0;          // feed ticks of the piece
  std::uint64_t rate = 0;           // 2^-64 ticks per enabled clock
  std::int64_t acceleration = 0;    // the same unit per update of 32 enabled clocks
  std::int64_t jerk = 0;            // the same unit per update, each update
  std::uint32_t floor = 1;          // 2^-32 ticks per enabled clock, not 0
  std::uint32_t stop_distance = 0;  // feed ticks needed to stop on the path; 0: the piece ends at rest
  PieceClass piece_class = PieceClass::kFeed;
  // Its ticks move the path on, but no axis: a program that was stopped in the middle of a path goes on from there with
  // the same steps. Cards with map 3.2 or later. The next piece that is not silent begins from rest. From map 3.4 on
  // (feed_generator 1.2) a silent piece runs at any ratio, also on a card that stands held.
  bool silent = false;
  // How often the card doubles SLEW while the piece is in force, 0 .. kMaxSlewShift: a slow piece is held, and goes on,
  // the sooner. The ratio moves by SLEW 2^slew_shift per update; a doubling beyond 28 bits is not made. Without
  // has_slew_shift() (identification.hpp) it has no effect, and cards before map 3.4 refuse the piece.
  std::uint8_t slew_shift = 0;
};

// Barrier, then `clocks` of real time (0 .. 2^40 - 1).
struct DwellCommand {
  std::uint64_t clocks = 0;
};

// Barrier: end of the program.
struct EndCommand {};

// Commands at their place on the path (cards with path commands). Outputs that are set and cleared with the last tick
// of the path before, at once where none runs; bit n: output n. One that is in both is set.
struct OutputCommand {
  std::uint16_t set = 0;
  std::uint16_t clear = 0;
};

// Counts MARKS and latches the MARK area, likewise.
struct MarkCommand {};

// Barrier, then until an input has a level.
struct WaitInputCommand {
  std::uint8_t input = 0;     // 0 .. 31; one that the card lacks stays at 0
  bool level = true;          // that ends the wait
  std::uint64_t timeout = 0;  // clocks, up to 2^40 - 1; 0: none
};

// Arms the probe for the paths up to PROBE_END.
struct ProbeCommand {
  std::uint8_t input = 0;  // 0 .. 31; one that the card lacks stays at 0
  bool level = true;       // that trips
};

// Barrier: end of the probing paths.
struct ProbeEndCommand {};

// The duty of a PWM channel, likewise (cards with PWM). encode() refuses a channel or a shift that is too large.
struct PwmCommand {
  std::uint8_t channel = 0;  // 0 or 1
  std::uint16_t duty = 0;    // 2^-16 of the period, 65535: full; where it follows, the largest one
  bool follows = false;      // the speed on the path, as pwm_for_speed() has it
  std::uint8_t shift = 0;    // 0 .. 31
  std::uint16_t gain = 0;
};

// A duty that follows the speed: `duty` at `rate` feed ticks per clock and above, less in proportion below. At `rate`
// it is right within 2^-16 of itself or 2^-16 of the period, whichever is more; 2^-31 < rate <= 1, and below 2^-15 the
// largest gain may give less than `duty`. Throws ArgumentError for another rate.
PwmCommand pwm_for_speed(std::uint8_t channel, std::uint16_t duty, double rate);
// The same up to a duty of `most` at higher speeds.
PwmCommand pwm_for_speed(std::uint8_t channel, std::uint16_t duty, double rate, std::uint16_t most);

using Command = std::variant<LineCommand, ArcCommand, ArcChordCommand, FeedCommand, DwellCommand, EndCommand,
                             OutputCommand, MarkCommand, WaitInputCommand, ProbeCommand, ProbeEndCommand, PwmCommand>;

// Words of the longest command of the card's, with all axes: enough for every one of encode()'s.
inline constexpr std::size_t kMaxCommandWords = [] {
  std::size_t most = 0;
  for (const card_map::Command& command : card_map::kCommands) {
    most = std::max<std::size_t>(most, card_map::words(command, 0xFF));
  }
  return most;
}();

// Writes the command's words (header first) to words[0 ..], and returns how many: at most kMaxCommandWords. `number`
// is the command's number, mod 256. Throws ArgumentError, naming the field, when a value is outside its layout or an
// axis outside the mask has an increment; what `words` holds then is of no use. What depends on the card (its axes,
// engines, room) is not checked here. Allocates nothing.
std::size_t encode(const Command& command, std::uint8_t number, std::uint32_t* words);

// Likewise, appended to `words`, which stay as they were when it throws.
void encode(const Command& command, std::uint8_t number, std::vector<std::uint32_t>& words);

// Whether the card counts it in GEOMETRY_BEGUN or FEED_BEGUN: paths, pieces and barriers, not what takes effect beside
// them.
bool counts_as_begun(const Command& command);

// The layout of the command's kind.
const card_map::Command& layout_of(const Command& command);

struct DecodedCommand {
  Command command;
  std::uint8_t number = 0;  // mod 256
};

// Inverse of encode(): exactly one command of `count` words. Throws ArgumentError, naming what is wrong, unless
// encode() could have made them.
DecodedCommand decode(const std::uint32_t* words, std::size_t count);

}  // namespace trammel::driver
