// The state of a sender's program: parser state, offsets, and the position after the lines accepted so far. Each line
// is checked by Grbl's rules (block.hpp), then read once by the project's reader, which interprets its coordinates. The
// planner's builder checks soft limits and the card's ranges. Not thread-safe.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>

#include "trammel/gcode/motion.hpp"
#include "trammel/grbl/block.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/card_limits.hpp"

namespace trammel::grbl {

class Interpreter {
 public:
  // `machine` must outlive the interpreter.
  Interpreter(const machine::Machine& machine, const planner::CardLimits& card) : machine_(machine), card_(card) {
    reset();
  }

  // Reads a line, which must be cleaned(). If it returns kOk, state and position are those after the line; otherwise
  // nothing changes. kTravelExceeded: a soft limit.
  Status read(std::string_view line, Block& block);
  // Reads a jog, which changes only the position.
  Status read_jog(std::string_view line, Block& block);

  // Sets Grbl's state after a soft reset; all offsets except G92 and the tool length are kept.
  void reset();
  // Sets the machine position after a stop, homing or a probe.
  void stand(const gcode::Coordinates& at) { place_ = at; }
  const gcode::Coordinates& place() const { return place_; }

  const Modal& modal() const { return modal_; }
  // To call when something other than a line has switched these outputs off.
  void end_spindle() { modal_.spindle = 5; }
  void end_coolant() { modal_.mist = modal_.flood = false; }
  // Parameters with LinuxCNC's numbers, for each that Grbl has: G28, G30, G92, G54 to G59.
  const std::map<int, double>& parameters() const { return parameters_; }
  void set_parameters(const std::map<int, double>& parameters);

  // Axis letters for reports: X Y Z, and those of A B C that the machine has. Offsets in mm.
  std::string letters() const;
  // kind: 28, 30, 92 or 54 to 59.
  gcode::Coordinates offset(int kind) const;
  // Machine coordinate minus work coordinate, by axis of the machine.
  gcode::Coordinates work_offset() const;

 private:
  Status follow(const std::string& text, const Modal& modal, gcode::Coordinates& place,
                std::map<int, double>& parameters) const;
  Status check_limits(const std::string& text) const;

  const machine::Machine& machine_;
  planner::CardLimits card_;
  Modal modal_;
  gcode::Coordinates place_{};
  std::map<int, double> parameters_;
};

}  // namespace trammel::grbl
