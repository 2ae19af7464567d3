// The table [spindle] of a machine file: the effect of S.
#include <fmt/format.h>

#include <string>

#include "entries.hpp"
#include "machine_outputs.hpp"
#include "text.hpp"

namespace trammel::machine {
namespace {

constexpr Range kPwmFrequency{1, 1e6, "Hz", "the card's periods have 27 bits of clocks"};
constexpr Range kMostS{1e-3, 1e9, "", "the S of full pulses"};
constexpr Range kSpinUp{0, 600, "s", "a spindle that takes longer is broken"};
constexpr Range kAtSpeed{0, 600, "s", "a spindle that takes longer is broken"};

std::uint16_t output_of(const Source& source, const toml::value& value) {
  if (!value.is_integer() || value.as_integer() < 0 || value.as_integer() >= kMaxOutputs) {
    refuse(fmt::format("{}spindle.output must be an output's number, 0 to {}", source.at(value), kMaxOutputs - 1));
  }
  return static_cast<std::uint16_t>(1U << value.as_integer());
}

void set_entry(const Source& source, MachineOutputs& outputs, const std::string& key, const toml::value& value) {
  const std::string path = "spindle." + key;
  if (key == "output") {
    outputs.pwm = output_of(source, value);
  } else if (key == "pwm_hz") {
    outputs.pwm_hz = number(source, path, value, kPwmFrequency);
  } else if (key == "max_s") {
    outputs.max_s = number(source, path, value, kMostS);
  } else if (key == "laser") {
    outputs.laser = true_or_false(source, path, value);
  } else if (key == "spin_up_s") {
    outputs.spin_up_s = number(source, path, value, kSpinUp);
  } else if (key == "at_speed_s") {
    outputs.at_speed_s = number(source, path, value, kAtSpeed);
  } else {
    refuse_key(source, value, "spindle.", key, {"output", "pwm_hz", "max_s", "laser", "spin_up_s", "at_speed_s"});
  }
}

}  // namespace

void set_spindle(const Source& source, Machine& machine, const toml::table& table) {
  MachineOutputs& outputs = machine.outputs;
  for (const auto& [key, value] : table) set_entry(source, outputs, key, value);
  const std::string at = source.at(table.begin()->second);
  if (outputs.pwm == 0) refuse(at + "spindle.output is missing: the output whose pulses S sets");
  if (outputs.laser && outputs.spin_up_s > 0) refuse(at + "spindle.spin_up_s: a laser does not wait: take one out");
  if (outputs.laser && (outputs.pwm & outputs.on_at_cause) != 0) {
    refuse(at + "spindle.output is a laser, which is off at the cause of a stop: take it out of outputs.on_at_cause");
  }
}

}  // namespace trammel::machine
