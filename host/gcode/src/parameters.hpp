// Parameters of a program: #1 to #5000 and #<names>, which it sets, and those that only tell something. Internal to the
// reader. Numbers and meanings are LinuxCNC's.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "problem.hpp"

namespace trammel::gcode {

// A value, and whether only a probe that has not run yet will tell it: then it is what it would be if the probe
// tripped at its target.
struct Value {
  double value = 0;
  bool later = false;
};

// What programs may read and not set.
class Predefined {
 public:
  virtual ~Predefined() = default;
  // kFirstPredefined .. kLastParameter; 0 where a number means nothing.
  virtual Value numbered(int number) const = 0;
  // Lower case; none where the name means nothing.
  virtual std::optional<Value> named(std::string_view name) const = 0;
};

inline constexpr int kFirstPredefined = 5001;
inline constexpr int kLastParameter = 5602;
inline constexpr int kShowsMessages = 5599;  // programs may set it; LinuxCNC shows (DEBUG, ...) where it is not 0

class Parameters {
 public:
  // `predefined` must outlive the parameters.
  explicit Parameters(const Predefined& predefined);

  // A number that has not been set is 0, a name without a value an error.
  bool read(const Value& number, Value& value, Problem& problem) const;
  bool read(std::string_view name, Value& value, Problem& problem) const;
  bool exists(const Value& number) const;
  bool exists(std::string_view name) const;

  // From take_effect() on.
  bool assign(const Value& number, const Value& value, Problem& problem);
  bool assign(std::string_view name, const Value& value, Problem& problem);
  bool any_assigned() const { return !pending_.empty(); }
  void take_effect();
  void drop_assigned() { pending_.clear(); }

  // Those that programs set and that are not 0, and before a program the values that they have.
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

  // nullptr for those that only tell something.
  Slot* slot_of(int index);

  const Predefined& predefined_;
  std::vector<Slot> numbered_;
  Slot shows_messages_{{1, false}, true};
  std::map<std::string, Slot, std::less<>> named_;
  std::vector<Pending> pending_;
};

}  // namespace trammel::gcode
