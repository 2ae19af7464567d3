// A Grbl 1.1h controller: a sender's bytes in, Grbl's answers out, a machine behind it. The caller gives bytes with
// receive() whenever some have come, also from within MachineSide's `meanwhile`, and calls work() in a loop. One
// thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "trammel/grbl/input_buffer.hpp"
#include "trammel/grbl/interpreter.hpp"
#include "trammel/grbl/machine_side.hpp"
#include "trammel/grbl/settings.hpp"
#include "trammel/grbl/status_report.hpp"

namespace trammel::grbl {

enum class State { kIdle, kRun, kHold, kJog, kAlarm, kHome, kCheck, kSleep, kDoor };

// As Grbl's planner: lines that are accepted and not yet taken by a motion.
inline constexpr std::size_t kPlannerBlocks = 15;

class Controller {
 public:
  using Write = std::function<void(const std::string& text)>;

  // All must outlive the controller.
  Controller(MachineSide& machine, Settings& settings, Write write);

  // The banner, as after power-up.
  void begin();
  void receive(std::string_view bytes) { input_.put(bytes); }
  // Answers what it may now, without waiting; for `meanwhile`, too.
  void serve();
  // serve(), then the motion, homing or dwell that is due, to its end; waits for a moment where nothing is.
  void work();

  State state() const { return state_; }
  // What the answer to '?' says.
  Report report_now();
  // Behind the lines that were accepted so far.
  const Interpreter& interpreter() const { return interpreter_; }
  // Nothing is under way or waits to be done.
  bool idle() const { return !executing_ && queue_.empty() && !alone_ && !waiting_ && !reset_ && !input_.has_bytes(); }

 private:
  friend class SectionLines;
  struct Accepted {
    std::string preamble;  // lines that a section needs that begins with this one
    Block block;
    Before before;
  };

  void realtime(std::uint8_t byte);
  void override_by(std::uint8_t byte);
  void request_reset();
  void request_hold(State state);
  void resume();
  void cancel_jog();
  void finish_reset();
  void finish_jog();
  void restore_overrides();
  void raise(Alarm alarm, const std::string& message = {});
  void drop_lines();

  // Whether the line is done with; else it waits for what is under way.
  bool take(const std::string& line, bool at_rest = false);
  void take_code(const std::string& line);
  void take_jog(const std::string& line);
  Accepted accepted() const;
  void execute();
  bool run_alone(const Accepted& line);
  bool probe(const Accepted& line);
  void system(const std::string& line);
  Status system_status(const std::string& line);
  Status short_status(char what);
  Status still_status(const std::string& line);
  Status set_line(const std::string& line);
  Status startup_line(const std::string& line);
  Status restore(char what);
  Status home(const std::string& line);
  Status unlock();
  Status toggle_check();
  void run_startup();
  void run_section();
  void ended(const End& end);
  void switch_off();
  void see_safe_outputs();
  void apply_settings();
  bool held() const { return state_ == State::kHold || state_ == State::kDoor || state_ == State::kSleep; }

  std::string offsets_text() const;
  std::string probe_text() const;
  void report();
  std::string coordinates_text(const gcode::Coordinates& at) const;
  void answer(Status status);
  void say(const std::string& text) { write_(text + "\r\n"); }

  MachineSide& machine_;
  Settings& settings_;
  Write write_;
  machine::Machine shape_;  // for the interpreter: as the machine side has it now
  InputBuffer input_;
  Interpreter interpreter_;
  StatusReport status_;
  State state_ = State::kIdle;
  State before_hold_ = State::kIdle;
  std::deque<Accepted> queue_;
  std::vector<int> numbers_;            // N words of the section's lines, by line
  std::optional<std::string> waiting_;  // a line that is taken when all before it is done
  std::optional<Accepted> alone_;       // an accepted one that is answered when it is done
  bool answer_at_resume_ = false;       // of M0
  bool executing_ = false;              // within a motion of the machine
  bool executing_alone_ = false;        // of a line that is answered when it is done
  bool switched_ = false;               // an output, by a line, since all were switched off
  bool reset_ = false;
  bool cancelling_jog_ = false;
  Alarm pending_alarm_ = Alarm::kNone;
  Probed probed_;
  std::chrono::steady_clock::time_point last_line_;
  double feed_override_ = 100;
  double rapid_override_ = 100;
  int spindle_override_ = 100;
};

}  // namespace trammel::grbl
