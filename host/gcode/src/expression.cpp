#include "expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>

#include "characters.hpp"
#include "elementary.hpp"

namespace trammel::gcode {
namespace {

constexpr double kEqual = 1e-4;  // as in LinuxCNC, for EQ and NE

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
double truth(bool holds) { return holds ? 1 : 0; }

bool wrong(Problem& problem, std::string message) { return problem.set(ErrorCode::kExpression, std::move(message)); }

struct Function {
  std::string_view name;
  double (*of)(double);
  const char* outside;  // message if the result is not a number
};

bool has_angle(double x) { return std::abs(x) <= 1; }
double beside(double x) { return std::sqrt((1 - x) * (1 + x)); }
double arc_sine(double x) { return has_angle(x) ? degrees_of(x, beside(x)) : std::nan(""); }
double arc_cosine(double x) { return has_angle(x) ? degrees_of(beside(x), x) : std::nan(""); }
double tangent(double x) { return sine_of_degrees(x) / cosine_of_degrees(x); }
double logarithm(double x) { return x > 0 ? natural_logarithm(x) : std::nan(""); }
double rounded(double x) { return x < 0 ? -std::floor(-x + 0.5) : std::floor(x + 0.5); }

constexpr Function kFunctions[] = {
    {"abs", [](double x) { return std::abs(x); }, ""},
    {"acos", arc_cosine, "ACOS of a number beyond -1 to 1"},
    {"asin", arc_sine, "ASIN of a number beyond -1 to 1"},
    {"cos", cosine_of_degrees, ""},
    {"exp", exponential, "EXP is out of range"},
    {"fix", [](double x) { return std::floor(x); }, ""},
    {"fup", [](double x) { return std::ceil(x); }, ""},
    {"ln", logarithm, "LN of a number that is not above 0"},
    {"round", rounded, ""},
    {"sin", sine_of_degrees, ""},
    {"sqrt", [](double x) { return std::sqrt(x); }, "SQRT of a number below 0"},
    {"tan", tangent, "TAN of a right angle"},
};

// Whether a function's name and a bracket begin here.
bool starts_function(std::string_view text, std::string_view name) {
  if (text.size() <= name.size()) return false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (lower(text[i]) != name[i]) return false;
  }
  const std::size_t next = text.find_first_not_of(" \t", name.size());
  return next != std::string_view::npos && text[next] == '[';
}

}  // namespace

bool starts_expression(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t+-");
  if (first == std::string_view::npos) return false;
  text.remove_prefix(first);
  if (text.front() == '[' || text.front() == '#') return true;
  const auto starts = [&](const Function& function) { return starts_function(text, function.name); };
  return starts_function(text, "atan") || starts_function(text, "exists") ||
         std::any_of(std::begin(kFunctions), std::end(kFunctions), starts);
}

char ExpressionReader::peek() {
  while (at_ < line_.size() && is_space(line_[at_])) ++at_;
  return at_ < line_.size() ? line_[at_] : '\0';
}

bool ExpressionReader::take(char wanted) {
  if (peek() != wanted) return false;
  ++at_;
  return true;
}

bool ExpressionReader::take_word(std::string_view word) {
  peek();
  if (line_.size() - at_ < word.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (lower(line_[at_ + i]) != word[i]) return false;
  }
  at_ += word.size();
  return true;
}

bool ExpressionReader::malformed(Problem& problem) const {
  const std::string_view rest = line_.substr(at_);
  return wrong(problem, rest.empty() ? std::string("the line ends inside an expression")
                                     : fmt::format("an expression is not understood from '{}' on", quote(rest)));
}

bool ExpressionReader::value(Value& value, Problem& problem) { return real(value, problem); }

// A value that a probe decides cannot be wrong yet.
bool ExpressionReader::real(Value& value, Problem& problem) {
  if (depth_ == kDeepest) return wrong(problem, fmt::format("an expression nested deeper than {}", kDeepest));
  ++depth_;
  const char c = peek();
  bool good = false;
  if (c == '[') {
    good = bracket(value, problem);
  } else if (c == '#') {
    good = parameter(value, problem);
  } else if (c == '+' || c == '-') {
    ++at_;
    good = real(value, problem);
    if (c == '-') value.value = -value.value;
  } else if (is_letter(c)) {
    good = function(value, problem);
  } else {
    good = number(value, problem);
  }
  --depth_;
  if (!good || std::abs(value.value) <= kLargestValue) return good;
  if (!value.later) return wrong(problem, fmt::format("an expression's value of {:.10g} is out of range", value.value));
  value.value = 0;
  return true;
}

