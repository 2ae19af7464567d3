// Parameters of a program: #1 to #5000 and #<names>, which the program sets, and read-only ones. Internal to the
// reader. Numbers and meanings are those of LinuxCNC.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "problem.hpp"

namespace trammel::gcode {

// A value. `later`: it depends on a probe that has not run yet; `value` then assumes that the probe trips at its
// target.
struct Value {
  double value = 0;
  bool later = false;
};

// The read-only parameters.
class Predefined {
 public:
  virtual ~Predefined() = default;
  // kFirstPredefined .. kLastParameter; 0 if the number has no meaning.
  virtual Value numbered(int number) const = 0;
  // Names are in lower case; empty if the name has no meaning.
  virtual std::optional<Value> named(std::string_view name) const = 0;
};

inline constexpr int kFirstPredefined = 5001;
inline constexpr int kLastParameter = 5602;
inline constexpr int kShowsMessages = 5599;  // a program may set it; LinuxCNC shows (DEBUG, ...) if it is not 0

class Parameters {
 public:
  // `predefined` must outlive the parameters.
  explicit Parameters(const Predefined& predefined);

  // An unset number reads as 0; an unset name is an error.
  bool read(const Value& number, Value& value, Problem& problem) const;
  bool read(std::string_view name, Value& value, Problem& problem) const;
  bool exists(const Value& number) const;
  bool exists(std::string_view name) const;

  // Assigned values take effect at take_effect().
  bool assign(const Value& number, const Value& value, Problem& problem);
  bool assign(std::string_view name, const Value& value, Problem& problem);
  bool any_assigned() const { return !pending_.empty(); }
  void take_effect();
  void drop_assigned() { pending_.clear(); }

  // collect(): the parameters that programs set, without those that are 0. preset(): values before the program.
  void collect(std::map<int, double>& numbers) const;
  void preset(int number, double value);

 private:
  struct Slot {
    Value value;
    bool defined = false;
  };
  struct Pending {
    Slot* slot;
    Value value;
  };

  // nullptr for read-only parameters.
  Slot* slot_of(int index);

  const Predefined& predefined_;
  std::vector<Slot> numbered_;
  Slot shows_messages_{{1, false}, true};
  std::map<std::string, Slot, std::less<>> named_;
  std::vector<Pending> pending_;
};

}  // namespace trammel::gcode
