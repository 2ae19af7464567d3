// What the panel's page does to the machine, without a network: the page's messages in, its state out, a Grbl
// controller behind it. The page's buttons become Grbl's lines and real-time bytes here. One thread: serve() may be
// called from within MachineSide's `meanwhile`, work() in a loop around everything.
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

// A jog ends when the page has not said for so long that the key is held; a message of a jog that was under way for
// longer counts for nothing.
inline constexpr std::chrono::milliseconds kDeadMan{300};
// A request for another motion that was under way for longer is refused.
inline constexpr std::chrono::milliseconds kLate{2000};

class PanelSession {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Now = std::function<TimePoint()>;

  // `machine` and `settings` must outlive it.
  PanelSession(grbl::MachineSide& machine, grbl::Settings& settings, Now now = std::chrono::steady_clock::now);

  void begin() { controller_.begin(); }

  // A page is there. It may take the place of another one.
  void arrived();
  // No page is there any more: a jog ends, and a program is held unless the page wanted otherwise.
  void left();
  // A message of the page, JSON: docs/developer/panel.md.
  void receive(std::string_view message);

  // The dead man, and lines of the program; waits for nothing.
  void serve();
  // Around everything: the motion, homing or dwell that is due, to its end.
  void work();
  // Ends the motion on a ramp, as at the end of the process.
  void stop();
  bool idle() const { return controller_.idle(); }

  // What does not change while the session lasts, JSON.
  std::string hello() const;
  // What the page shows, JSON; with the notes behind number `told`, which then is the last one's.
  std::string state(std::uint64_t& told);
  const Program& program() const { return program_; }

 private:
  enum class Sent { kCommand, kJog, kProgram };
  struct Jog {
    std::uint64_t id = 0;
    std::size_t axis = 0;
    int way = 1;
    double step = 0;   // mm; 0: until it is let go
    double share = 0;  // of the axis's max_velocity
    TimePoint held;    // when the page said so last
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
  std::string heard_;  // an answer that is not whole yet
  std::deque<Sent> sent_;
  std::deque<std::string> commands_;  // that work() sends: they may move
  std::optional<Jog> jog_;
  std::uint64_t last_jog_ = 0;  // number of the last one that has ended or was refused
  std::deque<Note> notes_;
  std::uint64_t noted_ = 0;
  Alarm alarm_;
  bool hold_when_gone_ = true;
  bool page_ = false;
  std::optional<grbl::Interpreter> check_;  // of the program that is to start
  std::size_t line_ = 0;                    // of the program, that has begun last
  bool homed_ = false;
  TimePoint homed_at_;  // when it was asked
  grbl::Controller controller_;
};

}  // namespace trammel::panel
