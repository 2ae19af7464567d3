// Execution of a program's lines. Internal to the reader.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "cycles.hpp"
#include "modal_state.hpp"
#include "offsets.hpp"
#include "parameters.hpp"
#include "tools.hpp"
#include "trammel/gcode/motion.hpp"
#include "word_set.hpp"

namespace trammel::gcode {

// The motions of one line. Only drilling cycles and splines make many; the memory then grows once.
class LineMotions {
 public:
  void clear() { motions_.clear(); }
  // Adds a motion to be filled in; the reference is valid until the next call.
  Motion& add(MotionKind kind, std::size_t line) {
    Motion& motion = motions_.emplace_back();
    motion.kind = kind;
    motion.line = line;
    return motion;
  }
  void cut(std::size_t size) { motions_.resize(size); }
  std::size_t size() const { return motions_.size(); }
  const Motion& operator[](std::size_t i) const { return motions_[i]; }
  Motion& operator[](std::size_t i) { return motions_[i]; }

 private:
  std::vector<Motion> motions_;
};

class Interpreter final : public Predefined {
 public:
  Interpreter(const machine::Machine& machine, const Coordinates& start);

  // See ReaderOptions::spindle and spindle_speed.
  void begin_spindle(int code, double speed) {
    modes_.spindle = code;
    modes_.spindle_speed = speed;
  }

  enum class Outcome { kGoesOn, kEnded, kFailed };
  // Appends the line's motions. After a failure, which `problem` describes, the state is undefined.
  Outcome execute(const WordSet& words, std::size_t line, LineMotions& motions, Problem& problem);
  // Appends the motion kEnd.
  void end(std::size_t line, LineMotions& motions);
  // Whether a word of the groups spindle, coolant or numbered outputs switches an output of this machine.
  bool switches(int number) const;
  // Whether the spindle speed sets the pulse width of an output of this machine.
  bool sets_pulse_width() const { return machine_.outputs.pwm != 0; }

  // The end of the last probe, machine coordinates: `edge`, where the input changed, and `rest`, where the machine is.
  void probed(const Coordinates& edge, const Coordinates& rest, bool tripped);
  // As probed(), under the assumption that the probe trips at its target.
  void assume_probed();
  // Number of lines so far that depend on a probe that has not run.
  std::size_t lines_on_probes() const { return lines_on_probes_; }

  Value numbered(int number) const override;
  std::optional<Value> named(std::string_view name) const override;
  void collect(std::map<int, double>& numbers) const;
  void preset(int number, double value);

 private:
  struct Plane {
    char first;
    char second;
    char normal;
    char first_offset;
    char second_offset;
    char unused_offset;
  };
  struct PlaneAxes {
    std::size_t first;
    std::size_t second;
    std::size_t normal;
  };
  // The words of a cycle that hold for its next lines: mm, from the program's zero or as increments.
  struct Sticky {
    double retract = 0;
    double bottom = 0;
    double peck = 0;
    double seconds = 0;
    bool later = false;
    // For a series of cycles, machine coordinates: level before the first hole, and the program's zero at that time.
    double start = 0;
    double zero = 0;
    bool start_later = false;
  };
  // The inputs and results of one line.
  struct Context {
    const WordSet& words;
    LineMotions& motions;
    Problem& problem;
  };
  class CycleMotions;

  bool set_modes(const Context& context);
  bool act(const Context& context);
  bool defer(const Context& context, std::size_t motions_before);
  bool depends(const WordSet& words) const;
  void switch_outputs(const Context& context);
  bool switch_numbered(const Context& context);
  void spin_up(LineMotions& motions);
  bool laser_may_burn(MotionKind kind) const;
  void set_power(LineMotions& motions, std::size_t first) const;
  void change_outputs(std::uint16_t set, std::uint16_t clear, LineMotions& motions);
  Motion& stop(LineMotions& motions, double seconds);
  bool go_home(const Context& context, bool second);
  bool set_system(const Context& context);
  bool set_origin(const Context& context, bool local);
  bool move(const Context& context);
  bool straight(const Context& context, bool rapid);
  bool arc(const Context& context, bool clockwise);
  bool set_turns(const Context& context, Motion& motion) const;
  bool arc_geometry(const Context& context, const Plane& plane, Motion& motion) const;
  bool spline(const Context& context);
  bool spline_controls(const Context& context, std::array<double, 2>& first, std::array<double, 2>& second);
  bool cycle(const Context& context, std::optional<int> before);
  bool set_sticky(const Context& context, int code, const PlaneAxes& axes, bool fresh);
  bool check_cycle(const Context& context, const PlaneAxes& axes) const;
  void begin_series(std::size_t normal);
  CycleHoles holes_to(const Place& target, int code, const PlaneAxes& axes, double repeats) const;
  bool probe(const Context& context);
  bool plane_axis(char letter, const char* what, std::size_t& axis, Problem& problem) const;
  const Plane& plane() const;

  bool is_rotary(std::size_t axis) const;
  double to_mm(std::size_t axis, double value) const;
  double to_program(std::size_t axis, double machine) const;
  Value word(const WordSet& words, char letter, std::size_t axis) const;
  bool is_absolute(std::size_t axis) const;
  bool target_of(const Context& context, Place& target) const;
  bool set_speed(const Context& context, Motion& motion) const;
  void arrive(const Place& target, Motion& motion);

  const machine::Machine& machine_;
  std::size_t line_ = 0;
  Place here_;
  ModalState modes_;
  Offsets offsets_;
  Tools tools_;
  Sticky sticky_;
  int cycle_plane_ = 0;
  std::optional<std::array<double, 2>> spline_end_;  // P and Q, mm, if the last motion was a G5
  Coordinates probe_target_{};
  unsigned probe_axes_ = 0;  // axes that the probe moves, bit n: axis n
  std::array<Value, kParameterAxes> probe_results_{};
  Value probe_success_;
  std::size_t lines_on_probes_ = 0;
};

}  // namespace trammel::gcode
