// Values of words as in LinuxCNC: numbers, #parameters, [expressions] and functions. Internal to the reader.
//
//   value: [+-] number | #number | #<name> | [ value { operator value } ] | FUNCTION[...] | ATAN[...]/[...]
//   operators, from the strongest: **; * / MOD; + -; EQ NE GT GE LT LE; AND OR XOR; equal strength: left to right
//   functions: ABS ACOS ASIN ATAN COS EXISTS EXP FIX FUP LN ROUND SIN SQRT TAN; angles in degrees
#pragma once

#include <cstddef>
#include <string_view>

#include "parameters.hpp"
#include "problem.hpp"

namespace trammel::gcode {

// Sums and squares of values up to this stay in the range of a double.
inline constexpr double kLargestValue = 1e12;

// Whether a value other than a plain number begins here: a parameter, a bracket or a function, perhaps with a sign.
bool starts_expression(std::string_view text);

class ExpressionReader {
 public:
  // Reads `line` from `at` on. Line and parameters must outlive the reader.
  ExpressionReader(std::string_view line, std::size_t at, const Parameters& parameters)
      : line_(line), at_(at), parameters_(parameters) {}

  // The result is finite and at most kLargestValue.
  bool value(Value& value, Problem& problem);
  // Reads `#number = value` or `#<name> = value`, starting at the '#'.
  bool assignment(Parameters& to, Problem& problem);
  // Position after the text that was read.
  std::size_t at() const { return at_; }

 private:
  enum class Operator {
    kEnd,
    kPower,
    kTimes,
    kOver,
    kMod,
    kPlus,
    kMinus,
    kEq,
    kNe,
    kGt,
    kGe,
    kLt,
    kLe,
    kAnd,
    kOr,
    kXor
  };
  static constexpr std::size_t kLongestName = 64;
  static constexpr int kDeepest = 32;

  bool real(Value& value, Problem& problem);
  bool number(Value& value, Problem& problem);
  bool bracket(Value& value, Problem& problem);
  bool function(Value& value, Problem& problem);
  bool exists(Value& value, Problem& problem);
  bool parameter(Value& value, Problem& problem);
  bool name(Problem& problem);
  bool next_operator(Operator& found, Problem& problem);
  static int strength(Operator one);
  static bool apply(Operator one, Value& left, const Value& right, Problem& problem);
  bool malformed(Problem& problem) const;
  char peek();
  bool take(char wanted);
  bool take_word(std::string_view word);

  std::string_view line_;
  std::size_t at_;
  const Parameters& parameters_;
  int depth_ = 0;
  char name_[kLongestName]{};  // lower case, without blanks
  std::size_t name_size_ = 0;
};

}  // namespace trammel::gcode
