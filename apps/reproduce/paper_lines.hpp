// The second paper's Lines 1 to 8, and known results for them. Units: pulses.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "trammel/interpolation/any_interpolator.hpp"

namespace trammel::interpolation {

// Clocks per line at 10 MHz and 5,000 lines per second.
inline constexpr std::uint64_t kPaperClocks = 2000;

struct PaperLine {
  std::int64_t start_x, start_y, end_x, end_y;
  // Largest perpendicular distances by exact arithmetic, with kPaperClocks clocks per line, to three decimals; in the
  // order of kPaperMethods.
  std::array<double, 4> errors;
  std::uint64_t steer_steps;

  Line line() const { return make_line({start_x, start_y}, {end_x, end_y}); }
};

inline constexpr std::array<Method, 4> kPaperMethods{Method::kOneShot, Method::kOneShotZero, Method::kDivider,
                                                     Method::kSteer};
inline constexpr std::array<PaperLine, 8> kPaperLines{{
    {0, 0, 20, 40, {0.447, 0.447, 0.447, 0.894}, 60},
    {10, 10, 40, 20, {0.316, 0.632, 0.949, 0.632}, 40},
    {10, -10, 40, -20, {0.316, 0.632, 0.949, 0.632}, 40},
    {-10, 10, -40, 20, {0.316, 0.632, 0.949, 0.632}, 40},
    {-10, -10, -40, -40, {0, 0, 0, 0.707}, 60},
    {-10, -5, 30, 20, {0.636, 0.742, 0.742, 0.742}, 65},
    {7, -2, -32, -38, {0.678, 0.678, 0.735, 0.678}, 75},
    {-10, 20, 30, 20, {0, 0, 0, 0}, 40},
}};

}  // namespace trammel::interpolation
