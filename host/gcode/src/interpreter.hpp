// Modal state of a G-code program, and the execution of its lines. Internal to the reader.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "trammel/gcode/motion.hpp"
#include "word_set.hpp"

namespace trammel::gcode {

// The motions of one line.
class LineMotions {
 public:
  void clear() { count_ = 0; }
  // A motion to be filled in.
  Motion& add(MotionKind kind, std::size_t line) {
    Motion& motion = motions_[count_++];
    motion = Motion{};
    motion.kind = kind;
    motion.line = line;
    return motion;
  }
  std::size_t size() const { return count_; }
  const Motion& operator[](std::size_t i) const { return motions_[i]; }

 private:
  std::array<Motion, 5> motions_;  // the most: outputs, G28 by way of a point, outputs off, the end
  std::size_t count_ = 0;
};

class Interpreter {
 public:
  Interpreter(const machine::Machine& machine, const Coordinates& start) : machine_(machine), here_(start) {}

  enum class Outcome { kGoesOn, kEnded, kFailed };
  // Appends the line's motions. After a failure, of which `problem` tells, the state means nothing.
  Outcome execute(const WordSet& words, std::size_t line, LineMotions& motions, Problem& problem);
  // Machine coordinates.
  const Coordinates& position() const { return here_; }
  // Appends the motion kEnd.
  void end(std::size_t line, LineMotions& motions);
  // Appends what makes the outputs what the lines so far have made them, where they have.
  void restore_outputs(std::size_t line, LineMotions& motions) const;
  // Whether a word of the groups spindle and coolant switches an output of this machine.
  bool switches(int number) const;

 private:
  enum class FeedMode { kPerMinute, kInverseTime };
  struct Plane {
    char first;
    char second;
    char first_offset;
    char second_offset;
    char unused_offset;
  };
  // Where a line's motions and problems go.
  struct Context {
    const WordSet& words;
    LineMotions& motions;
    Problem& problem;
  };

  void set_feed(const WordSet& words);
  void set_path_control(const WordSet& words);
  void set_modes(const WordSet& words);
  bool check_leftovers(const Context& context) const;
  bool act(const Context& context);
  void switch_outputs(const Context& context);
  void change_outputs(std::uint16_t set, std::uint16_t clear, LineMotions& motions);
  void dwell(const Context& context);
  bool go_home(const Context& context);
  bool set_origin(const Context& context);
  bool move(const Context& context);
  bool straight(const Context& context, bool rapid);
  bool arc(const Context& context, bool clockwise);
  bool plane_axis(char letter, std::size_t& axis, Problem& problem) const;
  bool set_turns(const Context& context, Motion& motion) const;
  bool arc_geometry(const Context& context, const Plane& plane, Motion& motion) const;

  bool is_rotary(std::size_t axis) const;
  double to_mm(std::size_t axis, double value) const;
  double offset(std::size_t axis) const;
  bool target_of(const Context& context, Coordinates& target) const;
  bool set_speed(const Context& context, Motion& motion) const;

  const machine::Machine& machine_;
  std::size_t line_ = 0;
  Coordinates here_;      // machine coordinates
  Coordinates origin_{};  // G92
  std::size_t coordinate_system_ = 0;
  std::optional<int> motion_;  // code in tenths; none under G80
  int plane_ = 170;
  bool inches_ = false;
  bool absolute_ = true;
  std::optional<bool> extruder_absolute_;  // none until M82 or M83
  bool centre_absolute_ = false;
  FeedMode feed_mode_ = FeedMode::kPerMinute;
  std::optional<double> feed_;  // as written, units or 1 a minute
  bool feed_in_inches_ = false;
  PathControl path_control_ = PathControl::kContinuous;
  double tolerance_ = 0;        // mm
  std::uint16_t switched_ = 0;  // outputs, bit n: output n
  std::uint16_t on_ = 0;        // of these
};

}  // namespace trammel::gcode
