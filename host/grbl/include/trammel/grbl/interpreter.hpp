// Where a sender's program stands: parser state, offsets, and the place that the lines accepted so far lead to. Each
// line is checked by Grbl's rules (block.hpp), then read once by the project's reader, which alone knows coordinates;
// soft limits and the card's ranges are checked by the planner's builder. Not thread-safe.
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
  // `machine` must outlive the interpreter; begin() tells a change of it.
  Interpreter(const machine::Machine& machine, const planner::CardLimits& card) : machine_(machine), card_(card) {
    reset();
  }

  // A line, cleaned(). Ok: state and place are those behind it. Else nothing changes. kTravelExceeded: a soft limit.
  Status read(std::string_view line, Block& block);
  // A jog changes the place alone.
  Status read_jog(std::string_view line, Block& block);

  // Grbl's state after a soft reset; offsets but G92 and the tool length stay.
  void reset();
  // The machine stands there: after a stop, homing, a probe.
  void stand(const gcode::Coordinates& at) { place_ = at; }
  const gcode::Coordinates& place() const { return place_; }

  const Modal& modal() const { return modal_; }
  // Something else than a line has switched them off.
  void end_spindle() { modal_.spindle = 5; }
  void end_coolant() { modal_.mist = modal_.flood = false; }
  // As LinuxCNC numbers them, each that Grbl has: G28, G30, G92, G54 to G59.
  const std::map<int, double>& parameters() const { return parameters_; }
  void set_parameters(const std::map<int, double>& parameters);

  // For reports, by X Y Z and what the machine has of A B C; mm.
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
