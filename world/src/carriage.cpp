#include "trammel/world/carriage.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trammel::world {

Carriage::Carriage(const CarriageParameters& parameters)
    : motor_(parameters.motor), low_(static_cast<double>(parameters.low)), high_(static_cast<double>(parameters.high)) {
  if (parameters.low > 0 || parameters.high < 0) {
    throw std::invalid_argument("a carriage begins at pulse 0, which must lie between its end stops");
  }
}

void Carriage::advance(double seconds) {
  motor_.advance(seconds);
  if (motor_.position() < low_) motor_.hit(low_);
  if (motor_.position() > high_) motor_.hit(high_);
}

std::int64_t Carriage::place() const { return std::llround(motor_.position()); }

// Distance of n steps, each of which first adds to the speed: v n t + a t^2 n (n + 1) / 2.
std::uint64_t Carriage::steps_short_of(std::int64_t edge, double seconds) const {
  constexpr double kMost = 1e12;
  const double way = std::abs(static_cast<double>(edge) - position()) - 2 * Motor::kAtPlace;
  if (way <= 0) return 0;
  const double half = motor_.strongest() * seconds * seconds / 2;
  const double first = std::abs(motor_.speed()) * seconds + half;
  const double steps = (std::sqrt(first * first + 4 * half * way) - first) / (2 * half);
  return static_cast<std::uint64_t>(std::min(steps * (1 - 1e-9), kMost));
}

}  // namespace trammel::world
