// One stop, from its cause to the card's next move, judged by the pins and the answers of the register port. The
// judge knows the program, the cause and docs/reference/behaviour.md; it sees neither the golden model nor an
// internal signal of the design.
#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include "stop_outputs.hpp"
#include "trammel/sim/lockstep.hpp"

namespace trammel::test {

class StopJudge {
 public:
  // `struck`: the clock of a cause that comes by itself.
  StopJudge(StopBench& bench, const StopCase& of, std::optional<std::uint64_t> struck)
      : bench_(bench), case_(of), struck_(struck.value_or(0)) {}

  // Throws lockstep::Mismatch with the first claim that fails. Returns true if a fault stopped the card.
  bool run() {
    if (case_.state.resets) return run_with_reset();
    if (!case_.cause.of_program() && !case_.cause.timed()) {
      bench_.host.wait(case_.clock);
      strike();
    }
    switch (case_.cause.effect(case_.state)) {
      case Effect::kHold:
        judge_hold();
        break;
      case Effect::kCut:
        judge_cut();
        return false;
      default:
        break;
    }
    const bool stopped = follow();
    stopped ? judge_stop() : judge_end();
    return stopped;
  }

 private:
  // From an immediate stop to the leading edge of the last pulse: two ticks in flight, at most 32 clocks apart, and a
  // wait for the times of an axis.
  static constexpr std::uint64_t kAtOnceClocks = 80;
  // On a ramp from full ratio the path continues at least this long: its last tick may come before the rest.
  static constexpr std::uint64_t kRampAtLeast = 400;
  // In addition to the ramp itself: from cause to ramp, the last ticks, waits.
  static constexpr std::uint64_t kRampMargin = 200;
  static constexpr std::uint64_t kQuietClocks = 600;
  static constexpr unsigned kResetClock = 64;        // clock of the window in which the reset comes
  static constexpr std::uint64_t kSecondCause = 90;  // clocks after the first cause, when that must be latched
  static constexpr unsigned kTicksInFlight = 3;

  void claim(bool holds, const std::string& what) const {
    if (!holds) throw lockstep::Mismatch("a stop is wrong (" + case_.name() + "): " + what + "\n");
  }
  template <class A, class B>
  void claim_equal(const A& is, const B& must, const std::string& what) const {
    claim(is == static_cast<A>(must), what + " is " + text(is) + ", not " + text(static_cast<A>(must)));
  }
  // `wrong`: a description of the error, empty if there is none.
  void claim_nothing(const std::string& wrong) const { claim(wrong.empty(), wrong); }
  StopTimes times() const { return {struck_, stop_time_, rest_time_, second_ != 0}; }
  void judge_place(const char* when) {
    const std::string wrong = wrong_place(bench_.read(reg::kPlace), watch(), times(), case_);
    claim(wrong.empty(), wrong + " " + when);
  }
  void judge_unlost_place(const char* when) {
    claim_equal(bench_.read(reg::kPlace), (field::kPlaceHomed & 0xF00U) | 0xFU, std::string("PLACE ") + when);
  }
  static std::string text(std::uint64_t number) { return std::to_string(number); }
  static std::string text(const Place& place) {
    std::string all;
    for (const std::int32_t pulses : place) all += (all.empty() ? "" : " ") + std::to_string(pulses);
    return all;
  }
  // The card counts clocks since its reset, the watch since the card was made.
  std::uint64_t watch_time(std::uint64_t time) const { return time + reset_; }

  Place read_place(std::uint32_t first) {
    Place place{};
    for (unsigned n = 0; n < kWatchedAxes; ++n) place[n] = static_cast<std::int32_t>(bench_.read(first + 4 * n));
    return place;
  }
  std::uint32_t status() { return bench_.read(reg::kStatus); }
  const PinWatch& watch() const { return bench_.watch; }

  void strike() {
    struck_ = bench_.now();
    if (const auto* input = std::get_if<Input>(&case_.cause.strike)) bench_.set_input(*input, true);
    if (const auto* write = std::get_if<Write>(&case_.cause.strike)) bench_.write(write->address, write->value);
  }
  void end_cause() {
    if (const auto* input = std::get_if<Input>(&case_.cause.strike)) bench_.set_input(*input, false);
    if (case_.cause.end != nullptr) case_.cause.end(bench_);
    bench_.host.wait(140);
  }
  void second_cause() {
    if (case_.clock % 4 != 2 || second_ != 0 || case_.cause.fault == field::kFaultDriveFault) return;
    if ((bench_.read(reg::kFault) & case_.cause.fault) == 0) return;
    second_ = bench_.now();
    bench_.set_input(kDriveInput, true);
    bench_.host.wait(kRoleLatest + 4);
  }

