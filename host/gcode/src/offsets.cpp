#include "offsets.hpp"

#include <algorithm>

#include "trammel/gcode/parameter_numbers.hpp"

namespace trammel::gcode {
namespace {

constexpr int kLast =
    parameter::kFirstSystem + static_cast<int>(machine::kCoordinateSystems) * parameter::kBetweenSystems - 1;

}  // namespace

std::optional<std::size_t> parameter_axis(const machine::Machine& machine, int nth) {
  if (nth < 0 || nth >= kParameterAxes) return std::nullopt;
  return machine.axis(machine::kAxisLetters[static_cast<std::size_t>(nth)]);
}

Offsets::Offsets(const machine::Machine& machine) : machine_(machine) {
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    home_.at[axis] = machine.axes[axis].home;
    second_home_.at[axis] = machine.axes[axis].second_home;
    for (std::size_t system = 0; system < systems_.size(); ++system) {
      systems_[system].at[axis] = machine.axes[axis].offsets[system];
    }
  }
}

bool Offsets::depends(std::size_t axis) const {
  return systems_[system_].is_later(axis) || (shifted_ && shift_.is_later(axis)) || tool_.is_later(axis);
}

void Offsets::set_system_at(std::size_t system, std::size_t axis, const Place& here, const Value& value) {
  const double others = (shifted_ ? shift_.at[axis] : 0) + tool_.at[axis];
  const bool probed = here.is_later(axis) || value.later || tool_.is_later(axis) || (shifted_ && shift_.is_later(axis));
  set_system(system, axis, {here.at[axis] - others - value.value, probed});
}

void Offsets::shift_at(std::size_t axis, const Place& here, const Value& value) {
  const double others = systems_[system_].at[axis] + tool_.at[axis];
  const bool probed = here.is_later(axis) || value.later || tool_.is_later(axis) || systems_[system_].is_later(axis);
  shift_.set(axis, here.at[axis] - others - value.value, probed);
  any_later_ = any_later_ || probed;
}

void Offsets::shift_clear() {
  shift_ = {};
  shifted_ = false;
}

bool Offsets::has_tool() const {
  return tool_.later != 0 || std::any_of(tool_.at.begin(), tool_.at.end(), [](double offset) { return offset != 0; });
}

template <class Self>
auto Offsets::place_of(Self& self, int number, std::size_t& axis) -> decltype(&self.home_) {
  decltype(&self.home_) place = nullptr;
  int nth = 0;
  const auto in = [&](int first) {
    nth = number - first;
    return nth >= 0 && nth < kParameterAxes;
  };
  if (in(parameter::kHome)) {
    place = &self.home_;
  } else if (in(parameter::kSecondHome)) {
    place = &self.second_home_;
  } else if (in(parameter::kShift)) {
    place = &self.shift_;
  } else if (number >= parameter::kFirstSystem && number <= kLast) {
    nth = (number - parameter::kFirstSystem) % parameter::kBetweenSystems;
    if (nth < kParameterAxes)
      place = &self.systems_[static_cast<std::size_t>((number - parameter::kFirstSystem) / parameter::kBetweenSystems)];
  }
  axis = parameter_axis(self.machine_, nth).value_or(card_map::kMaxAxes);
  return place;
}

std::optional<Value> Offsets::parameter(int number) const {
  if (number == parameter::kShifted) return Value{shifted_ ? 1.0 : 0.0, false};
  if (number == parameter::kSystem) return Value{static_cast<double>(system_ + 1), false};
  std::size_t axis = 0;
  const Place* place = place_of(*this, number, axis);
  if (place == nullptr) return std::nullopt;
  return axis == card_map::kMaxAxes ? Value{} : Value{place->at[axis], place->is_later(axis)};
}

void Offsets::collect(std::map<int, double>& numbers) const {
  for (int number = parameter::kHome; number <= kLast; ++number) {
    const auto value = parameter(number);
    if (value && value->value != 0) numbers[number] = value->value;
  }
}

void Offsets::preset(int number, double value) {
  if (number == parameter::kShifted) {
    shifted_ = value != 0;
  } else if (number == parameter::kSystem && value >= 1 && value <= static_cast<double>(systems_.size())) {
    system_ = static_cast<std::size_t>(value) - 1;
  }
  std::size_t axis = 0;
  Place* place = place_of(*this, number, axis);
  if (place != nullptr && axis != card_map::kMaxAxes) place->set(axis, value, false);
}

}  // namespace trammel::gcode
