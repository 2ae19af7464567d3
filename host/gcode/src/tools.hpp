// The tool in use, the selected tool, and the lengths of tools. Internal to the reader.
#pragma once

#include <optional>

#include "offsets.hpp"
#include "problem.hpp"
#include "word_set.hpp"

namespace trammel::gcode {

class Tools {
 public:
  explicit Tools(const machine::Machine& machine) : machine_(machine) {}

  void select(unsigned number) { selected_ = number; }        // T
  void change() { current_ = selected_.value_or(current_); }  // M6
  unsigned current() const { return current_; }
  std::optional<unsigned> selected() const { return selected_; }
  void preset_current(unsigned number) { current_ = number; }

  // Offset of a tool of the machine file; 0 for other tools.
  double offset(unsigned tool, std::size_t axis) const;
  // G43 and G49. False, with a problem, for a tool that is not in the machine file; tool 0 has no length.
  bool apply(const WordSet& words, Offsets& offsets, Problem& problem) const;

 private:
  const machine::Machine& machine_;
  std::optional<unsigned> selected_;
  unsigned current_ = 0;
};

}  // namespace trammel::gcode