  // Runs until the rest after a stop, or the program's end. Inputs that the program waits for come after the cause's
  // latest time. Returns true if stopped.
  bool follow() {
    if (case_.cause.of_silence && bench_.now() < struck_ + case_.cause.latest)
      bench_.host.wait(struck_ + case_.cause.latest - bench_.now());
    const std::uint64_t until = bench_.now() + 40'000;
    bool finished = case_.cause.of_program() || finished_by_hold_;
    while (bench_.now() < until) {
      const std::uint32_t now = status();
      if ((now & field::kStatusFaulted) != 0) {
        second_cause();
        if ((status() & field::kStatusStopping) == 0) return true;
      } else if (!finished && bench_.now() > struck_ + 300) {
        finished = true;
        case_.state.finish(bench_, case_.program);
      } else if (finished && (now & field::kStatusBusy) == 0) {
        return false;
      }
      bench_.host.wait(15);
    }
    claim(false, "neither a stop nor the program's end comes");
    return false;
  }

  // Claims that hold after every case.
  void judge_pins() { claim(watch().error.empty(), watch().error); }
  void claim_still(std::uint64_t since, const std::string& when) {
    claim(watch().last_change <= since, "a pin moves " + when);
  }
  void judge_position(const std::string& when) {
    bench_.write(reg::kControl, field::kControlSnapshot);
    const std::uint64_t before = bench_.now();
    claim_equal(read_place(reg::snap_position(0)), watch().place, "POSITION " + when);
    const std::uint64_t time = watch_time(bench_.read_pair(reg::kSnapTimeLo, reg::kSnapTimeHi));
    claim(time + 4 > before && time <= before + 4, "the snapshot's time is " + text(time) + " at " + text(before));
  }

  void judge_expected(bool stopped) {
    const Cause& cause = case_.cause;
    Effect effect = cause.effect(case_.state);
    if (case_.reaction == Reaction::kOff) effect = Effect::kNothing;
    if (effect == Effect::kStop) claim(stopped, "the cause does not stop the card");
    if (effect == Effect::kNothing || effect == Effect::kHold) claim(!stopped, "something stops the card");
    if (effect != Effect::kByPulses) return;
    const auto into = [&](std::uint64_t from) {
      return std::any_of(watch().pulses.begin(), watch().pulses.end(), [&](const Pulse& pulse) {
        return pulse.clock > from && pulse.axis == cause.axis && pulse.direction == cause.direction;
      });
    };
    if (stopped) claim(into(struck_), "a limit stops the card without a step into it");
    // If the level is a role, a path step is at most this late at its pin.
    if (!stopped) claim(!into(struck_ + kRoleLatest + 40), "a step into the limit does not stop the card");
  }

  void judge_end() {
    judge_pins();
    judge_expected(false);
    claim_equal(bench_.read(reg::kFault), 0U, "FAULT");
    bench_.host.wait(150);
    judge_end_point();
    claim_nothing(changed_outputs(watch(), struck_));
    judge_unlost_place("at the program's end");
    judge_position("at the program's end");
    end_cause();
    live_on();
  }

