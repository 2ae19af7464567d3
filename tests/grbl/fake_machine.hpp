// A simulated machine in memory behind the protocol. A motion takes a few ticks. In each tick the next step of the
// test's script runs, and then the controller's own work during motions. Records the calls.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "router.hpp"
#include "trammel/gcode/reader.hpp"
#include "trammel/grbl/machine_side.hpp"

namespace trammel::grbl {

// Records the lines of a motion as they are read, including those of a preamble.
class RecordedLines final : public gcode::LineSource {
 public:
  RecordedLines(gcode::LineSource& lines, std::vector<std::string>& seen) : lines_(lines), seen_(seen) {}
  bool next(std::string_view& line) override {
    if (!lines_.next(line)) return false;
    seen_.emplace_back(line);
    return true;
  }
  const std::string& name() const override { return lines_.name(); }

 private:
  gcode::LineSource& lines_;
  std::vector<std::string>& seen_;
};

class FakeMachine final : public MachineSide {
 public:
  explicit FakeMachine(machine::Machine machine) : machine_(std::move(machine)) {}

  // Settings by the test.
  std::deque<std::function<void()>> script;  // one step per tick
  unsigned ticks_a_motion = 2;
  unsigned ticks_to_hold = 2;  // ticks from a hold to rest
  bool touched = false;        // probe contact before a probing motion
  std::optional<double> edge;  // fraction of the probing motion at which the probe trips
  End homing_end;
  End trouble_now;
  End unlock_leaves;
  std::optional<End> motion_fails;  // result of the next motion, after it has begun
  bool is_homed = true;
  double most_feed_override = 1000;
  Live live;

  // Recorded calls.
  std::vector<std::string> lines;      // lines of motions
  std::vector<gcode::Motion> motions;  // motions that have ended
  std::vector<Before> befores;         // state before each motion's first line
  std::vector<std::vector<std::size_t>> homings;
  std::vector<bool> holds;
  std::vector<double> feeds;
  std::vector<double> rapids;
  unsigned stops = 0;
  unsigned settings_taken = 0;
  unsigned idle_waits = 0;

  gcode::Coordinates at() const { return live.at; }

  const machine::Machine& machine() const override { return machine_; }
  planner::CardLimits limits() const override { return router_card(); }
  void set_machine(const machine::Machine& machine) override {
    ++settings_taken;
    machine_ = machine;
  }
  Live look() override {
    live.any_sent = true;  // no wait for a sender's next line
    live.seconds_left = 0;
    return live;
  }
  bool probe_touches() override { return touched; }
  void wait() override {
    if (!moving_) ++idle_waits;
    tick();
  }
  void set_meanwhile(std::function<void()> meanwhile) override { meanwhile_ = std::move(meanwhile); }
  void hold(bool hold) override {
    holds.push_back(hold);
    held_for_ = hold ? std::optional<unsigned>(0) : std::nullopt;
    if (!hold) live.held = false;
  }
  void stop() override {
    ++stops;
    stopping_ = moving_;
  }
  double override_feed(double percent) override {
    feeds.push_back(std::min(percent, most_feed_override));
    return feeds.back();
  }
  void override_rapids(double percent) override { rapids.push_back(percent); }

  End run(gcode::LineSource& source, const Before& before) override {
    befores.push_back(before);
    const Moving moving(*this);
    RecordedLines recorded(source, lines);
    gcode::ReaderOptions options;
    options.parameters = before.parameters;
    options.spindle = 10 * before.spindle;
    options.spindle_speed = before.speed;
    gcode::Reader reader(recorded, machine_, before.place, options);
    End end;
    for (gcode::Motion motion; reader.next(motion);) {
      if (motion_fails) return fail();
      if (motion.kind == gcode::MotionKind::kProbe) end.probe = probe(reader, motion);
      if (!move_along(motion)) {
        end.stopped = true;
        return end;
      }
    }
    if (reader.error()) end.message = gcode::describe(*reader.error());
    return end;
  }

  End home(const std::vector<std::size_t>& axes) override {
    homings.push_back(axes);
    const Moving moving(*this);
    End end = homing_end;
    for (unsigned n = 0; n < ticks_a_motion && !stopping_; ++n) tick();
    end.stopped = stopping_;
    if (!end.stopped && end.alarm == Alarm::kNone) {
      is_homed = true;
      trouble_now = {};
      live.at = {};
    }
    return end;
  }
  bool can_home() const override { return machine_.axes[0].homing.has_value(); }
  bool homed() override { return is_homed; }
  bool has_probe() const override { return true; }
  End trouble() override { return trouble_now; }
  End unlock() override {
    trouble_now = unlock_leaves;
    return trouble_now;
  }

 private:
  class Moving {
   public:
    explicit Moving(FakeMachine& machine) : machine_(machine) {
      machine_.moving_ = true;
      machine_.stopping_ = false;
    }
    ~Moving() {
      machine_.moving_ = false;
      machine_.live.held = false;
      machine_.held_for_.reset();
      machine_.live.line = 0;
    }
    Moving(const Moving&) = delete;
    Moving& operator=(const Moving&) = delete;

   private:
    FakeMachine& machine_;
  };

  End fail() {
    const End end = *motion_fails;
    motion_fails.reset();
    return end;
  }

  Probed probe(gcode::Reader& reader, gcode::Motion& motion) {
    Probed probed;
    probed.tripped = edge.has_value();
    for (std::size_t n = 0; n < motion.target.size(); ++n) {
      probed.at[n] = live.at[n] + (motion.target[n] - live.at[n]) * edge.value_or(1);
    }
    motion.target = probed.at;
    reader.probed(probed.at, probed.at, probed.tripped);
    return probed;
  }

  // Returns false if the motion was stopped; the place is then halfway.
  bool move_along(const gcode::Motion& motion) {
    const gcode::Coordinates from = live.at;
    live.line = motion.line;
    for (unsigned n = 0; n < ticks_a_motion || held_for_; ++n) {
      if (held_for_ && (*held_for_)++ == ticks_to_hold) live.held = true;
      tick();
      if (!stopping_) continue;
      for (std::size_t axis = 0; axis < from.size(); ++axis) live.at[axis] = (from[axis] + motion.target[axis]) / 2;
      return false;
    }
    live.at = motion.target;
    if (motion.kind != gcode::MotionKind::kEnd) motions.push_back(motion);
    return true;
  }

  void tick() {
    if (++ticks_ > kMostTicks) throw std::logic_error("the test waits for ever");
    if (inside_) return;
    inside_ = true;  // as on the card's bus, the hook is not called from within itself
    if (!script.empty()) {
      const std::function<void()> step = std::move(script.front());
      script.pop_front();
      step();
    }
    if (meanwhile_) meanwhile_();
    inside_ = false;
  }

  static constexpr unsigned kMostTicks = 1'000'000;

  machine::Machine machine_;
  std::function<void()> meanwhile_;
  bool moving_ = false;
  bool stopping_ = false;
  bool inside_ = false;
  std::optional<unsigned> held_for_;  // ticks since a hold was requested
  unsigned ticks_ = 0;
};

}  // namespace trammel::grbl
