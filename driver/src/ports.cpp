#include "trammel/driver/low_level/ports.hpp"

#include <fmt/format.h>

#include "register_checks.hpp"
#include "trammel/card_map.hpp"

namespace trammel::driver {

namespace reg = card_map::reg;
namespace field = card_map::field;

std::uint32_t Ports::inputs() {
  require_path_commands(card_.engines, "inputs");
  return registers_.read(reg::kInputs);
}

std::uint16_t Ports::outputs() {
  require_path_commands(card_.engines, "outputs");
  return static_cast<std::uint16_t>(registers_.read(reg::kOutputs));
}

unsigned Ports::inputs_present() {
  require_path_commands(card_.engines, "inputs");
  return pins_present(field::kPortsInputs, field::kPortsInputsShift, 32, "inputs");
}

unsigned Ports::outputs_present() {
  require_path_commands(card_.engines, "outputs");
  return pins_present(field::kPortsOutputs, field::kPortsOutputsShift, 16, "outputs");
}

unsigned Ports::pins_present(std::uint32_t mask, std::uint32_t shift, std::uint32_t most, const char* pins) {
  const std::uint32_t ports = registers_.read(reg::kPorts);
  Registers::check_read({reg::kPorts, ports});
  const std::uint32_t count = field_bits(ports, mask, shift);
  check_field(reg::kPorts, count, 1, most, pins);
  return count;
}

void Ports::set_input_polarity(std::uint32_t inverted) {
  require_path_commands(card_.engines, "input polarity");
  registers_.write(reg::kInputPolarity, inverted, "input polarity");
}

void Ports::set_output_safe(std::uint16_t levels, std::uint16_t change) {
  require_path_commands(card_.engines, "safe outputs");
  registers_.write(reg::kOutputSafe, levels | std::uint32_t{change} << field::kOutputSafeChangeShift, "safe outputs");
}

void Ports::set_output_safe_cause(std::uint16_t levels, std::uint16_t change) {
  require_path_commands(card_.engines, "safe outputs at the cause");
  constexpr unsigned kMapMinorOfCause = 5;  // OUTPUT_SAFE_CAUSE came with map 3.5
  if (card_.map_minor < kMapMinorOfCause) {
    throw ArgumentError(fmt::format("safe outputs at the cause: the card's map is {}.{}; they came with {}.{}",
                                    card_.map_major, card_.map_minor, card_.map_major, kMapMinorOfCause));
  }
  registers_.write(reg::kOutputSafeCause, levels | std::uint32_t{change} << field::kOutputSafeCauseChangeShift,
                   "safe outputs at the cause");
}

}  // namespace trammel::driver
