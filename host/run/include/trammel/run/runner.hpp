// Runs a program on a card: a pass that checks and plans all of it, then one that configures the card and streams.
// Opens nothing and prints nothing. Not thread-safe.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/planner.hpp"
#include "trammel/run/observer.hpp"

namespace trammel::run {

// What went wrong while the card ran, at the program's line that it was at. what() is "file:line: message".
class RunError : public std::runtime_error {
 public:
  RunError(const std::string& file, std::size_t line, const std::string& message);
  std::size_t line() const { return line_; }

 private:
  std::size_t line_;
};

// From the first pass.
struct Plan {
  double seconds = 0;          // estimate
  std::uint64_t segments = 0;  // paths
  std::uint64_t commands = 0;
};

struct Outcome {
  std::vector<std::int64_t> counted;         // pulses from the start, by axis, as the card counted them
  std::vector<std::int64_t> final_position;  // pulses, machine coordinates
  std::uint64_t commands = 0;                // sent
};

class Runner {
 public:
  // All references must outlive the runner. `clock_hz` of the card. Throws gcode::ProgramError for a target out of
  // range.
  Runner(const gcode::Program& program, const machine::Machine& machine, std::uint32_t clock_hz);

  void add(Observer& observer) { observers_.push_back(&observer); }

  // First pass; throws gcode::ProgramError.
  const Plan& plan();
  // Second pass, to the end of the motion. Throws RunError for what the card or its bus reports, and
  // std::runtime_error when the card does not end where the program does.
  Outcome run(driver::Card& card);

 private:
  const gcode::Program& program_;
  const machine::Machine& machine_;
  std::uint32_t clock_hz_;
  planner::Pulses start_;
  std::vector<Observer*> observers_;
  Plan plan_;
};

}  // namespace trammel::run
