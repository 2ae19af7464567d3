#include "parameters.hpp"

#include <fmt/format.h>

#include <cmath>

namespace trammel::gcode {
namespace {

constexpr std::size_t kMaxOfALine = 50;
constexpr std::size_t kMaxNames = 4096;  // bounds the memory
constexpr double kWholeSlack = 1e-4;     // as LinuxCNC

// The number of the parameter; 0 if there is no such parameter.
int index_of(double number) {
  const double whole = std::floor(number + 0.5);
  return std::abs(number - whole) <= kWholeSlack && whole >= 1 && whole <= kLastParameter ? static_cast<int>(whole) : 0;
}

bool refuse_index(double number, Problem& problem) {
  return problem.set(ErrorCode::kParameter,
                     fmt::format("#{:.10g}: parameters have the numbers 1 to {}, or names", number, kLastParameter));
}

// In LinuxCNC, #<_hal[...]> is a pin of its HAL and #<_ini[...]> an entry of its configuration.
bool refuse_name(std::string_view name, Problem& problem) {
  const bool of_linuxcnc = name.substr(0, 5) == "_hal[" || name.substr(0, 5) == "_ini[";
  return problem.set(ErrorCode::kParameter,
                     of_linuxcnc ? fmt::format("#<{}> is LinuxCNC's own: write its value in the program", quote(name))
                                 : fmt::format("#<{}> has no value yet", quote(name)));
}

}  // namespace

Parameters::Parameters(const Predefined& predefined) : predefined_(predefined), numbered_(kFirstPredefined) {
  pending_.reserve(kMaxOfALine);
}

bool Parameters::read(const Value& number, Value& value, Problem& problem) const {
  const int index = index_of(number.value);
  if (index == 0) {
    value = {0, number.later};
    return number.later || refuse_index(number.value, problem);
  }
  if (index == kShowsMessages) {
    value = shows_messages_.value;
  } else {
    value = index < kFirstPredefined ? numbered_[static_cast<std::size_t>(index)].value : predefined_.numbered(index);
  }
  value.later = value.later || number.later;
  return true;
}

bool Parameters::read(std::string_view name, Value& value, Problem& problem) const {
  const auto found = named_.find(name);
  if (found != named_.end() && found->second.defined) {
    value = found->second.value;
    return true;
  }
  const std::optional<Value> known = predefined_.named(name);
  if (!known) {
    return refuse_name(name, problem);
  }
  value = *known;
  return true;
}

bool Parameters::exists(const Value& number) const { return index_of(number.value) != 0; }

bool Parameters::exists(std::string_view name) const {
  const auto found = named_.find(name);
  return (found != named_.end() && found->second.defined) || predefined_.named(name).has_value();
}

bool Parameters::assign(const Value& number, const Value& value, Problem& problem) {
  if (number.later) {
    return problem.set(ErrorCode::kDependsOnProbe, "the number of a parameter that is set cannot depend on a probe");
  }
  const int index = index_of(number.value);
  if (index == 0) {
    return refuse_index(number.value, problem);
  }
  Slot* const slot = slot_of(index);
  if (slot == nullptr) {
    return problem.set(
        ErrorCode::kParameter,
        fmt::format("#{} only tells something: G10, G28.1, G30.1, G92 and T change what it tells", index));
  }
  if (pending_.size() == kMaxOfALine) {
    return problem.set(ErrorCode::kParameter, fmt::format("more than {} assignments on a line", kMaxOfALine));
  }
  pending_.push_back({slot, value});
  return true;
}

Parameters::Slot* Parameters::slot_of(int index) {
  if (index == kShowsMessages) return &shows_messages_;
  return index < kFirstPredefined ? &numbered_[static_cast<std::size_t>(index)] : nullptr;
}

bool Parameters::assign(std::string_view name, const Value& value, Problem& problem) {
  if (predefined_.named(name)) {
    return problem.set(ErrorCode::kParameter, fmt::format("#<{}> only tells something: it cannot be set", quote(name)));
  }
  auto found = named_.find(name);
  if (found == named_.end()) {
    if (named_.size() == kMaxNames) {
      return problem.set(ErrorCode::kParameter, fmt::format("more than {} names of parameters", kMaxNames));
    }
    found = named_.emplace(std::string(name), Slot{}).first;
  }
  if (pending_.size() == kMaxOfALine) {
    return problem.set(ErrorCode::kParameter, fmt::format("more than {} assignments on a line", kMaxOfALine));
  }
  pending_.push_back({&found->second, value});
  return true;
}

void Parameters::take_effect() {
  for (const Pending& pending : pending_) *pending.slot = {pending.value, true};
  pending_.clear();
}

void Parameters::collect(std::map<int, double>& numbers) const {
  for (std::size_t index = 1; index < numbered_.size(); ++index) {
    const double value = numbered_[index].value.value;
    if (value != 0) numbers[static_cast<int>(index)] = value;
  }
}

void Parameters::preset(int number, double value) {
  if (number >= 1 && number < kFirstPredefined) numbered_[static_cast<std::size_t>(number)] = {{value, false}, true};
}

}  // namespace trammel::gcode