  // A streamed line may continue any distance beyond its end; a probe ends a line before its end.
  void judge_end_point() {
    const Program& program = case_.program;
    if (!case_.state.streaming && !case_.state.tripped)
      return claim_equal(watch().place, program.end(), "the program's end");
    judge_on_line(case_.state.streaming ? program.paths[0].ticks : 0);
  }
  void judge_on_line(std::uint64_t ticks) {
    const Path& path = case_.program.paths[0];
    while (ticks < 10'000 && path.after(ticks) != watch().place) ++ticks;
    claim(ticks < 10'000, "the program ends beside its line: " + text(watch().place));
  }

  // STOP: only the first cause, its time, the positions at the pins then, the commands begun.
  void judge_stop_area() {
    const Cause& cause = case_.cause;
    const std::uint32_t fault = bench_.read(reg::kStopFault);
    claim(fault != 0 && (fault & ~cause.fault) == 0, "STOP_FAULT is " + text(fault));
    stop_time_ = watch_time(bench_.read_pair(reg::kStopTimeLo, reg::kStopTimeHi));
    if (cause.latest != 0) {
      claim(stop_time_ >= struck_ + cause.soonest,
            "latched too soon: " + text(stop_time_) + ", struck " + text(struck_));
      claim(stop_time_ <= struck_ + cause.latest, "latched late: " + text(stop_time_) + ", struck " + text(struck_));
    }
    claim(stop_time_ >= struck_ || cause.of_program(), "latched before the cause");
    const Place place = read_place(reg::stop_position(0));
    claim_equal(place, watch().place_at(stop_time_), "STOP_POSITION at " + text(stop_time_));
    judge_begun(bench_.read(reg::kStopGeometryBegun), place, "STOP_GEOMETRY_BEGUN");
    const std::uint32_t pieces = bench_.read(reg::kStopFeedBegun);
    claim(pieces <= bench_.read(reg::kRestFeedBegun) && pieces <= case_.program.commands.size(), "STOP_FEED_BEGUN");
    if (!case_.program.direct && place != Place{}) claim(pieces != 0, "STOP_FEED_BEGUN is 0 in motion");
  }
  // The path of the command begun last goes through the position, except for ticks that are not at the pins yet.
  void judge_begun(std::uint32_t begun, const Place& place, const char* what) const {
    const Program& program = case_.program;
    if (case_.state.tripped) return;
    if (program.direct) return claim_equal(begun, 0U, what);
    claim(begun <= program.paths.size(), std::string(what) + " is " + text(begun));
    const std::uint64_t beyond = case_.state.streaming ? 300 : 0;
    const std::uint64_t ticks = begun == 0 ? 0 : program.paths[begun - 1].ticks + beyond;
    // The position after `tick` ticks of it; negative: in the commands before it.
    const auto at = [&](std::int64_t tick) {
      std::uint32_t number = begun;
      while (tick < 0 && number > 1) tick += static_cast<std::int64_t>(program.paths[--number - 1].ticks);
      return program.at(number, static_cast<std::uint64_t>(std::max<std::int64_t>(tick, 0)));
    };
    for (auto tick = -std::int64_t{kTicksInFlight}; tick <= static_cast<std::int64_t>(ticks); ++tick) {
      bool fits = true;
      for (unsigned n = 0; n < kWatchedAxes; ++n) {
        const auto ahead = std::min<std::int64_t>(tick + kTicksInFlight, static_cast<std::int64_t>(ticks));
        const std::int32_t from = at(tick)[n];
        const std::int32_t to = at(ahead)[n];
        fits = fits && place[n] >= std::min(from, to) && place[n] <= std::max(from, to);
      }
      if (fits) return;
    }
    claim(false, std::string(what) + " is " + text(begun) + " at the place " + text(place));
  }

  // REST is filled when nothing moves any more: positions, and the ticks that make them.
  void judge_rest_area(std::uint32_t fault) {
    claim((bench_.read(reg::kRestStatus) & field::kStatusSettled) != 0, "REST_STATUS is not settled");
    rest_time_ = watch_time(bench_.read_pair(reg::kRestTimeLo, reg::kRestTimeHi));
    claim(rest_time_ > stop_time_ && rest_time_ <= bench_.now(), "REST_TIME is " + text(rest_time_));
    // REST_FAULT includes the second cause if that had come by then.
    const std::uint32_t at_rest = bench_.read(reg::kRestFault);
    const bool second_may = second_ != 0 && rest_time_ >= second_ + kRoleSoonest;
    const bool second_must = second_ != 0 && rest_time_ > second_ + kRoleLatest + kRoleToStop;
    const std::uint32_t alone = fault & ~field::kFaultDriveFault;
    claim((second_may && at_rest == fault) || (!second_must && at_rest == (second_ != 0 ? alone : fault)),
          "REST_FAULT is " + text(at_rest));
    claim_still(rest_time_, "after REST");
    const Place place = read_place(reg::rest_position(0));
    claim_equal(place, watch().place, "REST_POSITION");
    if (!(case_.cause.loses_steps && case_.reaction == Reaction::kRamp)) judge_ticks(place);
  }
  void judge_ticks(const Place& place) {
    if (case_.state.tripped) return judge_on_line(0);
    const std::uint64_t left = bench_.read_pair(reg::kRestTicksLeftLo, reg::kRestTicksLeftHi);
    const std::uint32_t begun = bench_.read(reg::kRestGeometryBegun);
    const Program& program = case_.program;
    if (program.direct) {
      const bool runs = (bench_.read(reg::kRestStatus) & field::kStatusDirect) != 0;
      return claim_equal(place, program.direct(runs ? kDirectClocks - left : ~std::uint64_t{0}),
                         "the place of REST's clocks");
    }
    claim(begun <= program.paths.size(), "REST_GEOMETRY_BEGUN is " + text(begun));
    const std::uint64_t ticks = begun == 0 ? 0 : program.paths[begun - 1].ticks;
    claim(left <= ticks, text(left) + " ticks are left of " + text(ticks));
    const std::uint64_t stale = case_.state.streaming ? bench_.read(reg::kStaleTicks) : 0;
    const std::uint64_t taken = ticks - left + stale;
    claim_equal(place, program.at(begun, taken),
                "the place of " + text(taken) + " ticks of command " + text(begun) + " (REST)");
  }

  void judge_reaction() {
    const std::uint64_t last = watch().pulses.empty() ? 0 : watch().pulses.back().clock;
    const std::uint64_t lasts = last > stop_time_ ? last - stop_time_ : 0;
    const std::uint64_t waits = case_.cause.loses_steps ? kWaitingSteps : 0;
    const bool at_once = case_.reaction == Reaction::kAtOnce;
    if (at_once)
      claim(lasts <= kAtOnceClocks + waits, "pulses come for " + text(lasts) + " clocks after a stop at once");
    if (case_.reaction == Reaction::kRamp || case_.reaction == Reaction::kShortRamp)
      claim(lasts <= kRampClocks + kRampMargin + waits, "pulses come for " + text(lasts) + " clocks of a ramp");
    if (case_.reaction == Reaction::kRamp && case_.state.moves && second_ == 0)
      claim(lasts >= kRampAtLeast, "the ramp ends after " + text(lasts) + " clocks");
    if (case_.cause.direction == 0) return;
    const auto into = std::count_if(watch().pulses.begin(), watch().pulses.end(), [&](const Pulse& pulse) {
      return pulse.clock + 2 > stop_time_ && pulse.axis == case_.cause.axis && pulse.direction == case_.cause.direction;
    });
    claim(at_once ? into <= 2 : case_.reaction != Reaction::kShortRamp || into <= kShortOvertravel + 2,
          text(static_cast<std::uint64_t>(into)) + " steps into the limit");
  }

  void judge_stop() {
    judge_pins();
    const std::uint32_t fault = bench_.read(reg::kFault);
    const std::uint32_t others = second_ != 0 ? field::kFaultDriveFault : 0;
    claim((fault & case_.cause.fault) != 0, "FAULT is " + text(fault));
    if (!case_.cause.loses_steps) claim((fault & ~case_.cause.fault) == others, "FAULT is " + text(fault));
    judge_expected(true);
    judge_stop_area();
    judge_rest_area(fault);
    judge_reaction();
    claim_nothing(wrong_outputs_of_a_stop(watch(), times(), case_));
    judge_place("after the stop");
    claim_equal(status() & (field::kStatusBusy | field::kStatusStopping), 0U, "STATUS busy or stopping after the stop");
    claim_equal(bench_.read(reg::kGeometryBegun) | bench_.read(reg::kFeedBegun), 0U, "commands begun after the stop");
    claim_equal(bench_.read(reg::kGeometryRoom), bench_.read(reg::kGeometryDepth), "GEOMETRY_ROOM");
    claim_equal(bench_.read(reg::kFeedRoom), bench_.read(reg::kFeedDepth), "FEED_ROOM");
    judge_position("after the stop");
    claim(!bench_.host.write(reg::kStream, 0x0101), "a word is taken while a fault stands");
    judge_clearing();
    live_on();
  }

  // Clearing moves nothing, and removes only causes that may be removed.
  void judge_clearing() {
    const Cause& cause = case_.cause;
    constexpr std::uint32_t kAll = 0x7FFFF;
    if (case_.clock % 2 == 0) bench_.write(reg::kControl, field::kControlAbort);
    if (second_ != 0) {
      bench_.set_input(kDriveInput, false);
      bench_.host.wait(140);
    }
    bench_.write(reg::kFault, kAll);
    bench_.host.wait(4);
    const std::uint32_t lasts = bench_.read(reg::kFault);
    claim_equal(lasts, cause.cleared_while_it_lasts ? 0U : cause.fault, "FAULT while the cause lasts, cleared,");
    bench_.host.wait(kQuietClocks);
    claim_still(rest_time_, "when faults are cleared");
    if (!cause.cleared_while_it_lasts) {
      end_cause();
      claim_equal(bench_.read(reg::kFault), cause.fault, "FAULT before it is cleared");
      bench_.write(reg::kFault, kAll);
      bench_.host.wait(4);
      claim_equal(bench_.read(reg::kFault), 0U, "FAULT of a cause that has ended, cleared,");
    } else if (cause.end != nullptr) {
      cause.end(bench_);
    }
    if (case_.clock % 2 != 0) bench_.write(reg::kControl, field::kControlAbort);
    bench_.write(reg::kHold, 0);
    bench_.write(reg::kStreaming, 0);
    bench_.host.wait(kQuietClocks);
    claim_still(rest_time_, "when a hold is taken back behind a stop");
    claim_equal(status() & field::kStatusBusy, 0U, "STATUS.busy after clearing");
  }

  // The card accepts the next program: it moves away from the limits, which stay active.
  void live_on() {
    bench_.write(reg::kHold, 0);
    bench_.write(reg::kStreaming, 0);
    bench_.write(reg::kControl, field::kControlAbort);
    bench_.write(reg::kSlew, 0xFFFFFFF);
    bench_.number = 0;
    const Place before = watch().place;
    const driver::LineCommand away = line(6, {-6, 6, 6, -6});
    claim(bench_.send(feed_of(6)) && bench_.send(away) && bench_.send(driver::EndCommand{}),
          "the next program is refused: REFUSAL " + text(bench_.read(reg::kRefusal)));
    bench_.host.wait(400);
    claim((status() & (field::kStatusEnded | field::kStatusFaulted)) == field::kStatusEnded,
          "the next program does not end");
    Place after = before;
    Program::add(after, {-6, 6, 6, -6});
    claim_equal(watch().place, after, "the next program's end");
    judge_position("after the next program");
    judge_pins();
  }

  // The feed hold button: no fault; the card is stationary until cycle start, even after the button is released.
  void judge_hold() {
    bench_.host.wait(kRoleLatest + 8);
    claim((status() & field::kStatusButtonHold) != 0, "STATUS.button_hold is 0");
    const std::uint64_t rest = struck_ + kRoleLatest + kRampClocks + kRampMargin;
    while (bench_.now() < rest + kQuietClocks) bench_.host.wait(1);
    claim_still(rest, "in a hold");
    if (case_.state.moves) claim(watch().pulses.back().clock >= struck_ + kRampAtLeast, "the hold has no ramp");
    claim_equal(bench_.read(reg::kFault), 0U, "FAULT in a hold");
    claim((status() & field::kStatusHeld) != 0, "STATUS.held is 0 in a hold");
    claim_nothing(changed_outputs(watch(), struck_));
    judge_unlost_place("in a hold");
    judge_position("in a hold");
    bench_.set_input(kFeedHoldInput, false);
    bench_.host.wait(kRoleLatest + 10);
    case_.state.finish(bench_, case_.program);
    bench_.host.wait(kQuietClocks);
    claim_still(rest, "when the button is free, before cycle start");
    bench_.set_input(kCycleStartInput, true);
    bench_.host.wait(kRoleLatest + 10);
    bench_.set_input(kCycleStartInput, false);
    finished_by_hold_ = true;
  }

  // An abort cuts: pulses in flight still reach the pins, soon; REST tells whether it is exact.
  void judge_cut() {
    const bool was_busy = std::string(case_.state.name) != "between commands";
    const std::uint64_t cut = bench_.now();
    bench_.host.wait(150);
    claim_equal(status() & field::kStatusBusy, 0U, "STATUS.busy after an abort");
    const std::uint64_t quiet = bench_.now();
    bench_.host.wait(kQuietClocks);
    claim_still(quiet, "after an abort");
    claim_equal(bench_.read(reg::kFault), 0U, "FAULT after an abort");
    judge_pins();
    claim_nothing(wrong_outputs_of_a_cut(watch(), struck_, cut + kOutputSlack));
    stop_time_ = struck_;
    judge_place("after an abort");
    judge_position("after an abort");
    if (was_busy) judge_rest_of_a_cut(cut);
    live_on();
  }
  void judge_rest_of_a_cut(std::uint64_t cut) {
    claim_equal(bench_.read(reg::kRestFault), 0U, "REST_FAULT after an abort");
    rest_time_ = watch_time(bench_.read_pair(reg::kRestTimeLo, reg::kRestTimeHi));
    claim(rest_time_ + 8 > struck_ && rest_time_ <= cut + 4, "REST_TIME of an abort is " + text(rest_time_));
    const Place place = read_place(reg::rest_position(0));
    claim_equal(place, watch().place_at(rest_time_), "REST_POSITION of an abort");
    judge_begun(bench_.read(reg::kRestGeometryBegun), place, "REST_GEOMETRY_BEGUN of an abort");
    const bool settled = (bench_.read(reg::kRestStatus) & field::kStatusSettled) != 0;
    if (case_.state.at_rest) claim(settled, "an abort at rest is not settled");
    if (settled) {
      claim_still(rest_time_, "after a settled REST");
      judge_ticks(place);
    } else {
      claim_equal(bench_.read_pair(reg::kRestTicksLeftLo, reg::kRestTicksLeftHi), 0U,
                  "TICKS_LEFT of an unsettled REST");
    }
  }

  // A reset comes in the window, before or after the cause: pulses may be cut, and nothing remains of the program or
  // the cause.
  bool run_with_reset() {
    const unsigned before = std::min(case_.clock, kResetClock);
    bench_.host.wait(before);
    if (case_.clock < kResetClock) strike_before(kResetClock - case_.clock);
    judge_pins();
    bench_.watch.end();
    bench_.host.reset(1 + case_.clock % 3);
    reset_ = bench_.now() + 1;  // it takes effect one clock later
    bench_.host.wait(4);
    const std::uint64_t reset = bench_.now();
    if (case_.clock >= kResetClock) {
      bench_.host.wait(case_.clock - kResetClock);
      strike();
    }
    bench_.host.wait(kQuietClocks);
    claim_still(reset, "after a reset");
    claim_equal(bench_.read(reg::kFault), case_.cause.outlives_reset ? case_.cause.fault : 0U, "FAULT after a reset");
    claim_equal(status() & (field::kStatusBusy | field::kStatusStopping), 0U, "STATUS after a reset");
    bench_.write(reg::kControl, field::kControlSnapshot);
    claim_equal(read_place(reg::snap_position(0)), Place{}, "POSITION after a reset");
    if (const auto* input = std::get_if<Input>(&case_.cause.strike)) bench_.set_input(*input, false);
    bench_.host.wait(8);
    bench_.write(reg::kFault, case_.cause.fault);
    bench_.set_up();
    bench_.watch.place = {};
    bench_.watch.pulses.clear();
    live_on();
    return false;
  }
  // The reset may cut a register write.
  void strike_before(std::uint64_t clocks) {
    const auto* write = std::get_if<Write>(&case_.cause.strike);
    if (write == nullptr) {
      strike();
      return bench_.host.wait(clocks);
    }
    WatchedCard::Inputs in;
    in.pins = bench_.host.pins();
    in.awvalid = in.wvalid = in.bready = true;
    in.wstrb = model::Axi4LitePort::kAllStrobes;
    in.awaddr = write->address;
    in.wdata = write->value;
    bool taken = false;
    for (; clocks != 0; --clocks) {
      taken = taken || bench_.card().bus().awready;
      bench_.card().run(in, 1);
      if (taken) in.awvalid = in.wvalid = false;
    }
  }

  static constexpr std::uint64_t kDirectClocks = 2560;

  StopBench& bench_;
  const StopCase& case_;
  std::uint64_t reset_ = 0;
  std::uint64_t struck_;
  std::uint64_t second_ = 0;
  std::uint64_t stop_time_ = 0;
  std::uint64_t rest_time_ = 0;
  bool finished_by_hold_ = false;
};

}  // namespace trammel::test
