// Loads for an accumulator: circles, ellipses, lines, far ends, and values that use every width.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

namespace trammel::lockstep {

using Random = std::mt19937_64;
__extension__ typedef __int128 int128;
__extension__ typedef unsigned __int128 uint128;

// The fields of a path as the load bus carries them.
struct Path {
  int128 deviation = 0;
  int128 gradient_x = 0;
  int128 gradient_y = 0;
  std::uint64_t half_x = 0;
  std::uint64_t half_y = 0;
  std::int64_t end_x = 0;
  std::int64_t end_y = 0;
  std::uint16_t quadrants = 0;
  bool clockwise = false;
  bool eight_directions = false;
};

inline std::int64_t between(Random& random, std::int64_t low, std::int64_t high) {
  return std::uniform_int_distribution<std::int64_t>(low, high)(random);
}

inline int128 any128(Random& random) {
  const auto upper = static_cast<uint128>(random()) << 64;
  return static_cast<int128>(upper | random());
}

// b^2 x^2 + a^2 y^2 - a^2 b^2 in units of 1/scale pulse, about a centre with a fraction.
inline Path conic(Random& random, std::int64_t a, std::int64_t b, std::int64_t scale) {
  const double from = static_cast<double>(between(random, 0, 6283)) / 1000;
  const double to = static_cast<double>(between(random, 0, 6283)) / 1000;
  const auto on_curve = [&](double angle, double axis) { return static_cast<std::int64_t>(std::lround(axis * angle)); };
  const std::int64_t fraction_x = scale == 1 ? 0 : between(random, 0, scale - 1);
  const std::int64_t fraction_y = scale == 1 ? 0 : between(random, 0, scale - 1);
  const std::int64_t px = on_curve(std::cos(from), static_cast<double>(a));
  const std::int64_t py = on_curve(std::sin(from), static_cast<double>(b));
  const std::int64_t x = px * scale + fraction_x;
  const std::int64_t y = py * scale + fraction_y;
  const int128 weight_x = a == b ? 1 : static_cast<int128>(b) * b;
  const int128 weight_y = a == b ? 1 : static_cast<int128>(a) * a;
  Path path;
  path.deviation = weight_x * x * x + weight_y * y * y - weight_x * a * a * scale * scale;
  path.gradient_x = 2 * weight_x * x * scale;
  path.gradient_y = 2 * weight_y * y * scale;
  path.half_x = static_cast<std::uint64_t>(weight_x * scale * scale);
  path.half_y = static_cast<std::uint64_t>(weight_y * scale * scale);
  path.end_x = on_curve(std::cos(to), static_cast<double>(a)) - px;
  path.end_y = on_curve(std::sin(to), static_cast<double>(b)) - py;
  path.quadrants = static_cast<std::uint16_t>(between(random, 0, 6));
  path.clockwise = random() % 2 != 0;
  return path;
}

inline Path line(Random& random) {
  const auto component = [&] { return between(random, 1, 60) * (random() % 2 != 0 ? 1 : -1); };
  const std::int64_t dx = component();
  const std::int64_t dy = component();
  Path path;
  path.deviation = std::abs(dx) - std::abs(dy) - 1;
  path.gradient_x = dx > 0 ? -std::abs(dy) : std::abs(dy);
  path.gradient_y = dy > 0 ? std::abs(dx) : -std::abs(dx);
  path.end_x = dx;
  path.end_y = dy;
  path.clockwise = (dx > 0) == (dy > 0);
  return path;
}

// Not a curve: every bit of every word is in use, with carries through all of them and ends of any size.
inline Path noise(Random& random) {
  Path path;
  const auto shrink = [&] { return random() % 2 == 0 ? 48 : static_cast<int>(between(random, 48, 127)); };
  path.deviation = any128(random) >> shrink();
  path.gradient_x = any128(random) >> shrink();
  path.gradient_y = any128(random) >> shrink();
  path.half_x = random() >> between(random, 16, 63);
  path.half_y = random() >> between(random, 16, 63);
  const auto end = [&] {
    return static_cast<std::int32_t>(random()) >> (random() % 2 == 0 ? 0 : between(random, 0, 31));
  };
  path.end_x = end();
  path.end_y = end();
  path.quadrants = static_cast<std::uint16_t>((random() & 0xFFFF) >> between(random, 0, 16));
  path.clockwise = random() % 2 != 0;
  return path;
}

// Ends beyond half of a coordinate's range, on the near or the far side, with no quadrant change left. The walk goes
// straight as soon as the other coordinate has reached its end, so that the first steps show the sign.
inline Path far_end(Random& random) {
  Path path = conic(random, between(random, 1, 60), between(random, 1, 60), 1);
  const std::int64_t far = between(random, std::int64_t{1} << 30, (std::int64_t{1} << 31) - 1);
  const std::int64_t near = between(random, -3, 3);
  const bool in_x = random() % 2 != 0;
  path.end_x = in_x ? far : near;
  path.end_y = in_x ? near : far;
  if (random() % 2 != 0) {
    path.end_x = -path.end_x;
    path.end_y = -path.end_y;
  }
  path.quadrants = 0;
  return path;
}

inline Path any_path_in_4(Random& random) {
  switch (random() % 7) {
    case 0:
      return line(random);
    case 1:
      return noise(random);
    case 6:
      return far_end(random);
    case 2: {
      const std::int64_t r = between(random, 1, 60);
      return conic(random, r, r, 1);
    }
    case 3: {
      const std::int64_t r = between(random, 1, 60);
      return conic(random, r, r, 256);
    }
    case 4:
      return conic(random, between(random, 1, 80), between(random, 1, 80), 1);
    default:
      return conic(random, between(random, 1000, 1 << 20), between(random, 1000, 1 << 20), 1);
  }
}

// `eight`: every other path is in 8 directions.
inline Path any_path(Random& random, bool eight) {
  Path path = any_path_in_4(random);
  path.eight_directions = eight && random() % 2 != 0;
  return path;
}

// The bits of the field `plane` besides its axes.
inline unsigned rule_bits(const Path& path) { return (path.clockwise ? 1U : 0U) | (path.eight_directions ? 2U : 0U); }

// Chains in the order of the load bus's targets, from DEVIATION on: number of halfwords, and contents.
inline constexpr std::array<unsigned, 9> kChainHalfwords{5, 5, 5, 3, 3, 2, 2, 1, 1};
inline std::array<int128, 9> chains(const Path& path) {
  return {path.deviation, path.gradient_x, path.gradient_y, path.half_x,    path.half_y,
          path.end_x,     path.end_y,      path.quadrants,  rule_bits(path)};
}

}  // namespace trammel::lockstep
