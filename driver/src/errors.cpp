#include "trammel/driver/errors.hpp"

#include <fmt/format.h>

#include <utility>

#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"

namespace trammel::driver {
namespace {

std::string register_name(std::uint32_t address) {
  const card_map::Slot slot = card_map::find_register(address);
  if (slot.entry == nullptr) {
    return fmt::format("address 0x{:03X}", address);
  }
  const std::string index = slot.entry->count > 1 ? fmt::format("[{}]", slot.index) : "";
  return fmt::format("{}{} (0x{:03X})", slot.entry->name, index, address);
}

std::string refusal_message(std::uint8_t reason, std::uint8_t command_number, std::uint32_t address,
                            const std::string& context) {
  const std::string why = reason == 0 ? "it did not say why." : describe_reason(reason);
  const std::string number =
      address == card_map::reg::kStream ? fmt::format(", command number {}", command_number) : std::string();
  return fmt::format("{}: the card refused it: {} Access to {}{}", context, why, register_name(address), number);
}

}  // namespace

RefusedError::RefusedError(std::uint8_t reason, std::uint8_t command_number, std::uint32_t address,
                           const std::string& context)
    : Error(refusal_message(reason, command_number, address, context)),
      reason_(reason),
      command_number_(command_number),
      address_(address) {}

FaultError::FaultError(std::uint32_t faults, const std::string& context, std::optional<std::uint32_t> limit_state,
                       const std::vector<std::string>& axes)
    : Error(fmt::format("{}: the card has stopped with a fault: {}", context,
                        describe_faults(faults, limit_state, axes))),
      faults_(faults),
      limit_state_(limit_state.value_or(0)) {}

TimeoutError::TimeoutError(const std::string& context, std::uint64_t waited)
    : Error(fmt::format("{}: not within {} card clocks", context, waited)), waited_(waited) {}

namespace {

std::string name_of_axis(unsigned axis, const std::vector<std::string>& names) {
  return axis < names.size() ? names[axis] : fmt::format("axis {}", axis);
}

// Details beyond the fault's name: "axis 0 plus, axis 2 minus".
std::string detail_of(std::optional<std::uint32_t> read, std::uint32_t fault, const std::vector<std::string>& axes) {
  namespace field = card_map::field;
  const std::uint32_t limit_state = read.value_or(0);
  std::string text;
  const auto add = [&](unsigned shift, const char* end) {
    for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
      if ((limit_state >> (shift + axis) & 1U) != 0)
        text += fmt::format("{}{}{}", text.empty() ? "" : ", ", name_of_axis(axis, axes), end);
    }
  };
  if (fault == field::kFaultLimit) {
    add(field::kLimitStateMinusShift, " minus");
    add(field::kLimitStatePlusShift, " plus");
  }
  if (fault == field::kFaultDriveFault) add(field::kLimitStateDriveFaultShift, "");
  if (fault == field::kFaultSoftLimit && read) {
    const unsigned axis = (limit_state & field::kLimitStateSoftAxis) >> field::kLimitStateSoftAxisShift;
    text = fmt::format("{} {}", name_of_axis(axis, axes),
                       (limit_state & field::kLimitStateSoftPlus) != 0 ? "plus" : "minus");
  }
  if (fault == field::kFaultLinkLoss) text = "no access of the program that moved the card came in time";
  if (fault == field::kFaultWatchdog) text = "the program that moved the card was silent for too long";
  return text;
}

}  // namespace

std::string describe_faults(std::uint32_t faults, std::optional<std::uint32_t> limit_state,
                            const std::vector<std::string>& axes) {
  namespace field = card_map::field;
  std::string text;
  const auto add = [&text](const std::string& name) { text += (text.empty() ? "" : ", ") + name; };
  for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
    if ((faults >> (field::kFaultStepShift + axis) & 1U) != 0) {
      add("step fault of " + name_of_axis(axis, axes));
    }
  }
  constexpr std::pair<std::uint32_t, const char*> kNames[] = {{field::kFaultTickMismatch, "TICK_MISMATCH"},
                                                              {field::kFaultPathIncomplete, "PATH_INCOMPLETE"},
                                                              {field::kFaultMissingPeriod, "MISSING_PERIOD"},
                                                              {field::kFaultLimit, "LIMIT"},
                                                              {field::kFaultEmergencyStop, "EMERGENCY_STOP"},
                                                              {field::kFaultDriveFault, "DRIVE_FAULT"},
                                                              {field::kFaultWatchdog, "WATCHDOG"},
                                                              {field::kFaultLinkLoss, "LINK_LOSS"},
                                                              {field::kFaultSoftLimit, "SOFT_LIMIT"},
                                                              {field::kFaultProbe, "PROBE"},
                                                              {field::kFaultToolSetter, "TOOL_SETTER"}};
  for (const auto& [mask, name] : kNames) {
    if ((faults & mask) != 0) {
      const std::string detail = detail_of(limit_state, mask, axes);
      add(detail.empty() ? name : fmt::format("{} ({})", name, detail));
    }
  }
  const std::uint32_t unknown = faults & ~card_map::find_register(card_map::reg::kFault).entry->mask;
  if (unknown != 0) {
    add(fmt::format("unknown bits 0x{:X}", unknown));
  }
  return text.empty() ? "none" : text;
}

std::string describe_reason(std::uint8_t reason) {
  return fmt::format("{} ({}): {}", card_map::reason_name(reason), reason, card_map::reason_text(reason));
}

}  // namespace trammel::driver