bool ExpressionReader::number(Value& value, Problem& problem) {
  const char* const first = line_.data() + at_;
  const char* last = first;
  const char* const end = line_.data() + line_.size();
  std::size_t digits = 0;
  for (bool point = false; last != end && (is_digit(*last) || (*last == '.' && !point)); ++last) {
    if (*last == '.') {
      point = true;
    } else {
      ++digits;
    }
  }
  value = {};
  if (digits == 0) return malformed(problem);
  const auto result = std::from_chars(first, last, value.value, std::chars_format::fixed);
  if (result.ec == std::errc::result_out_of_range) {
    // Too small for a double: 0 is the nearest.
    const std::string_view text(first, static_cast<std::size_t>(last - first));
    if (text.substr(0, text.find('.')).find_first_not_of('0') != std::string_view::npos) {
      return problem.set(ErrorCode::kNumberOutOfRange, fmt::format("number out of range in '{}'", quote(text)));
    }
  }
  at_ = static_cast<std::size_t>(last - line_.data());
  return true;
}

int ExpressionReader::strength(Operator one) {
  switch (one) {
    case Operator::kEnd:
      return 0;
    case Operator::kAnd:
    case Operator::kOr:
    case Operator::kXor:
      return 1;
    case Operator::kEq:
    case Operator::kNe:
    case Operator::kGt:
    case Operator::kGe:
    case Operator::kLt:
    case Operator::kLe:
      return 2;
    case Operator::kPlus:
    case Operator::kMinus:
      return 3;
    case Operator::kTimes:
    case Operator::kOver:
    case Operator::kMod:
      return 4;
    case Operator::kPower:
      return 5;
  }
  return 0;
}

bool ExpressionReader::next_operator(Operator& found, Problem& problem) {
  struct Name {
    std::string_view text;
    Operator one;
  };
  constexpr Name kNames[] = {
      {"]", Operator::kEnd},   {"**", Operator::kPower}, {"*", Operator::kTimes}, {"/", Operator::kOver},
      {"mod", Operator::kMod}, {"+", Operator::kPlus},   {"-", Operator::kMinus}, {"eq", Operator::kEq},
      {"ne", Operator::kNe},   {"gt", Operator::kGt},    {"ge", Operator::kGe},   {"lt", Operator::kLt},
      {"le", Operator::kLe},   {"and", Operator::kAnd},  {"or", Operator::kOr},   {"xor", Operator::kXor},
  };
  for (const Name& name : kNames) {
    if (!take_word(name.text)) continue;
    found = name.one;
    return true;
  }
  return malformed(problem);
}

bool ExpressionReader::apply(Operator one, Value& left, const Value& right, Problem& problem) {
  const double a = left.value;
  const double b = right.value;
  left.later = left.later || right.later;
  const char* what = nullptr;
  switch (one) {
    case Operator::kPower:
      left.value = power(a, b);
      if (!std::isfinite(left.value)) what = "a power that is no number";
      break;
    case Operator::kTimes:
      left.value = a * b;
      break;
    case Operator::kOver:
    case Operator::kMod:
      if (b == 0) what = "division by 0";
      left.value = b == 0 ? 0 : one == Operator::kOver ? a / b : std::fmod(a, b);
      if (one == Operator::kMod && left.value < 0) left.value += std::abs(b);
      break;
    case Operator::kPlus:
      left.value = a + b;
      break;
    case Operator::kMinus:
      left.value = a - b;
      break;
    case Operator::kEq:
      left.value = truth(std::abs(a - b) < kEqual);
      break;
    case Operator::kNe:
      left.value = truth(!(std::abs(a - b) < kEqual));
      break;
    case Operator::kGt:
      left.value = truth(a > b);
      break;
    case Operator::kGe:
      left.value = truth(a >= b);
      break;
    case Operator::kLt:
      left.value = truth(a < b);
      break;
    case Operator::kLe:
      left.value = truth(a <= b);
      break;
    case Operator::kAnd:
      left.value = truth(a != 0 && b != 0);
      break;
    case Operator::kOr:
      left.value = truth(a != 0 || b != 0);
      break;
    case Operator::kXor:
      left.value = truth((a != 0) != (b != 0));
      break;
    case Operator::kEnd:
      break;
  }
  if (std::abs(left.value) <= 1e100 && what == nullptr) return true;
  if (!left.later) return wrong(problem, what != nullptr ? what : "an expression's value is out of range");
  left.value = 0;
  return true;
}

