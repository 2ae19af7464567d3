// A session of the panel, without the network: takes the page's messages, gives its state, and drives a Grbl
// controller. The page's buttons become Grbl's lines and real-time bytes here. Used by one thread: serve() may be
// called from within MachineSide's `meanwhile`, work() only in the outermost loop.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "trammel/grbl/controller.hpp"
#include "trammel/grbl/machine_side.hpp"
#include "trammel/grbl/settings.hpp"
#include "trammel/panel/program.hpp"

namespace trammel::panel {

// A jog ends when the page has not confirmed for this time that the key is held. A message of a jog that was in transit
// for longer is ignored.
inline constexpr std::chrono::milliseconds kDeadMan{300};
// A request for any other motion is refused if it was in transit for longer.
inline constexpr std::chrono::milliseconds kLate{2000};

class PanelSession {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Now = std::function<TimePoint()>;

  // `machine` and `settings` must outlive the session.
  PanelSession(grbl::MachineSide& machine, grbl::Settings& settings, Now now = std::chrono::steady_clock::now);

  void begin() { controller_.begin(); }

  // A page has connected; it may replace another one.
  void arrived();
  // The page has disconnected: a jog ends, and a program is held unless the page has requested otherwise.
  void left();
  // Takes a message of the page, JSON: docs/developer/panel.md.
  void receive(std::string_view message);

  // Checks the dead man's time and sends lines of the program; does not wait.
  void serve();
  // For the outermost loop: executes the next motion, homing or dwell to its end.
  void work();
  // Ends the motion on a ramp, for the end of the process.
  void stop();
  bool idle() const { return controller_.idle(); }

  // Data that do not change during the session, JSON.
  std::string hello() const;
  // The state that the page shows, JSON, with the notes after number `told`. Sets `told` to the number of the last
  // note.
  std::string state(std::uint64_t& told);
  const Program& program() const { return program_; }

 private:
  enum class Sent { kCommand, kJog, kProgram };
  struct Jog {
    std::uint64_t id = 0;
    std::size_t axis = 0;
    int way = 1;
    double step = 0;   // mm; 0: until the key is released
    double share = 0;  // fraction of the axis's max_velocity
    TimePoint held;    // time of the page's last confirmation
    bool sent = false;
  };
  struct Note {
    std::uint64_t number = 0;
    bool error = false;
    std::string text;
  };
  struct Alarm {
    int number = 0;
    std::string reason;
  };
  struct Request;

  void take(const Request& request);
  bool take_load(const Request& request);
  void take_jog(const Request& request);
  void take_start();
  void take_zero(const Request& request);
  void override_by(const Request& request);
  void realtime(std::uint8_t byte);
  bool came_late(const Request& request, std::chrono::milliseconds longest) const;
  bool is_ready(const std::string& what);

  void send(Sent kind, const std::string& line);
  void hear(const std::string& text);
  void hear_line(const std::string& line);
  void hear_answer(const std::string& line);
  void hear_message(const std::string& text);
  void reset_heard();
  void end_program(const std::string& reason);
  void serve_jog();
  void end_jog();
  std::string jog_line(const Jog& jog) const;
  void check_program();
  void feed_program();
  void note(const std::string& text, bool error = false);
  std::int64_t milliseconds() const;

  grbl::MachineSide& machine_;
  Now now_;
  TimePoint begun_;
  Program program_;
  std::string heard_;  // an incomplete answer of the controller
  std::deque<Sent> sent_;
  std::deque<std::string> commands_;  // commands that work() sends, because they may move the machine
  std::optional<Jog> jog_;
  std::uint64_t last_jog_ = 0;  // number of the last jog that has ended or was refused
  std::deque<Note> notes_;
  std::uint64_t noted_ = 0;
  Alarm alarm_;
  bool hold_when_gone_ = true;
  bool page_ = false;
  std::optional<grbl::Interpreter> check_;  // interpreter for the check of the program before its start
  std::size_t line_ = 0;                    // program line that has begun last
  bool homed_ = false;
  TimePoint homed_at_;  // time at which `homed_` was read
  grbl::Controller controller_;
};

}  // namespace trammel::panel
