// A Grbl 1.1h controller: takes a sender's bytes, gives Grbl's answers and drives a machine. The caller passes on bytes
// with receive() as they arrive, also from within MachineSide's `meanwhile`, and calls work() in a loop. Used by one
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

// Size of Grbl's planner: lines that are accepted and not yet taken by a motion.
inline constexpr std::size_t kPlannerBlocks = 15;

class Controller {
 public:
  using Write = std::function<void(const std::string& text)>;

  // `machine`, `settings` and the target of `write` must outlive the controller.
  Controller(MachineSide& machine, Settings& settings, Write write);

  // Writes the banner, as after power-up.
  void begin();
  void receive(std::string_view bytes) { input_.put(bytes); }
  // Answers all lines that it can answer without waiting; may be called from `meanwhile`.
  void serve();
  // Calls serve(), then executes the next motion, homing or dwell to its end; if there is none, waits for a moment.
  void work();

  State state() const { return state_; }
  // The content of the answer to '?'.
  Report report_now();
  // The parser state after the lines accepted so far.
  const Interpreter& interpreter() const { return interpreter_; }
  // Whether nothing is in progress or waiting.
  bool idle() const { return !executing_ && queue_.empty() && !alone_ && !waiting_ && !reset_ && !input_.has_bytes(); }

 private:
  friend class SectionLines;
  struct Accepted {
    std::string preamble;  // lines that restore the parser state, for a section that begins with this one
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

  // Returns true when the line is finished; false if it must wait for the work in progress.
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
  machine::Machine shape_;  // copy of the machine side's present machine, for the interpreter
  InputBuffer input_;
  Interpreter interpreter_;
  StatusReport status_;
  State state_ = State::kIdle;
  State before_hold_ = State::kIdle;
  std::deque<Accepted> queue_;
  std::vector<int> numbers_;            // N words of the section's lines, in order
  std::optional<std::string> waiting_;  // a line to take when all earlier ones are done
  std::optional<Accepted> alone_;       // an accepted line that is answered when it is done
  bool answer_at_resume_ = false;       // M0 is answered at the resume
  bool executing_ = false;              // in a motion of the machine
  bool executing_alone_ = false;        // in the motion of a line that is answered when it is done
  bool switched_ = false;               // a line has switched an output since all were switched off
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
