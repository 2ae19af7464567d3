#include "trammel/run/configure.hpp"

#include "trammel/planner/card_limits.hpp"

namespace trammel::run {

void configure(driver::Card& card, const machine::Machine& machine) {
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    card.configure_axis(static_cast<unsigned>(i), planner::settings_of(machine.axes[i]));
  }
}

}  // namespace trammel::run
