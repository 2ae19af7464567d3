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

// A straight line over `ticks` feed ticks. Axes outside `mask` do not move.
struct LineCommand {
  std::uint64_t ticks = 0;                                   // N, feed ticks, 1 .. 2^40 - 1
  std::uint8_t mask = 0;                                     // bit n: axis n moves
  std::array<std::int64_t, card_map::kMaxAxes> increment{};  // by axis; 2^-40 pulses per tick, |.| <= 2^40
};

// An arc on the deviation accumulator.
struct ArcCommand {
  std::uint64_t ticks = 0;        // N, feed ticks
  std::uint64_t path_ticks = 0;   // L <= N, number of path ticks; one step per path tick
  std::uint64_t prescale = 0;     // round(L * 2^40 / N), 2^-40 path ticks per feed tick
  bool clockwise = false;         // seen with the first axis to the right and the second up
  bool eight_directions = false;  // a step may be along both axes; only on cards with accumulator_8
  std::uint8_t axis_x = 0;        // index of the first axis of the plane
  std::uint8_t axis_y = 1;        // index of the second
  std::uint16_t quadrants = 0;    // Q, quadrant changes before the end point counts as the end
  std::int32_t end_x = 0;         // displacement from start to end, pulses
  std::int32_t end_y = 0;
  Int128 deviation;          // F at the start; 80 bits
  Int128 gradient_x;         // GX at the start; 80 bits
  Int128 gradient_y;         // GY at the start; 80 bits
  std::uint64_t half_x = 0;  // CX/2
  std::uint64_t half_y = 0;  // CY/2
};

// An arc in chords on the arc generator. Further axes of the mask move along straight lines over the same path ticks.
struct ArcChordCommand {
  std::uint64_t ticks = 0;       // N, feed ticks
  std::uint64_t path_ticks = 0;  // L <= N, L < 2^37
  std::uint64_t prescale = 0;    // round(L * 2^40 / N), 2^-40 path ticks per feed tick
  std::uint8_t mask = 0;         // bit n: axis n; both axes of the plane, and any further axes
  bool clockwise = false;        // seen with the first axis to the right and the second up
  std::uint8_t axis_x = 0;       // index of the first axis of the plane
  std::uint8_t axis_y = 1;       // index of the second
  std::uint8_t k = 1;            // a chord rotates by 2 asin(2^-(k+1)); useful range 1 .. 27
  std::uint8_t m = 5;            // 2^m path ticks per chord; range 5 .. 31
  std::int64_t x = 0;            // X at the start, 2^(m-40) pulses
  std::int64_t y = 0;            // Y half a chord before the start, 2^(m-40) pulses
  // Increments in 2^-40 pulses per path tick, |.| <= 2^40. first_x, first_y: of the first path tick, the sum of preset,
  // first chord and closing increment.
  std::int64_t first_x = 0;
  std::int64_t first_y = 0;
  std::int64_t closing_x = 0;
  std::int64_t closing_y = 0;
  std::array<std::int64_t, card_map::kMaxAxes> increment{};  // of the further axes, by axis index
};

// The class of a piece: selects its ratio of the time base, on cards with classes. A hold starts after the end of fixed
// pieces.
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
  std::int64_t acceleration = 0;    // 2^-64 ticks per enabled clock, per update of 32 enabled clocks
  std::int64_t jerk = 0;            // the same unit, per update squared
  std::uint32_t floor = 1;          // 2^-32 ticks per enabled clock, not 0
  std::uint32_t stop_distance = 0;  // feed ticks that a stop on the path takes; 0: the piece ends at rest
  PieceClass piece_class = PieceClass::kFeed;
  // A silent piece's ticks advance the path, but move no axis: a program that was stopped in the middle of a path
  // continues from there with the same steps. Needs map 3.2 or later. The next piece that is not silent starts from
  // rest. From map 3.4 on (feed_generator 1.2) a silent piece runs at any ratio, also during a hold.
  bool silent = false;
  // Number of times that the card doubles SLEW while the piece is in force, 0 .. kMaxSlewShift. A slow piece then holds
  // and resumes sooner. The ratio moves by SLEW 2^slew_shift per update; a doubling beyond 28 bits is not made. Without
  // has_slew_shift() (identification.hpp) the field has no effect, and cards before map 3.4 refuse the piece.
  std::uint8_t slew_shift = 0;
};

