// A Grbl 1.1h controller: a sender's bytes in, Grbl's answers out, a machine behind it. The caller gives bytes with
// receive() whenever some have come, also from within MachineSide's `meanwhile`, and calls work() in a loop. One thread.
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

 private:
  friend class SectionLines;
  struct Accepted {
    std::string text;
    std::string before;  // the lines that a section needs that begins with it
    int number = 0;
    bool moves = false;
    std::map<int, double> parameters;  // in force before it
    gcode::Coordinates place{};        // likewise
  };

  void realtime(std::uint8_t byte);
  void override_by(std::uint8_t byte);
  void request_reset();
  void request_hold(State state);
  void resume();
  void finish_reset();
  void raise(Alarm alarm);

  // Whether the line is done with; else it stays for work().
  bool take(const std::string& line);
  void take_code(const std::string& line);
  void take_jog(const std::string& line);
  void execute_waiting();
  void probe(const Accepted& line);
  void system(const std::string& line);
  Status system_status(const std::string& line);
  Status set_line(const std::string& line);
  Status startup_line(const std::string& line);
  Status restore(char what);
  Status home(const std::string& line);
  Status unlock();
  Status toggle_check();
  void run_startup();
  void run_section();
  void ended(const End& end);
  void apply_settings();

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
  std::vector<int> numbers_;  // N words of the section's lines, by line
  Block block_;
  std::optional<std::string> waiting_;  // a line that waits until all before it is done
  std::optional<Accepted> to_execute_;
  bool executing_ = false;  // within work()'s motion
  bool reset_ = false;
  bool stopping_jog_ = false;
  Alarm pending_alarm_ = Alarm::kNone;
  Probed probed_;
  std::chrono::steady_clock::time_point last_line_;
  double feed_override_ = 100;
  double rapid_override_ = 100;
  int spindle_override_ = 100;
};

}  // namespace trammel::grbl
