// Commands of the stream.
#include "commands.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <utility>

#include "card.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/arc_chord.hpp"
#include "trammel/driver/increment.hpp"

namespace trammel::python {
namespace {

driver::Command line(std::uint64_t ticks, const std::vector<std::int64_t>& pulses) {
  if (ticks == 0 || ticks >> card_map::constant::kFractionBits != 0) {
    throw driver::ArgumentError("a line's ticks are 1 .. 2^40 - 1");
  }
  const auto ways = by_axis(pulses, "pulses");
  driver::LineCommand out;
  out.ticks = ticks;
  for (unsigned axis = 0; axis < ways.size(); ++axis) {
    if (ways[axis] == 0) continue;
    const auto most = static_cast<std::int64_t>(ticks);
    if (ways[axis] > most || ways[axis] < -most) throw driver::ArgumentError("more pulses than ticks");
    out.mask = static_cast<std::uint8_t>(out.mask | 1U << axis);
    out.increment[axis] = driver::rounded_increment(ways[axis], ticks);
  }
  return out;
}

driver::ArcGeometry arc_geometry(std::array<std::int64_t, 2> centre, std::array<std::int32_t, 2> end, double sweep,
                                 bool clockwise, std::uint32_t turns, std::array<std::uint8_t, 2> axes) {
  return {centre[0], centre[1], end[0], end[1], clockwise, sweep, turns, axes[0], axes[1]};
}

driver::Command arc(std::uint64_t ticks, std::array<std::int64_t, 2> centre, std::array<std::int32_t, 2> end,
                    double sweep, bool clockwise, std::uint32_t turns, std::array<std::uint8_t, 2> axes,
                    bool eight_directions) {
  return driver::make_arc(arc_geometry(centre, end, sweep, clockwise, turns, axes), ticks,
                          eight_directions ? driver::StepRule::kEightDirections : driver::StepRule::kFourDirections);
}

driver::Command helix(std::uint64_t ticks, std::array<std::int64_t, 2> centre, std::array<std::int32_t, 2> end,
                      double sweep, bool clockwise, std::uint32_t turns, std::array<std::uint8_t, 2> axes,
                      const std::vector<std::int64_t>& further) {
  return driver::make_helix({arc_geometry(centre, end, sweep, clockwise, turns, axes), by_axis(further, "further")},
                            ticks);
}

driver::Command feed(std::uint64_t ticks, std::uint64_t rate, std::int64_t acceleration, std::int64_t jerk,
                     std::uint32_t floor, std::uint32_t stop_distance, driver::PieceClass piece_class, bool silent,
                     std::uint8_t slew_shift) {
  return driver::FeedCommand{ticks, rate, acceleration, jerk, floor, stop_distance, piece_class, silent, slew_shift};
}

template <class... Values>
auto as_command(driver::Command (*make)(Values...)) {
  return [make](Values... values) { return PythonCommand{make(std::move(values)...)}; };
}

}  // namespace

void bind_commands(nb::module_& m) {
  nb::class_<PythonCommand>(m, "Command", "A command of the stream; line(), arc(), feed() and so on make them.")
      .def_prop_ro(
          "name", [](const PythonCommand& c) { return std::string(driver::layout_of(c.command).name); },
          "Name of the command.")
      .def(
          "words",
          [](const PythonCommand& c, std::uint8_t number) {
            std::vector<std::uint32_t> words;
            driver::encode(c.command, number, words);
            return words;
          },
          "number"_a = 0, "Its words, as the card reads them, with the command number.");
  m.def("line", as_command(line), "ticks"_a, "pulses"_a, "A straight line, by axis.");
  m.def("arc", as_command(arc), "ticks"_a, "centre"_a, "end"_a, "sweep"_a, "clockwise"_a = false, "turns"_a = 0,
        "axes"_a = std::array<std::uint8_t, 2>{0, 1}, "eight_directions"_a = false,
        "An arc of a circle: from the start to the centre in 1/256 pulses and to the end in pulses, sweep in radians.");
  m.def("helix", as_command(helix), "ticks"_a, "centre"_a, "end"_a, "sweep"_a, "clockwise"_a = false, "turns"_a = 0,
        "axes"_a = std::array<std::uint8_t, 2>{0, 1}, "further"_a = std::vector<std::int64_t>{},
        "An arc in chords, with lines of further axes over the same time.");
  m.def("feed", as_command(feed), "ticks"_a, "rate"_a, "acceleration"_a = 0, "jerk"_a = 0, "floor"_a = 1,
        "stop_distance"_a = 0, "piece_class"_a = driver::PieceClass::kFeed, "silent"_a = false, "slew_shift"_a = 0,
        "A piece of the feed: rate in 2^-64 ticks a clock. stop_distance 0: it ends at rest. silent: it moves the path "
        "on, but no axis. slew_shift: SLEW is doubled so often in it, 0 to 3.");
  m.def(
      "dwell", [](std::uint64_t clocks) { return PythonCommand{driver::DwellCommand{clocks}}; }, "clocks"_a,
      "Waits at rest for so many clocks.");
  m.def(
      "end", [] { return PythonCommand{driver::EndCommand{}}; }, "The end of the stream: the card sets STATUS.ended.");
  m.def(
      "output",
      [](std::uint16_t set, std::uint16_t clear) {
        return PythonCommand{driver::OutputCommand{set, clear}};
      },
      "set"_a = 0, "clear"_a = 0, "Switches outputs at this place of the path.");
  m.def(
      "mark", [] { return PythonCommand{driver::MarkCommand{}}; },
      "Counts in read_marks() and latches a snapshot when the path comes to it.");
  m.def(
      "wait_input",
      [](std::uint8_t input, bool level, std::uint64_t timeout) {
        return PythonCommand{driver::WaitInputCommand{input, level, timeout}};
      },
      "input"_a, "level"_a = true, "timeout"_a = 0,
      "Waits at rest until the input has the level, for at most timeout clocks (0: without an end).");
}

}  // namespace trammel::python
