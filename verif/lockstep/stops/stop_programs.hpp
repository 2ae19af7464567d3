// The state of the card when a cause of a stop comes: programs, and the way to the window of clocks in each.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "stop_bench.hpp"
#include "trammel/driver/arc_chord.hpp"

namespace trammel::test {

// A command of the geometry queue: the position of the axes after a number of its ticks, relative to its start. A
// barrier has no ticks.
struct Path {
  std::uint64_t ticks = 0;
  std::function<Place(std::uint64_t)> after;
};

struct Program {
  std::vector<driver::Command> commands;       // in the order in which they are sent
  std::vector<driver::Command> rest;           // commands that the program still needs when finish() has been called
  std::vector<Path> paths;                     // in the order in which GEOMETRY_BEGUN counts them
  std::function<Place(std::uint64_t)> direct;  // position after a number of clocks of a direct move; none: a program

  Place end() const {
    Place place{};
    for (const Path& path : paths) add(place, path.after(path.ticks));
    return direct ? direct(~std::uint64_t{0}) : place;
  }
  // The position after `taken` ticks of the last one of `begun` commands.
  Place at(std::uint32_t begun, std::uint64_t taken) const {
    Place place{};
    for (std::uint32_t i = 0; i + 1 < begun; ++i) add(place, paths.at(i).after(paths.at(i).ticks));
    if (begun != 0) add(place, paths.at(begun - 1).after(taken));
    return place;
  }
  static void add(Place& to, const Place& by) {
    for (unsigned n = 0; n < kWatchedAxes; ++n) to[n] += by[n];
  }
};

struct State {
  const char* name;
  const Program& (*program)();
  // Runs from the sent program to the window.
  void (*enter)(StopBench&);
  // The actions of a host that let an undisturbed program come to its end.
  void (*finish)(StopBench&, const Program&);
  // Actions before the program is sent.
  void (*prepare)(StopBench&) = nullptr;
  bool runs = true;   // a path or a direct move is under way, in the whole window
  bool moves = true;  // at full ratio, and continues for longer than a ramp lasts
  bool probing = false;
  bool streaming = false;
  bool tripped = false;  // a probe stops the path itself, at a place that only its own tests know
  bool resets = false;   // a reset comes inside the window
  bool at_rest = false;  // in a hold, and settled
  bool alone = true;     // reaches its window without the host
};

// A line by the documented rule: start + floor(1/2 + k * increment / 2^40). In streaming it continues beyond its
// ticks.
inline Path path_of(const driver::LineCommand& line, std::uint64_t silent = 0) {
  const auto at = [line](std::uint64_t ticks) {
    Place place{};
    for (unsigned n = 0; n < kWatchedAxes; ++n) {
      if ((line.mask >> n & 1) == 0) continue;
      const std::int64_t sum = (std::int64_t{1} << 39) + static_cast<std::int64_t>(ticks) * line.increment[n];
      place[n] = static_cast<std::int32_t>(sum >> 40);
    }
    return place;
  };
  return {line.ticks, [at, silent](std::uint64_t ticks) {
            Place place = at(std::max(ticks, silent));
            const Place passed = at(silent);
            for (unsigned n = 0; n < kWatchedAxes; ++n) place[n] -= passed[n];
            return place;
          }};
}

inline driver::FeedCommand feed_of(std::uint64_t ticks, unsigned clocks = kTickClocks) {
  driver::FeedCommand piece;
  piece.ticks = ticks;
  piece.rate = ~std::uint64_t{0} / clocks + 1;
  piece.floor = 1;
  return piece;
}

// Records an arc at the pins, with one path tick per `clocks` clocks: the positions of the axes after each path tick.
// Each path tick makes a step; the steps of one tick come within half of that time.
inline std::vector<Place> recorded(const driver::Command& arc, std::uint64_t path_ticks, std::uint64_t ticks,
                                   unsigned clocks) {
  StopBench bench(std::make_unique<RtlAlone>(watched_straps(), kWatchedAxes));
  bench.set_up();
  bench.send(feed_of(ticks, clocks));
  bench.send(arc);
  bench.send(driver::EndCommand{});
  bench.host.wait(ticks * clocks + 1000);
  if ((bench.read(reg::kStatus) & field::kStatusEnded) == 0 || !bench.watch.error.empty())
    throw std::logic_error("an arc alone does not come to its end: " + bench.watch.error);
  std::vector<Place> places(1);
  std::uint64_t begin = 0;
  for (const Pulse& pulse : bench.watch.pulses) {
    if (places.size() == 1 || pulse.clock - begin > clocks / 2) {
      begin = pulse.clock;
      places.push_back(places.back());
    }
    places.back()[pulse.axis] += pulse.direction;
  }
  if (places.size() != path_ticks + 1) throw std::logic_error("an arc's ticks do not all make steps");
  return places;
}

inline Path path_of(std::uint64_t ticks, std::uint64_t prescale, std::vector<Place> places) {
  return {ticks, [places = std::move(places), prescale](std::uint64_t feed_ticks) {
            constexpr std::uint64_t kWhole = std::uint64_t{1} << 40;
            return places.at((kWhole / 2 + feed_ticks * prescale) >> 40);
          }};
}

inline const Path kBarrier{0, [](std::uint64_t /*ticks*/) { return Place{}; }};

inline Program program_of(const driver::FeedCommand& piece, const driver::LineCommand& line) {
  Program program;
  program.commands = {piece, line, driver::EndCommand{}};
  program.paths = {path_of(line), kBarrier};
  return program;
}

// Axis 0 steps in each tick.
inline driver::LineCommand long_line(std::int64_t ticks = 160) {
  return line(static_cast<std::uint64_t>(ticks), {ticks, -ticks / 2, ticks / 4, -ticks / 8});
}

// An arc that moves axis 0 in the positive and axis 1 in the negative direction in its first quarter.
inline driver::ArcGeometry circle_geometry(std::int32_t radius) {
  driver::ArcGeometry arc;
  arc.centre_x = radius * driver::kCentreUnitsPerPulse;
  arc.sweep = 6.283185307179586;
  return arc;
}

inline Program arc_program(const driver::ArcCommand& untimed, unsigned clocks) {
  const driver::ArcCommand arc = driver::with_ticks(untimed, untimed.path_ticks);
  Program program;
  program.commands = {feed_of(arc.ticks, clocks), arc, driver::EndCommand{}};
  program.paths = {path_of(arc.ticks, arc.prescale, recorded(arc, arc.path_ticks, arc.ticks, clocks)), kBarrier};
  return program;
}

inline Program circle_program() { return arc_program(driver::prepare(circle_geometry(40)), kTickClocks); }
inline Program circle_8_program() {
  return arc_program(driver::prepare(circle_geometry(40), driver::StepRule::kEightDirections), 32);
}

inline Program helix_program() {
  driver::HelixGeometry helix;
  helix.arc = circle_geometry(30);
  // Half of it, because the arc generator takes some ticks per step.
  helix.arc.end_x = 60;
  helix.arc.sweep /= 2;
  const std::uint64_t ticks = driver::least_chord_ticks(helix) + 10;
  // The third axis steps in each path tick.
  helix.further[2] = static_cast<std::int64_t>(driver::make_helix(helix, ticks).path_ticks);
  const driver::ArcChordCommand arc = driver::make_helix(helix, ticks);
  Program program;
  program.commands = {feed_of(arc.ticks), arc, driver::EndCommand{}};
  program.paths = {path_of(arc.ticks, arc.prescale, recorded(arc, arc.path_ticks, arc.ticks, kTickClocks)), kBarrier};
  return program;
}

inline Program conic_program() {
  driver::EllipseGeometry ellipse;
  ellipse.semi_x = 50;
  ellipse.semi_y = 30;
  ellipse.start_x = -50;
  ellipse.sweep = 6.283185307179586;
  return arc_program(driver::prepare(ellipse), kTickClocks);
}

// Accelerates from a sixth of the feed rate over the window.
inline Program ramp_program() {
  Program program = program_of(feed_of(160), long_line(184));
  driver::FeedCommand piece = feed_of(24, 6 * kTickClocks);
  piece.acceleration = static_cast<std::int64_t>((feed_of(1).rate - piece.rate) / 30);
  program.commands.insert(program.commands.begin(), piece);
  return program;
}

inline Program corner_program() {
  const driver::LineCommand first = line(24, {24, -12, 6, 3});
  const driver::LineCommand second = line(160, {-160, 80, -40, -20});
  Program program;
  program.commands = {feed_of(184), first, second, driver::EndCommand{}};
  program.paths = {path_of(first), path_of(second), kBarrier};
  return program;
}

inline Program dwell_program() {
  Program program;
  const driver::LineCommand first = line(10, {10, -5, 2, 1});
  program.commands = {feed_of(10), first, driver::DwellCommand{2500}, feed_of(160), long_line(), driver::EndCommand{}};
  program.paths = {path_of(first), kBarrier, path_of(long_line()), kBarrier};
  return program;
}

inline Program underrun_program() {
  Program program;
  driver::FeedCommand piece = feed_of(345);
  piece.stop_distance = 40;
  const driver::LineCommand first = long_line(345);
  const driver::LineCommand last = line(10, {10, 0, 0, 0});
  program.commands = {piece, first};
  program.rest = {feed_of(10), last, driver::EndCommand{}};
  program.paths = {path_of(first), path_of(last), kBarrier};
  return program;
}

inline Program probing_program() {
  Program program;
  program.commands = {driver::ProbeCommand{kProbeInput, true}, feed_of(160), long_line(), driver::ProbeEndCommand{}};
  program.paths = {path_of(long_line()), kBarrier};
  return program;
}

inline Program streaming_program() {
  Program program = program_of(feed_of(1), long_line(60));
  program.commands.pop_back();
  program.rest = {driver::EndCommand{}};
  return program;
}

inline Program direct_program() {
  Program program;
  program.direct = [](std::uint64_t clocks) {
    const auto steps = [clocks](std::uint64_t every, std::uint64_t count) {
      return static_cast<std::int32_t>(
          std::min(count, clocks == ~std::uint64_t{0} ? count : (every / 2 + clocks) / every));
    };
    return Place{steps(16, 160), -steps(32, 80), 0, 0};
  };
  return program;
}

inline Program short_program() { return program_of(feed_of(10), line(10, {10, -5, 2, 1})); }

inline Program starved_program() {
  Program program = program_of(feed_of(160), long_line());
  program.rest = {program.commands[0], program.commands[2]};
  program.commands = {program.commands[1]};
  return program;
}

inline Program silent_program() {
  constexpr std::uint64_t kSilent = 6000;
  driver::FeedCommand piece = feed_of(kSilent, 1);
  piece.rate = ~std::uint64_t{0};
  piece.silent = true;
  const driver::LineCommand whole = long_line(kSilent + 160);
  Program program;
  program.commands = {piece, feed_of(160), whole, driver::EndCommand{}};
  program.paths = {path_of(whole, kSilent), kBarrier};
  return program;
}

inline void send_rest(StopBench& bench, const Program& program) {
  for (const driver::Command& command : program.rest) bench.send(command);
}
inline void let_go(StopBench& bench, const Program&) { bench.write(reg::kHold, 0); }
inline void to_tick_20(StopBench& bench) { bench.wait_pulses(0, 20); }

inline void start_direct(StopBench& bench) {
  const auto axis = [&bench](unsigned n, unsigned every, std::uint32_t count, std::uint32_t direction) {
    const std::uint64_t frequency = (std::uint64_t{1} << 40) / every;
    bench.write(reg::frequency_lo(n), static_cast<std::uint32_t>(frequency));
    bench.write(reg::frequency_hi(n), static_cast<std::uint32_t>(frequency >> 32));
    bench.write(reg::count(n), count);
    bench.write(reg::direction(n), direction);
  };
  axis(0, 16, 160, 0);
  axis(1, 32, 80, 1);
  bench.write(reg::kLengthLo, 2560);
  bench.write(reg::kLengthHi, 0);
  bench.write(reg::kStart, 3);
  to_tick_20(bench);
}

// Makes the program once, because an arc must be recorded.
template <Program (*kMake)()>
const Program& once() {
  static const Program program = kMake();
  return program;
}

inline Program line_program() { return program_of(feed_of(160), long_line()); }

template <unsigned kAxis, int kPulses, unsigned kThenClocks = 0>
void to_pulses(StopBench& bench) {
  bench.wait_pulses(kAxis, kPulses);
  if (kThenClocks != 0) bench.host.wait(kThenClocks);
}
template <unsigned kClocks>
void for_clocks(StopBench& bench) {
  bench.host.wait(kClocks);
}
inline void hold(StopBench& bench) { bench.write(reg::kHold, 1); }
inline void to_hold(StopBench& bench) {
  to_tick_20(bench);
  hold(bench);
}
inline constexpr unsigned kToRest = kRampClocks + 100;
inline void to_rest(StopBench& bench) {
  to_hold(bench);
  bench.host.wait(kToRest);
}
inline void hold_first(StopBench& bench) {
  hold(bench);
  bench.host.wait(kToRest);
}
inline void stream(StopBench& bench) {
  bench.write(reg::kStreaming, field::kStreamingOn | 0xFF << field::kStreamingStalePeriodsShift);
}

inline void to_edge(StopBench& bench) {
  to_tick_20(bench);
  bench.set_input(kProbeInput, true);
  bench.host.wait(10);
}
inline void clear_probe(StopBench& bench, const Program&) {
  bench.set_input(kProbeInput, false);
  bench.write(reg::kControl, field::kControlProbeClear);
}

inline const std::vector<State>& states() {
  static const std::vector<State> all = [] {
    std::vector<State> list;
    const auto add = [&list](const char* name, const Program& (*program)(), void (*enter)(StopBench&),
                             void (*finish)(StopBench&, const Program&) = send_rest) -> State& {
      list.push_back({name, program, enter, finish});
      return list.back();
    };
    add("line", once<line_program>, to_tick_20);
    add("arc", once<circle_program>, to_pulses<0, 12>);
    add("arc in eight directions", once<circle_8_program>, to_pulses<0, 8>);
    add("helix", once<helix_program>, to_pulses<2, 40>);
    add("conic", once<conic_program>, to_pulses<0, 16>);
    add("ramp", once<ramp_program>, to_pulses<0, 3>);
    add("corner", once<corner_program>, to_tick_20);
    add("probing", once<probing_program>, to_tick_20).probing = true;
    add("direct mode", once<direct_program>, start_direct).alone = false;
    State& streaming = add("streaming", once<streaming_program>, to_pulses<0, 70>);
    streaming.streaming = true;
    streaming.alone = false;
    streaming.prepare = stream;
    State& reset = add("reset", once<line_program>, to_tick_20);
    reset.resets = true;
    reset.alone = false;
    // States that do not move at full ratio in their windows.
    const std::size_t moving = list.size();
    add("dwell", once<dwell_program>, to_pulses<0, 10, 150>).runs = false;
    add("slowing into a hold", once<line_program>, to_hold, let_go).alone = false;
    State& held = add("hold", once<line_program>, to_rest, let_go);
    held.at_rest = true;
    held.alone = false;
    add("slowing into an under-run", once<underrun_program>, to_pulses<0, 52>);
    add("under-run", once<underrun_program>, to_pulses<0, 52, kToRest>).at_rest = true;
    add("between commands", once<short_program>, to_pulses<0, 10, 200>).runs = false;
    State& tripped = add("stop of a probe", once<probing_program>, to_edge, clear_probe);
    tripped.probing = tripped.tripped = true;
    tripped.alone = false;
    add("path without a piece", once<starved_program>, for_clocks<100>).alone = false;
    State& silent = add("silent piece", once<silent_program>, for_clocks<300>, let_go);
    silent.prepare = hold_first;
    silent.alone = false;
    for (std::size_t i = moving; i < list.size(); ++i) list[i].moves = false;
    return list;
  }();
  return all;
}

}  // namespace trammel::test
