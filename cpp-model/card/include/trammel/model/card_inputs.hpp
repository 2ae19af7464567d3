// Golden model of the card's inputs, rtl/io/card_inputs.sv: synchroniser and polarity. The engine machine_inputs adds
// filters and roles. An input whose filter length is 0 bypasses its filter. Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/input_filter.hpp"
#include "trammel/model/io_pins.hpp"
#include "trammel/model/role_scan.hpp"

namespace trammel::model {

class CardInputs {
 public:
  using Inputs = InputPins::Inputs;
  // All that the next clock() depends on besides its inputs.
  struct State {
    InputPins pins;
    InputFilter filter;
    RoleScan roles;
    std::uint32_t filters = 0;  // inputs that have a filter
  };

  // `inputs`: 1 to 32.
  CardInputs(unsigned axes, unsigned inputs, std::uint32_t engines)
      : machine_inputs_(card_map::has_engine(engines, card_map::engine::kMachineInputs)),
        state_{InputPins(inputs), InputFilter(card_map::has_engine(engines, card_map::engine::kCaptures)),
               RoleScan(axes)} {}

  // One rising edge.
  void clock(const Inputs& in) {
    if (machine_inputs_) {
      state_.roles.clock(role_inputs(in.setting));
      const InputFilter::Inputs filter = filter_inputs(in.setting);
      state_.filter.clock(filter);
      if (filter.set) set_filter(filter);
    }
    state_.pins.clock(in);
  }

  std::uint32_t raw() const { return state_.pins.level(); }  // before the filters
  std::uint32_t levels() const {
    return (state_.filter.levels() & state_.filters) | (state_.pins.level() & ~state_.filters);
  }
  // Of cards with captures: the inputs that have kept their levels for the length of their filter, and all without
  // filter.
  std::uint32_t quiet() const { return (state_.filter.quiet() | ~state_.filters) & state_.pins.present(); }
  const InputRoles& roles() const { return state_.roles.roles(); }
  const State& state() const { return state_; }
  State& state() { return state_; }
  bool has_machine_inputs() const { return machine_inputs_; }
  // The inputs of the parts.
  InputFilter::Inputs filter_inputs(const Setting& setting) const {
    const bool set = in_array(setting, card_map::reg::input_filter(0), InputFilter::kInputs);
    const unsigned input = (setting.address - card_map::reg::input_filter(0)) / 4;
    return {state_.pins.level(), set, set ? input : 0, static_cast<std::uint16_t>(setting.data)};
  }
  RoleScan::Inputs role_inputs(const Setting& setting) const {
    const bool set = in_array(setting, card_map::reg::role(0), RoleScan::kRoles);
    const unsigned role = (setting.address - card_map::reg::role(0)) / 4;
    return {levels(), set, set ? role : 0, setting.data & state_.pins.present()};
  }

 private:
  static bool in_array(const Setting& setting, std::uint32_t first, unsigned count) {
    return setting.set && setting.address >= first && setting.address < first + 4 * count;
  }
  void set_filter(const InputFilter::Inputs& in) {
    const std::uint32_t bit = std::uint32_t{1} << in.set_input & state_.pins.present();
    state_.filters = in.set_length != 0 ? state_.filters | bit : state_.filters & ~bit;
  }

  bool machine_inputs_;
  State state_;
};

}  // namespace trammel::model