// Keeps a stack of values, each with the operator after it. Each operator on the stack is stronger than the one before
// it, so there is at most one per strength.
bool ExpressionReader::bracket(Value& value, Problem& problem) {
  ++at_;
  Value values[6];
  Operator operators[6];
  std::size_t count = 0;
  while (true) {
    Value next;
    Operator behind = Operator::kEnd;
    if (!real(next, problem) || !next_operator(behind, problem)) return false;
    while (count > 0 && strength(operators[count - 1]) >= strength(behind)) {
      --count;
      if (!apply(operators[count], values[count], next, problem)) return false;
      next = values[count];
    }
    if (behind == Operator::kEnd) {
      value = next;
      return true;
    }
    values[count] = next;
    operators[count++] = behind;
  }
}

bool ExpressionReader::function(Value& value, Problem& problem) {
  if (take_word("exists")) return exists(value, problem);
  if (take_word("atan")) {
    Value x;
    if (peek() != '[') return malformed(problem);
    if (!bracket(value, problem)) return false;
    if (!take('/')) return wrong(problem, "ATAN needs two arguments: ATAN[y]/[x]");
    if (peek() != '[') return malformed(problem);
    if (!bracket(x, problem)) return false;
    value = {degrees_of(value.value, x.value), value.later || x.later};
    return true;
  }
  for (const Function& function : kFunctions) {
    const std::size_t from = at_;
    if (!take_word(function.name)) continue;
    if (peek() != '[') {
      at_ = from;
      continue;
    }
    if (!bracket(value, problem)) return false;
    value.value = function.of(value.value);
    if (std::isfinite(value.value)) return true;
    if (!value.later) return wrong(problem, function.outside);
    value.value = 0;
    return true;
  }
  return malformed(problem);
}

// EXISTS[#<name>] or EXISTS[#number]
bool ExpressionReader::exists(Value& value, Problem& problem) {
  if (!take('[') || !take('#')) return wrong(problem, "EXISTS needs a parameter: EXISTS[#<name>]");
  if (peek() == '<') {
    if (!name(problem)) return false;
    value = {truth(parameters_.exists(std::string_view(name_, name_size_))), false};
  } else {
    if (!real(value, problem)) return false;
    value = {truth(parameters_.exists(value)), value.later};
  }
  return take(']') || malformed(problem);
}

// Reads the name into name_, from the '<' to the '>'.
bool ExpressionReader::name(Problem& problem) {
  ++at_;
  name_size_ = 0;
  for (; at_ < line_.size() && line_[at_] != '>'; ++at_) {
    if (is_space(line_[at_])) continue;
    const bool printable = line_[at_] > ' ' && line_[at_] < '\x7f';
    if (!printable || line_[at_] == '(' || line_[at_] == ')' || line_[at_] == ';') return malformed(problem);
    if (name_size_ == kLongestName)
      return wrong(problem, fmt::format("a name of more than {} characters", kLongestName));
    name_[name_size_++] = lower(line_[at_]);
  }
  if (at_ == line_.size()) return wrong(problem, "a parameter's name without '>'");
  ++at_;
  return name_size_ != 0 || wrong(problem, "a parameter without a name");
}

bool ExpressionReader::parameter(Value& value, Problem& problem) {
  ++at_;
  if (peek() == '<') {
    return name(problem) && parameters_.read(std::string_view(name_, name_size_), value, problem);
  }
  Value number;
  return real(number, problem) && parameters_.read(number, value, problem);
}

bool ExpressionReader::assignment(Parameters& to, Problem& problem) {
  ++at_;
  const auto set = [&](const auto& which) {
    if (!take('=')) return wrong(problem, "a parameter at the beginning of a word needs '=' and a value");
    Value value;
    return real(value, problem) && to.assign(which, value, problem);
  };
  if (peek() == '<') {
    if (!name(problem)) return false;
    std::array<char, kLongestName> left{};  // a copy: the value may contain names
    std::copy_n(name_, name_size_, left.begin());
    return set(std::string_view(left.data(), name_size_));
  }
  Value number;
  return real(number, problem) && set(number);
}

}  // namespace trammel::gcode
