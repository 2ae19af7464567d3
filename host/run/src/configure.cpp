#include "trammel/run/configure.hpp"

#include <chrono>
#include <cmath>

namespace trammel::run {
namespace {

std::chrono::nanoseconds rounded_up(double nanoseconds) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(std::ceil(nanoseconds)));
}

}  // namespace

void configure(driver::Card& card, const machine::Machine& machine) {
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const machine::MachineAxis& axis = machine.axes[i];
    driver::AxisSettings settings;
    settings.step_length = rounded_up(axis.step_length_ns);
    settings.step_space = rounded_up(axis.step_space_ns);
    settings.direction_setup = rounded_up(axis.direction_setup_ns);
    settings.direction_hold = rounded_up(axis.direction_hold_ns);
    settings.invert_second = axis.inverted;
    card.configure_axis(static_cast<unsigned>(i), settings);
  }
}

}  // namespace trammel::run
