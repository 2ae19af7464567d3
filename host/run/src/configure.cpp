#include "trammel/run/configure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/planner/card_limits.hpp"

namespace trammel::run {

namespace {

// Outputs that the card lacks would be switched in silence.
void check_outputs(driver::Card& card, std::uint16_t named) {
  if (named == 0 || !card_map::has_engine(card.identification().engines, card_map::engine::kPathCommands)) return;
  const unsigned outputs = card.outputs_present();
  if (named >> outputs == 0) return;
  unsigned highest = outputs;
  while (named >> highest > 1) ++highest;
  throw driver::ArgumentError(fmt::format("output {} of the machine file: the card has {} outputs", highest, outputs));
}

}  // namespace

void configure(driver::Card& card, const machine::Machine& machine) {
  check_outputs(card, machine.outputs.all());
  const kinematics::Kinematics kinematics(machine);
  for (std::size_t i = 0; i < kinematics.joints(); ++i) {
    const kinematics::Joint& joint = kinematics.joint(i);
    driver::AxisSettings settings = planner::settings_of(machine.axes[joint.settings]);
    settings.invert_second = joint.inverted;
    card.configure_axis(static_cast<unsigned>(i), settings);
  }
  constexpr double kNanoseconds = 1e9;
  const double slowest = driver::Card::kSlowestSlew * kNanoseconds / card.identification().clock_hz;
  const double hold = std::min(planner::hold_seconds(machine) * kNanoseconds, std::floor(slowest));
  card.set_slew_time(std::chrono::nanoseconds(static_cast<std::int64_t>(hold)));
}

std::chrono::nanoseconds watchdog_time(const machine::MotionSettings& motion) {
  return std::chrono::nanoseconds(std::llround(motion.watchdog * 1e9));
}

}  // namespace trammel::run