// Barrier, then `clocks` of real time (0 .. 2^40 - 1).
struct DwellCommand {
  std::uint64_t clocks = 0;
};

// Barrier: end of the program.
struct EndCommand {};

// Sets and clears outputs at a point of the path (cards with path commands): with the last tick of the previous path,
// or at once if no path is under way. Bit n: output n. An output in both masks is set.
struct OutputCommand {
  std::uint16_t set = 0;
  std::uint16_t clear = 0;
};

// Counts MARKS and latches the MARK area, at a point of the path as OutputCommand.
struct MarkCommand {};

// Barrier, then a wait until an input has a level.
struct WaitInputCommand {
  std::uint8_t input = 0;     // 0 .. 31; an input that the card lacks reads 0
  bool level = true;          // level that ends the wait
  std::uint64_t timeout = 0;  // clocks, up to 2^40 - 1; 0: no timeout
};

// Arms the probe for the paths up to PROBE_END.
struct ProbeCommand {
  std::uint8_t input = 0;  // 0 .. 31; an input that the card lacks reads 0
  bool level = true;       // level that trips the probe
};

// Barrier: end of the probing paths.
struct ProbeEndCommand {};

// Sets the duty of a PWM channel at a point of the path, as OutputCommand (cards with PWM). encode() refuses a channel
// or a shift out of range.
struct PwmCommand {
  std::uint8_t channel = 0;  // 0 or 1
  std::uint16_t duty = 0;    // 2^-16 of the period, 65535: full; the largest duty if `follows`
  bool follows = false;      // the duty follows the speed on the path; see pwm_for_speed()
  std::uint8_t shift = 0;    // 0 .. 31
  std::uint16_t gain = 0;
};

// A duty that follows the speed: `duty` at `rate` feed ticks per clock and above, proportionally less below. At `rate`
// the duty is correct within 2^-16 of itself or 2^-16 of the period, whichever is more. Range: 2^-31 < rate <= 1; below
// 2^-15 the largest gain may give less than `duty`. Throws ArgumentError for another rate.
PwmCommand pwm_for_speed(std::uint8_t channel, std::uint16_t duty, double rate);
// The same, but the duty grows up to `most` at higher speeds.
PwmCommand pwm_for_speed(std::uint8_t channel, std::uint16_t duty, double rate, std::uint16_t most);

using Command = std::variant<LineCommand, ArcCommand, ArcChordCommand, FeedCommand, DwellCommand, EndCommand,
                             OutputCommand, MarkCommand, WaitInputCommand, ProbeCommand, ProbeEndCommand, PwmCommand>;

// Number of words of the card's longest command, with all axes: room for every result of encode().
inline constexpr std::size_t kMaxCommandWords = [] {
  std::size_t most = 0;
  for (const card_map::Command& command : card_map::kCommands) {
    most = std::max<std::size_t>(most, card_map::words(command, 0xFF));
  }
  return most;
}();

// Writes the command's words, header first, to words[0 ..], and returns their number, at most kMaxCommandWords.
// `number` is the command's number, mod 256. Throws ArgumentError, which names the field, if a value is out of the
// range of its field or an axis outside the mask has an increment; the contents of `words` are then undefined. Does not
// check limits of the card (axes, engines, room). Allocates nothing.
std::size_t encode(const Command& command, std::uint8_t number, std::uint32_t* words);

// The same, appended to `words`. If it throws, `words` is unchanged.
void encode(const Command& command, std::uint8_t number, std::vector<std::uint32_t>& words);

// Whether the card counts the command in GEOMETRY_BEGUN or FEED_BEGUN. It counts paths, pieces and barriers, but not
// commands that act at a point of the path.
bool counts_as_begun(const Command& command);

// The layout of this kind of command.
const card_map::Command& layout_of(const Command& command);

struct DecodedCommand {
  Command command;
  std::uint8_t number = 0;  // of the command, mod 256
};

// Inverse of encode(): decodes exactly one command of `count` words. Throws ArgumentError, which names the problem, for
// words that encode() cannot produce.
DecodedCommand decode(const std::uint32_t* words, std::size_t count);

}  // namespace trammel::driver
