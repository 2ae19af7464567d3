// The position of a program's coordinates on the machine: coordinate systems, G92, tool length, and the targets of G28
// and G30. Internal to the reader. Machine coordinates in mm, degrees for A, B and C.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>

#include "parameters.hpp"
#include "trammel/gcode/motion.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::gcode {

// One coordinate per axis; those with a bit in `later` depend on a probe that has not run yet (see Value).
struct Place {
  Coordinates at{};
  unsigned later = 0;

  bool is_later(std::size_t axis) const { return (later >> axis & 1U) != 0; }
  void set(std::size_t axis, double value, bool depends) {
    at[axis] = value;
    later = (later & ~(1U << axis)) | (depends ? 1U << axis : 0U);
  }
};

class Offsets {
 public:
  explicit Offsets(const machine::Machine& machine);

  // Machine coordinate of the program's zero.
  double total(std::size_t axis) const {
    return systems_[system_].at[axis] + (shifted_ ? shift_.at[axis] : 0) + tool_.at[axis];
  }
  bool later(std::size_t axis) const { return any_later_ && depends(axis); }

  // Coordinate systems, 0: G54 .. 8: G59.3.
  std::size_t system() const { return system_; }
  void select(std::size_t system) { system_ = system; }
  void set_system(std::size_t system, std::size_t axis, const Value& value) {
    systems_[system].set(axis, value.value, value.later);
    any_later_ = any_later_ || value.later;
  }
  // Sets the zero of the system such that `here` has the coordinate `value` in it.
  void set_system_at(std::size_t system, std::size_t axis, const Place& here, const Value& value);

  // G92: `here` gets the coordinate `value`.
  void shift_at(std::size_t axis, const Place& here, const Value& value);
  void set_shift(std::size_t axis, const Value& value) {  // G52
    shift_.set(axis, value.value, value.later);
    any_later_ = any_later_ || value.later;
  }
  void shift_on() { shifted_ = true; }    // G92.3; also G92 and G52, for the axes they do not name
  void shift_off() { shifted_ = false; }  // G92.2
  void shift_clear();                     // G92.1

  void set_tool(std::size_t axis, const Value& value) {
    tool_.set(axis, value.value, value.later);
    any_later_ = any_later_ || value.later;
  }
  void clear_tool() { tool_ = {}; }
  bool has_tool() const;

  const Place& home(bool second) const { return second ? second_home_ : home_; }
  void set_home(bool second, const Place& here) { (second ? second_home_ : home_) = here; }

  // Value of one of the parameters 5161 .. 5389; empty for other numbers.
  std::optional<Value> parameter(int number) const;
  // collect(): those of them that are not 0. preset(): values before the program.
  void collect(std::map<int, double>& numbers) const;
  void preset(int number, double value);

 private:
  const machine::Machine& machine_;
  std::array<Place, machine::kCoordinateSystems> systems_;
  std::size_t system_ = 0;
  Place shift_;
  bool shifted_ = false;
  bool any_later_ = false;  // an offset depends on a probe, or did so before
  Place tool_;
  Place home_;
  Place second_home_;

  bool depends(std::size_t axis) const;
  // The place that a parameter number belongs to (null for other numbers) and its axis (kMaxAxes if the machine lacks
  // it).
  template <class Self>
  static auto place_of(Self& self, int number, std::size_t& axis) -> decltype(&self.home_);
};

// The machine's axis of the n-th letter of X Y Z A B C U V W, which is the order of parameters; empty if there is none.
std::optional<std::size_t> parameter_axis(const machine::Machine& machine, int nth);
inline constexpr int kParameterAxes = 9;

}  // namespace trammel::gcode
